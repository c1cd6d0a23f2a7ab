"""Are the stated errors of motions under formulas true? Random laws against heyoka's series in long doubles.

Run: python benchmarks/planner/formulas.py [--count 20] [--seed 1] [--kinds pd tree] [--json out.json]

A law is written once, on any numbers: polhode traces it, and heyoka gets it as an expression. A claim is one scene at
one accuracy. Seed 2027 is kept for a last judgement: it asks for --last.
"""

import argparse
import json
import time
from dataclasses import dataclass

import heyoka
import mpmath
import numpy as np

import polhode as ph

LAST = 2027
ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12)
mp = mpmath.mp.clone()
mp.dps = 40


class Symbols:
    """The functions that a law uses, on polhode's symbols or on heyoka's."""

    def __init__(self, module):
        other = {"arctan2": "atan2"}
        for name in ("sin", "cos", "exp", "log", "sqrt", "tanh", "arctan2"):
            setattr(self, name, self.on_numbers(name, getattr(module, name, None) or getattr(module, other[name])))

    @staticmethod
    def on_numbers(name, function):
        """Of numbers alone the result is a number, whatever the module."""
        return lambda *a: getattr(np, name)(*a) if all(isinstance(x, float) for x in a) else function(*a)

    def norm(self, v):
        return self.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rows(q):
    """R^T by its columns: the axes of space seen from the body."""
    x, y, z, s = q[0], q[1], q[2], q[3]
    return ([s * s + x * x - y * y - z * z, 2.0 * (x * y - s * z), 2.0 * (x * z + s * y)],
            [2.0 * (x * y + s * z), s * s - x * x + y * y - z * z, 2.0 * (y * z - s * x)],
            [2.0 * (x * z - s * y), 2.0 * (y * z + s * x), s * s - x * x - y * y + z * z])


def see(q, v):
    r = rows(q)
    return [v[0] * r[0][i] + v[1] * r[1][i] + v[2] * r[2][i] for i in range(3)]


@dataclass
class Law:
    """torque(f, t, w, q, s) with the starts of its states; `beside` acts too, as torques of the list."""

    torque: object
    starts: tuple = ()
    beside: object = None


def pd(rng, pace):
    kp, kd = rng.uniform(0.1, 3) * pace**2, rng.uniform(0.05, 2, 3) * pace
    return Law(lambda f, t, w, q, s: ([-kp * q[i] * q[3] - float(kd[i]) * w[i] for i in range(3)], []))


def saturated(rng, pace):
    kp, kd, limit = rng.uniform(0.1, 3) * pace**2, rng.uniform(0.1, 2) * pace, rng.uniform(0.05, 1) * pace**2
    return Law(lambda f, t, w, q, s: ([limit * f.tanh((-kp * q[i] * q[3] - kd * w[i]) / limit) for i in range(3)], []))


def drag(rng, pace):
    c = rng.uniform(0.01, 0.5)
    return Law(lambda f, t, w, q, s: ([-c * f.norm(w) * w[i] for i in range(3)], []))


def spring(rng, pace):
    k, c, aim = rng.uniform(0.2, 2) * pace**2, rng.uniform(0, 0.3) * pace, rng.normal(size=3)

    def torque(f, t, w, q, s):
        seen = see(q, [float(x) for x in aim])
        across = cross([0.0, 0.0, 1.0], seen)
        sine = f.sqrt(across[0] * across[0] + across[1] * across[1] + 1e-2)
        return [k * f.arctan2(sine, 3.0 + seen[2]) / sine * across[i] - c * w[i] for i in range(3)], []
    return Law(torque)


def dipole(rng, pace):
    m, b, n = rng.normal(size=3) * pace**2, rng.normal(size=3), rng.uniform(0.05, 3) * pace

    def torque(f, t, w, q, s):
        field = [float(b[0]) * f.cos(n * t), float(b[1]) * f.sin(n * t), float(b[2])]
        return cross([float(x) for x in m], see(q, field)), []
    return Law(torque)


def wheels(rng, pace):
    kp, kd, limit = rng.uniform(0.1, 2) * pace**2, rng.uniform(0.1, 2) * pace, rng.uniform(0.1, 1) * pace**2
    start = tuple(rng.normal(size=3) * 0.3 * pace)

    def torque(f, t, w, q, s):
        u = [limit * f.tanh((-kp * q[i] * q[3] - kd * w[i]) / limit) for i in range(3)]
        h = cross(w, s)
        return [u[i] - h[i] for i in range(3)], [-x for x in u]
    return Law(torque, start)


