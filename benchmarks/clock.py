"""The cost of controllers: a PD loop against SciPy restarted at each tick, a traced tick, and a tick that coasts.

    python benchmarks/clock.py [--ticks 1000]
"""

import argparse
import time

import numpy as np
from scipy.integrate import solve_ivp

import polhode as ph

J = np.array((1.0, 2.0, 2.5))
KP, KD, PERIOD = 2.0, 3.0, 0.1
OMEGA, ATTITUDE = np.array((0.2, -0.3, 0.1)), np.array((0.5, -0.3, 0.2, 0.7))


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def track(t, m, s, p):
    """The same with a target that turns, so that nothing decays to 0."""
    return -p.kd * (m.omega - p.target)


def dead_band(t, m, s, p):
    return np.where(m.omega > p.band, -p.u, np.where(m.omega < -p.band, p.u, 0.0))


def best(function, repeats=5):
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        function()
        times.append(time.process_time() - begin)
    return min(times)


def make_scene(controllers, ticks, period=PERIOD, omega=OMEGA):
    return ph.Scene(inertia=J, omega=omega, attitude=ATTITUDE / np.linalg.norm(ATTITUDE), controllers=controllers,
                    times=[0.0, ticks * period])


def by_scipy(ticks, rtol=1e-9):
    def rates(t, y, u):
        w, (x, y_, z, s) = y[:3], y[3:]
        a = (u - np.cross(w, J * w)) / J
        return np.array([*a, 0.5 * (s * w[0] + y_ * w[2] - z * w[1]), 0.5 * (s * w[1] + z * w[0] - x * w[2]),
                         0.5 * (s * w[2] + x * w[1] - y_ * w[0]), -0.5 * (x * w[0] + y_ * w[1] + z * w[2])])

    y = np.concatenate([OMEGA, ATTITUDE / np.linalg.norm(ATTITUDE)])
    for k in range(ticks):
        q = y[3:] if y[6] >= 0 else -y[3:]
        u = -KP * q[:3] * q[3] - KD * y[:3]
        y = solve_ivp(rates, (k * PERIOD, (k + 1) * PERIOD), y, "DOP853", args=(u,), rtol=rtol, atol=1e-12).y[:, -1]
    return y


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--ticks", type=int, default=1000)
    ticks = parser.parse_args().ticks
    law = ph.Controller(PERIOD, pd, parameters={"kp": KP, "kd": KD})
    scene = make_scene([law], ticks)
    motion = ph.solve(scene, 1e-9)
    own, theirs = best(lambda: ph.solve(scene, 1e-9)), best(lambda: by_scipy(ticks), 2)
    apart = np.abs(by_scipy(ticks)[:3] - motion.omega[-1]).max()
    print(f"PD loop, {ticks} ticks, 1e-9: {1e3 * own:.1f} ms, {1e6 * own / ticks:.2f} us a tick; "
          f"error {motion.error:.1e} ({motion.error_kind}), {motion.stats['runs']} runs")
    print(f"SciPy DOP853 restarted at each tick: {1e3 * theirs:.0f} ms, {theirs / own:.0f} times as long; "
          f"apart {apart:.1e}")
    follow = ph.Controller(PERIOD, track, parameters={"kd": KD, "target": (0.3, -0.2, 0.4)})
    for accuracy in (1e-6, 1e-9, 1e-12):
        few, many = (best(lambda n=n: ph.solve(make_scene([follow], n), accuracy)) for n in (ticks, 11 * ticks))
        print(f"a traced tick at {accuracy:g}: {1e6 * (many - few) / (10 * ticks):.2f} us")
    coast = ph.Controller(PERIOD, dead_band, parameters={"band": 5.0, "u": 0.1})
    for accuracy in (1e-6, 1e-9):
        few, many = (best(lambda n=n: ph.solve(make_scene([coast], n), accuracy)) for n in (ticks, 11 * ticks))
        print(f"a coasting tick at {accuracy:g}: {1e6 * (many - few) / (10 * ticks):.2f} us")


if __name__ == "__main__":
    main()
