"""False bounds of closed loops: random loops beside a run in long double, stepped from tick to tick by its own series.

    python benchmarks/clock_bounds.py [--loops 2000] [--seed 1]
"""

import argparse
import collections

import numpy as np

import polhode as ph

L = np.longdouble
ORDER = 24


def series_step(J, inverse, w, q, torque, damping, h):
    """States after h, and the size of the last coefficients."""
    W, Q = np.zeros((3, ORDER + 1), L), np.zeros((4, ORDER + 1), L)
    W[:, 0], Q[:, 0] = w, q
    H = np.zeros_like(W)
    for n in range(ORDER):
        H[:, n] = J @ W[:, n]
        p = lambda a, b, n=n: (a[:n + 1] * b[n::-1]).sum()
        tau = np.array([p(H[1], W[2]) - p(H[2], W[1]), p(H[2], W[0]) - p(H[0], W[2]), p(H[0], W[1]) - p(H[1], W[0])])
        tau = tau - damping * W[:, n]
        if n == 0:
            tau = tau + torque
        W[:, n + 1] = inverse @ tau / (n + 1)
        x, y, z, s = Q
        change = [p(s, W[0]) + p(y, W[2]) - p(z, W[1]), p(s, W[1]) + p(z, W[0]) - p(x, W[2]),
                  p(s, W[2]) + p(x, W[1]) - p(y, W[0]), -p(x, W[0]) - p(y, W[1]) - p(z, W[2])]
        Q[:, n + 1] = np.array(change) / (2 * (n + 1))
    powers = h ** np.arange(ORDER + 1, dtype=L)
    size = max(np.abs(W[:, 0]).max(), L(1e-3))
    return W @ powers, Q @ powers, max(np.abs(W[:, -1]).max() / size, np.abs(Q[:, -1]).max())


def go(J, inverse, w, q, torque, damping, span):
    while span > 0:
        tail = series_step(J, inverse, w, q, torque, damping, L(0))[2]
        h = min(span, L(1e-21 / max(float(tail), 1e-200)) ** (L(1) / ORDER))
        w, q, _ = series_step(J, inverse, w, q, torque, damping, h)
        q = q / np.sqrt((q * q).sum())
        span = span - h
    return w, q


def invert(J):
    """The inverse in long double, by cofactors."""
    c = np.array([np.cross(J[1], J[2]), np.cross(J[2], J[0]), np.cross(J[0], J[1])], L)
    return c.T / (J[0] @ c[0])


class Pick:
    def __init__(self, **values):
        self.__dict__.update(values)


def by_hand(J, omega, attitude, times, c, damping):
    J = J.astype(L)
    inverse = invert(J)
    w, q = omega.astype(L), attitude.astype(L)
    q = q / np.sqrt((q * q).sum())
    states = {k: np.array(v, L) if np.ndim(v) else L(v) for k, v in c["states"].items()}
    p = Pick(**{k: np.array(v, L) if np.ndim(v) else L(v) for k, v in c["parameters"].items()})
    close = lambda a, b: np.isfinite(max(a, b)) and abs(a - b) <= 9e-16 * max(abs(a), abs(b))
    t, k, queue, off, held, rows, samples = 0.0, 0, [], np.inf, np.zeros(3, L), [], list(times)
    last = times[-1]

    def act(now):
        nonlocal k, off, held, states
        if off < now or close(off, now):
            off, held = np.inf, np.zeros(3, L)
        tick = k * c["period"]
        if (tick < now or close(tick, now)) and tick < last and not close(tick, last):
            measured = w.copy()
            if c["quantum"]:
                measured = np.rint(measured / L(c["quantum"])) * L(c["quantum"])
            m = Pick(t=L(tick), omega=measured, attitude=-q if q[3] < 0 else q.copy())
            result = c["function"](m.t, m, Pick(**states), p)
            if isinstance(result, tuple):
                states, result = {**states, **result[1]}, result[0]
            if c["limit"]:
                result = np.clip(result, -L(c["limit"]), L(c["limit"]))
            queue.append((tick + c["delay"], result))
            k += 1
        while queue and (queue[0][0] < now or close(queue[0][0], now)):
            at, held = queue.pop(0)
            off = at + c["width"] if c["width"] else np.inf

    act(0.0)
    while samples:
        while samples and (samples[0] <= t or close(samples[0], t)):
            samples.pop(0)
            rows.append(np.concatenate([w, q]))
        if not samples:
            break
        tick = k * c["period"]
        stops = [tick if tick < last and not close(tick, last) else np.inf, off, queue[0][0] if queue else np.inf]
        stop = min(stops)
        stop = stop if stop < samples[0] or close(stop, samples[0]) else samples[0]
        w, q = go(J, inverse, w, q, held, L(damping), L(stop) - L(t))
        t = stop
        act(t)
    return np.array(rows)


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def pid(t, m, s, p):
    e = m.attitude[:3] * m.attitude[3]
    return -p.kp * e - p.kd * m.omega - p.ki * (s.z + p.dt * e), {"z": s.z + p.dt * e}


def low_pass(t, m, s, p):
    f = s.f + p.a * (m.omega - s.f)
    return -p.kd * f - p.kp * m.attitude[:3], {"f": f}


