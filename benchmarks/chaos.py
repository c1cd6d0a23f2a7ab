"""The chaotic top S5c to its floor: taylor beside heyoka in double and in 80-bit arithmetic, all from the same doubles.

    python benchmarks/chaos.py

Errors against the stored truth (docs/reference_scenes.md) until 20 s and until 60 s, beside the floor, which is what
rounding of the inputs alone does at worst; and against heyoka's 80-bit run, which starts from the rounded inputs too:
the integrator's own error. The 80-bit answers are rounded to double. The start's quaternion, in doubles, is unit to
9e-17. Times are the thread's CPU time, the least of repeats, all 601 samples included, without heyoka's compilation.
"""

import json
import pathlib
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
from bodies import PARTS  # noqa: E402
from measures import error, truth  # noqa: E402

import polhode as ph  # noqa: E402

OMEGA, SPANS, REPEATS = (0.3, 0.2, 2.0), (20.0, 60.0), 15
BEST = "heyoka, 80 bits, unit start"


def run_taylor(rtol):
    scene = ph.Scene(**{**PARTS["S5"], "omega": OMEGA, "times": truth("S5c")["t"]})

    def run():
        motion = ph.solve(scene, method="taylor", rtol=rtol)
        return motion.omega, motion.attitude

    return run


def run_heyoka(number, tolerance, normalised=False):
    """Euler's equations and the quaternion's in numbers of a type; their start is made unit in it or left as it is."""
    import heyoka as hy

    w1, w2, w3, x, y, z, w = hy.make_vars("w1", "w2", "w3", "x", "y", "z", "w")
    parts = PARTS["S5"]
    a, b, c = (number(v) for v in parts["inertia"])
    m = [number(parts["torques"][0].weight) * number(v) for v in parts["torques"][0].arm]
    one, two, half = number(1), number(2), number(0.5)
    g = (two * (x * z - w * y), two * (y * z + w * x), one - two * (x * x + y * y))
    tau = [m[2] * g[1] - m[1] * g[2], m[0] * g[2] - m[2] * g[0], m[1] * g[0] - m[0] * g[1]]
    system = [(w1, ((b - c) * w2 * w3 + tau[0]) / a), (w2, ((c - a) * w3 * w1 + tau[1]) / b),
              (w3, ((a - b) * w1 * w2 + tau[2]) / c),
              (x, half * (w * w1 + y * w3 - z * w2)), (y, half * (w * w2 + z * w1 - x * w3)),
              (z, half * (w * w3 + x * w2 - y * w1)), (w, -half * (x * w1 + y * w2 + z * w3))]
    start = np.array([*OMEGA, *parts["attitude"]], dtype=number)
    if normalised:
        start[3:] /= np.sqrt(np.sum(start[3:] ** 2))
    integrator = hy.taylor_adaptive(system, start, tol=number(tolerance), fp_type=number)
    times = truth("S5c")["t"].astype(number)

    def run():
        integrator.time = number(0)
        integrator.state[:] = start
        states = integrator.propagate_grid(times)[-1]
        q = states[:, 3:] / np.sqrt(np.sum(states[:, 3:] ** 2, axis=1))[:, None]
        return states[:, :3].astype(float), q.astype(float)

    return run


def until(span, motion):
    stop = int(np.searchsorted(truth("S5c")["t"], span * (1 + 1e-12)))
    return motion[0][:stop], motion[1][:stop]


def main():
    runs = {"taylor, rtol 1e-16": run_taylor(1e-16)}
    try:
        runs["heyoka, double"] = run_heyoka(float, 2.3e-16)
        runs["heyoka, 80 bits"] = run_heyoka(np.longdouble, 1.1e-19)
        runs[BEST] = run_heyoka(np.longdouble, 1.1e-19, normalised=True)
    except ImportError:
        print("heyoka is not installed: pip install heyoka")
    answers, seconds = {}, dict.fromkeys(runs, np.inf)
    for _ in range(REPEATS):
        for name, run in runs.items():
            begin = time.thread_time()
            answers[name] = run()
            seconds[name] = min(seconds[name], time.thread_time() - begin)
    reference, rounded = truth("S5c"), answers.get(BEST)
    floors = json.loads((ROOT / "scenes/reference/floors.json").read_text())["S5c"]
    print(f"{'S5c':30}" + "".join(f"{f'error to {span:.0f} s':>16}{'own':>10}" for span in SPANS) + f"{'time':>12}")
    for name, motion in answers.items():
        cells = ""
        for span in SPANS:
            omega, attitude = until(span, (reference["omega"], reference["attitude"]))
            found = until(span, motion)
            cells += f"{error(*found, {'omega': omega, 'attitude': attitude}):16.1e}"
            if rounded is None:
                cells += f"{'-':>10}"
            else:
                own = dict(zip(("omega", "attitude"), until(span, rounded), strict=True))
                cells += f"{error(*found, own):10.1e}"
        print(f"{name:30}{cells}{1e6 * seconds[name]:9.0f} us")
    print(f"{'floor, by rounded inputs':30}" + "".join(f"{floors['until'][f'{span:.0f}']:16.1e}{'':10}"
                                                       for span in SPANS))


if __name__ == "__main__":
    main()