def integral(rng, pace):
    kp, kd, ki = rng.uniform(0.3, 2) * pace**2, rng.uniform(0.5, 2) * pace, rng.uniform(0.02, 0.2) * pace**3
    return Law(lambda f, t, w, q, s: ([-kp * q[i] * q[3] - kd * w[i] - ki * s[i] for i in range(3)],
                                      [q[i] * q[3] for i in range(3)]), (0.0, 0.0, 0.0))


def orbit(rng, pace):
    """Gravity gradient on an eccentric orbit, whose place and velocity are states."""
    e, mu = rng.uniform(0, 0.6), (0.5 * pace) ** 2
    v = np.sqrt(mu * (1 + e))
    turn = ph.Rotation.random(rng=rng)
    start = (*turn.apply((1.0, 0, 0)), *turn.apply((0, v, 0)))
    J = np.diag((1.0, 1.6, 2.1))

    def torque(f, t, w, q, s):
        size = f.norm(s[:3])
        up = see(q, [x / size for x in s[:3]])
        tide = cross(up, [float(J[i, i]) * up[i] for i in range(3)])
        cube = size * size * size
        return [3 * mu / cube * x for x in tide], [s[3], s[4], s[5], *(-mu * x / cube for x in s[:3])]
    return Law(torque, start)


def polynomial(rng, pace):
    """A sum of random monomials in rates and attitude."""
    terms = [[(float(rng.normal() * 0.4), rng.integers(0, 7, rng.integers(1, 4))) for _ in range(4)] for _ in range(3)]

    def torque(f, t, w, q, s):
        y = [w[0] / pace, w[1] / pace, w[2] / pace, q[0], q[1], q[2], q[3]]
        found = []
        for some in terms:
            total = 0.0
            for c, factors in some:
                value = c * pace**2
                for k in factors:
                    value = value * y[k]
                total = total + value
            found.append(total - 0.4 * pace * w[len(found)])
        return found, []
    return Law(torque)


def tree(rng, pace):
    """Random expressions of every operation, bounded so that motions stay finite."""
    def grow(depth):
        if depth == 0 or rng.random() < 0.15:
            k = int(rng.integers(0, 9))
            c = float(rng.uniform(-1.5, 1.5))
            return lambda f, t, y: y[k] if k < 7 else (pace * t if k == 7 else c)
        a, b = grow(depth - 1), grow(depth - 1)
        c, e = float(rng.uniform(0.3, 1.2)), float(rng.choice([-1.5, 0.5, 1.3, 2.0, 3.0]))
        pick = int(rng.integers(0, 10))
        return [lambda f, t, y: a(f, t, y) + c * b(f, t, y),
                lambda f, t, y: a(f, t, y) * b(f, t, y),
                lambda f, t, y: a(f, t, y) / (1.5 + f.tanh(b(f, t, y))),
                lambda f, t, y: f.sin(a(f, t, y)),
                lambda f, t, y: f.cos(c * a(f, t, y) + b(f, t, y)),
                lambda f, t, y: f.tanh(a(f, t, y)),
                lambda f, t, y: f.exp(-1.0 * f.sqrt(0.2 + a(f, t, y) * a(f, t, y))),
                lambda f, t, y: f.log(1.2 + a(f, t, y) * a(f, t, y)),
                lambda f, t, y: (1.5 + f.sin(a(f, t, y))) ** e,
                lambda f, t, y: f.arctan2(a(f, t, y), 2.0 + f.cos(b(f, t, y)))][pick]
    made = [grow(3) for _ in range(3)]

    def torque(f, t, w, q, s):
        y = [w[0] / pace, w[1] / pace, w[2] / pace, *(q[i] for i in range(4))]
        return [0.5 * pace**2 * f.tanh(1.0 * made[i](f, t, y) + 0.0 * t) - 0.3 * pace * w[i] for i in range(3)], []
    return Law(torque)