def pulses(t, m, s, p):
    e = m.omega + p.c * m.attitude[:3] * m.attitude[3]
    return np.where(e > p.band, -p.u, np.where(e < -p.band, p.u, 0.0 * e))


def bang(t, m, s, p):
    e = m.omega + p.c * m.attitude[:3] * m.attitude[3]
    return np.where(e > 0, -p.u, p.u)


def root(t, m, s, p):
    size = np.sqrt(m.omega[0] ** 2 + m.omega[1] ** 2 + m.omega[2] ** 2 + 1e-6)
    return -p.kd * m.omega / size - p.kp * np.abs(m.attitude[:3])


def draw(rng):
    """A scene's parts, a controller and an accuracy."""
    J = np.diag(rng.uniform(1.0, 2.0, 3))
    if rng.random() < 0.5:
        R = ph.Rotation.from_rotvec(rng.normal(size=3)).as_matrix()
        J = R @ J @ R.T
        J = 0.5 * (J + J.T)
    J = J * 10 ** rng.uniform(-2, 1)
    size = np.linalg.norm(J)
    omega = rng.normal(size=3) * 10 ** rng.uniform(-2, 0.7)
    attitude = rng.normal(size=4)
    attitude /= np.linalg.norm(attitude)
    period = 10 ** rng.uniform(-1.5, 0.3)
    gain = size / period * 10 ** rng.uniform(-2, 0.4)   # of the rates; some are unstable
    u = size * np.linalg.norm(omega) / period * 10 ** rng.uniform(-2, 0)
    kinds = {"pd": (pd, {}, {"kp": 0.3 * gain / period * rng.random(), "kd": gain}),
             "pid": (pid, {"z": np.zeros(3)},
                     {"kp": 0.1 * gain / period, "kd": gain, "ki": 0.02 * gain / period**2, "dt": period}),
             "low pass": (low_pass, {"f": np.zeros(3)}, {"a": rng.uniform(0.1, 0.9), "kd": gain, "kp": 0.1 * gain}),
             "pulses": (pulses, {}, {"c": 0.3, "band": 0.1 * np.linalg.norm(omega) * rng.random(), "u": u}),
             "bang": (bang, {}, {"c": 0.3, "u": u}),
             "root": (root, {}, {"kd": u, "kp": 0.3 * u})}
    name = rng.choice(list(kinds))
    function, states, parameters = kinds[name]
    controller = {"function": function, "states": states, "parameters": {k: float(v) for k, v in parameters.items()},
                  "period": float(period), "delay": float(rng.choice([0.0, 0.0, 0.5, 1.0, 1.7, 3.0]) * period),
                  "width": float(period * rng.uniform(0.1, 1.0)) if rng.random() < 0.3 else None,
                  "limit": float(u) if rng.random() < 0.3 else None,
                  "quantum": float(np.linalg.norm(omega) * 10 ** rng.uniform(-4, -1)) if rng.random() < 0.2 else None}
    damping = float(0.1 * size * rng.random()) if rng.random() < 0.2 else 0.0
    ticks = int(rng.integers(3, 25))
    times = np.unique(np.concatenate([[ticks * period], rng.uniform(0, ticks * period, 3), [3 * period]]))
    return name, (J, omega, attitude, times, damping), controller, 10 ** rng.uniform(-12, -4)


def solve(parts, c, accuracy):
    J, omega, attitude, times, damping = parts
    law = ph.Controller(c["period"], c["function"], states={k: v.tolist() for k, v in c["states"].items()},
                        parameters=c["parameters"], delay=c["delay"], width=c["width"], limit=c["limit"],
                        measure=ph.Measure(omega_quantum=c["quantum"] or 0.0))
    torques = [ph.torques.Damping((damping,) * 3)] if damping else []
    return ph.solve(ph.Scene(inertia=ph.InertiaTensor(J, physical=False), omega=omega, attitude=attitude, times=times,
                             controllers=[law], torques=torques), accuracy, max_steps=200_000)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--loops", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    kinds, false, ratios = collections.Counter(), [], []
    for i in range(given.loops):
        name, parts, controller, accuracy = draw(np.random.default_rng([given.seed, i]))
        motion = solve(parts, controller, accuracy)
        kinds[motion.error_kind] += 1
        if motion.error_kind != "bounded":
            continue
        J, omega, attitude, times, damping = parts
        rows = by_hand(J, omega, attitude, times, controller, damping)
        rates = np.sqrt(((motion.omega - rows[:, :3]) ** 2).sum(axis=1)).max() / motion.omega_scale
        q = rows[:, 3:] * np.sign((rows[:, 3:] * motion.attitude).sum(axis=1))[:, None]
        error = float(max(rates, 2 * np.sqrt(((motion.attitude - q) ** 2).sum(axis=1)).max()))
        ratios.append(motion.error / max(error, 1e-300))
        if not (error <= motion.error <= accuracy):
            false.append(i)
            print(f"loop {i} ({name}): error {error:.2e}, stated {motion.error:.2e}, asked {accuracy:.1e}", flush=True)
    print(f"{given.loops} loops: {dict(kinds)}; {len(false)} false bounds; stated over true error: median "
          f"{np.median(ratios):.1f}, 5 % {np.quantile(ratios, 0.05):.1f}, 95 % {np.quantile(ratios, 0.95):.1f}")


if __name__ == "__main__":
    main()