def beside(rng, pace):
    """A formula with gravity and a rotor of the list beside it."""
    law = pd(rng, pace)
    arm, h = rng.normal(size=3) * 0.4 * pace**2, rng.normal(size=3) * 0.5 * pace
    own = law.torque

    def torque(f, t, w, q, s):
        tau, rates = own(f, t, w, q, s)
        down = cross([-float(x) for x in arm], see(q, [0.0, 0.0, 1.0]))
        gyro = cross([float(x) for x in h], w)
        return [tau[i] + down[i] + gyro[i] for i in range(3)], rates
    law.beside = (torque, arm, h)
    return law


KINDS = {kind.__name__: kind for kind in (pd, saturated, drag, spring, dipole, wheels, integral, orbit, polynomial,
                                          tree, beside)}


def draw(seed, kind, index):
    """Return a scene, its law as heyoka takes it, and its starts."""
    rng = np.random.default_rng([seed, list(KINDS).index(kind), index])
    pace = float(10 ** rng.uniform(-1, 1))
    law = KINDS[kind](rng, pace)
    moments = np.sort(rng.uniform(0.5, 2.0, 3))
    moments[2] = min(moments[2], 0.98 * (moments[0] + moments[1]))
    omega = pace * rng.normal(size=3)
    if rng.random() < 0.2:   # next to the intermediate axis
        omega = pace * np.array([1e-6, 1.0, 1e-7])
    inertia = np.diag(moments)
    if rng.random() < 0.4:
        R = ph.Rotation.random(rng=rng).as_matrix()
        inertia = R @ inertia @ R.T
        inertia = (inertia + inertia.T) / 2
    attitude = ph.Rotation.random(rng=rng).as_quat()
    span = 2 * np.pi * 10 ** rng.uniform(-0.5, 1.0) / pace
    times = span * np.unique([-0.05, *rng.random(3), 1.0] if rng.random() < 0.3 else [*rng.random(3), 1.0])
    symbols = Symbols(np)

    def traced(t, w, q, p, s=None):
        states = [] if s is None else [s.x[i] for i in range(len(law.starts))]
        tau, rates = law.torque(symbols, t, w, q, states)
        return np.stack(tau) if s is None else (np.stack(tau), {"x": np.stack(rates)})

    states = {"states": {"x": law.starts}} if law.starts else {}
    torques, rotors = [ph.torques.Formula(traced, recognise=False, **states)], []
    truth = law.torque
    if law.beside is not None:
        truth, arm, h = law.beside
        torques.append(ph.torques.Gravity(1.0, arm))
        rotors = [ph.Rotor(axis=h / np.linalg.norm(h), momentum=float(np.linalg.norm(h)))]
    scene = ph.Scene(inertia=inertia, omega=omega, attitude=attitude, torques=torques, rotors=rotors, times=times,
                     name=f"{kind} {index}")
    return scene, truth, law.starts


def compute_truth(scene, torque, starts, most=200_000):
    """States at the scene's times as long doubles; None where it takes too many steps."""
    names = ["wx", "wy", "wz", "x", "y", "z", "s", *(f"s{i}" for i in range(len(starts)))]
    y = heyoka.make_vars(*names)
    w, q, s = list(y[:3]), list(y[3:7]), list(y[7:])
    tau, rates = torque(Symbols(heyoka), heyoka.time, w, q, s)
    J = mp.matrix(scene.inertia.matrix.tolist())
    inverse = J ** -1

    def number(x):
        return heyoka.expression(np.longdouble(mp.nstr(x, 30)))

    L = [sum((number(J[i, j]) * w[j] for j in range(3)), heyoka.expression(0.0)) for i in range(3)]
    moment = [a + b for a, b in zip(tau, cross(L, w), strict=True)]
    accelerations = [sum((number(inverse[i, j]) * moment[j] for j in range(3)), heyoka.expression(0.0))
                     for i in range(3)]
    turn = [q[3] * w[0] + q[1] * w[2] - q[2] * w[1], q[3] * w[1] + q[2] * w[0] - q[0] * w[2],
            q[3] * w[2] + q[0] * w[1] - q[1] * w[0], -1.0 * (q[0] * w[0] + q[1] * w[1] + q[2] * w[2])]
    system = [*zip(y[:3], accelerations, strict=True), *zip(y[3:7], [0.5 * x for x in turn], strict=True),
              *zip(y[7:], rates, strict=True)]
    unit = [mp.mpf(float(x)) for x in scene.attitude]
    size = mp.sqrt(sum(x * x for x in unit))
    start = [*(mp.mpf(float(x)) for x in scene.omega), *(x / size for x in unit), *(mp.mpf(float(x)) for x in starts)]
    start = np.array([np.longdouble(mp.nstr(x, 30)) for x in start])
    run = heyoka.taylor_adaptive(system, start, fp_type=np.longdouble, tol=np.longdouble("1e-21"), compact_mode=True)
    found = {}
    for wanted in (sorted(t for t in scene.times if t >= 0), sorted((t for t in scene.times if t < 0), reverse=True)):
        run.time, run.state[:] = np.longdouble(0), start
        for t in wanted:
            outcome = run.propagate_until(np.longdouble(t), max_steps=most)[0]
            if outcome != heyoka.taylor_outcome.time_limit or not np.isfinite(run.state).all():
                return None
            found[t] = run.state.copy()
    return np.array([found[t] for t in scene.times])


def find_size(scene, starts):
    """The largest number of the states in the motion."""
    if not starts:
        return None
    between = np.concatenate([np.linspace(0, t, 200) for t in (scene.times.min(), scene.times.max())])
    motion = ph.solve(scene.replace(times=between), 1e-6)
    return max(np.abs(starts).max(), np.abs(motion.states["x"]).max())


def find_error(motion, known, size_of_states):
    """The largest error of the rates, the attitude and the states, as `error` is defined."""
    w, q = known[:, :3], known[:, 3:7]
    size = max(np.linalg.norm(np.asarray(motion.scene.omega)), np.linalg.norm(w, axis=1).max())
    sign = np.sign(np.sum(q * motion.attitude, axis=1))[:, None]
    parts = [np.linalg.norm(motion.omega - w, axis=1).max() / size,
             2 * np.linalg.norm(motion.attitude - sign * q, axis=1).max()]
    if size_of_states is not None:
        parts.append(np.abs(motion.states["x"] - known[:, 7:]).max() / size_of_states)
    return float(max(parts))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kinds", nargs="+", default=list(KINDS), choices=list(KINDS))
    parser.add_argument("--json")
    parser.add_argument("--last", action="store_true")
    given = parser.parse_args()
    if given.seed == LAST and not given.last:
        parser.error(f"seed {LAST} is kept for a last judgement: --last")
    begin, claims = time.perf_counter(), []
    for kind in given.kinds:
        for index in range(given.count):
            scene, torque, starts = draw(given.seed, kind, index)
            known = compute_truth(scene, torque, starts)
            if known is None:
                continue
            size = find_size(scene, starts)
            for accuracy in ACCURACIES:
                motion = ph.solve(scene, accuracy)
                found = find_error(motion, known, size) if len(motion.t) == len(scene.times) else np.inf
                claims.append({"kind": kind, "index": index, "accuracy": accuracy, "error_kind": motion.error_kind,
                               "error": motion.error, "found": found, "success": motion.success,
                               "method": motion.plan.method, "seconds": motion.stats["seconds"]})
    bounded = [claim for claim in claims if claim["error_kind"] == "bounded"]
    false = [claim for claim in bounded if claim["found"] > claim["error"]]
    limits = [claim for claim in claims if claim["error_kind"] == "limit"]
    loose = [claim["error"] / claim["found"] for claim in bounded if claim["found"] > 0]
    print(f"seed {given.seed}: {len(claims)} claims in {time.perf_counter() - begin:.0f} s, {len(bounded)} bounded, "
          f"{len(false)} of them false; {len(limits)} limits, "
          f"{sum(claim['found'] > claim['error'] for claim in limits)} of them false; stated over true error: median "
          f"{np.median(loose):.1f}, 95 % {np.quantile(loose, 0.95):.0f}")
    methods = {claim["method"] for claim in claims}
    print({method: sum(claim["method"] == method for claim in claims) for method in sorted(methods)})
    for claim in sorted(false, key=lambda claim: -claim["found"] / claim["error"])[:10]:
        print("false:", claim)
    for claim in limits[:10]:
        print("limit:", claim)
    if given.json:
        with open(given.json, "w", encoding="utf-8") as file:
            json.dump(claims, file)


if __name__ == "__main__":
    main()
