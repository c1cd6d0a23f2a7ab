"""The free gyrostat in closed form: what it costs beside `taylor` and heyoka, and its error.

    python benchmarks/gyrostat.py            # the tables of docs/results/exact.md

Times are the smallest of many repeats of the CPU time of this thread. POLHODE_SIMD=avx2 or baseline measures the other
instruction sets. Errors are against tests/reference/gyrostat.json, in units of what the page of the gyrostat promises.
"""

import json
import pathlib

import numpy as np
from timing import best

import polhode as ph

ROOT = pathlib.Path(__file__).parents[1]
TABLE = ROOT / "tests" / "reference" / "gyrostat.json"
E = 2.2e-16
BLOCK, START = (0.20, 0.40, 0.52), (0.0, 0.0, 0.0, 1.0)
SCENES = ("S10", "S11")   # the trigonometric and the hyperbolic form


def measure_error(scene, omega, attitude):
    truth = np.load(ROOT / "scenes" / "reference" / f"{scene.name}.npz")
    sign = np.sign(np.sum(attitude * truth["attitude"], axis=1))[:, None]
    rates = np.linalg.norm(omega - truth["omega"], axis=1).max() / np.linalg.norm(truth["omega"], axis=1).max()
    return max(rates, 2 * np.linalg.norm(attitude - sign * truth["attitude"], axis=1).max())


def run_heyoka(scene):
    """A function that runs heyoka at its finest tolerance; None where it is not installed."""
    from polhode.charts.peers import heyoka

    if not heyoka.found():
        return None
    run = heyoka.candidates()[0].start(scene)
    return lambda: run(2.3e-16, None)


def measure_times():
    any_times = np.sort(np.random.default_rng(1).uniform(0, 1000, 100_000))
    out = np.empty((any_times.size, 3)), np.empty((any_times.size, 4))
    for name in SCENES:
        scene = ph.Scene.load(name)
        body = (scene.inertia, scene.rotor_momentum, scene.omega, scene.attitude)
        state = best(lambda: ph.gyrostat(*body, any_times, out=out, threads=1)) / any_times.size
        make = best(lambda: ph.Gyrostat(body[0], momentum=body[1], omega=body[2]), 400)
        cells = [f"{state:.1f}", f"{make / 1e3:.1f}"]
        for run in (lambda: ph.solve(scene, 1e-12), lambda: ph.solve(scene, 1e-12, method="taylor"), run_heyoka(scene)):
            if run is None:
                cells += ["-", "-"]
                continue
            seconds, found = best(run, 10), run()
            cells += [f"{seconds / 1e3:.0f}", f"{measure_error(scene, found.omega, found.attitude):.0e}"]
        print(f"| {name} | {' | '.join(cells)} |")


def measure_errors():
    worst = {}
    for row in json.loads(TABLE.read_text()):
        if not row["t"]:
            continue
        motion = ph.Gyrostat(row["moments"], momentum=row["momentum"], omega=row["omega"], attitude=row["attitude"])
        omega, attitude = motion.at(row["t"])
        answer = np.array(row["answer"])
        sign = np.sign(np.sum(attitude * answer[:, 3:], axis=1))[:, None]
        found = np.stack([np.linalg.norm(omega - answer[:, :3], axis=1) / row["scale"],
                          2 * np.linalg.norm(attitude - sign * answer[:, 3:], axis=1)], axis=1)
        part = (found / (20 * (np.array(row["cond"]) + 4 * E))).max()
        good = np.max(row["cond"], axis=1) < 1e-15
        size = found[good].max(axis=0) if good.any() else np.zeros(2)
        known = worst.get(row["name"], (0.0, np.zeros(2)))
        worst[row["name"]] = max(known[0], part), np.maximum(known[1], size)
    for name, (part, size) in worst.items():
        print(f"| {name} | {part:.3f} | {size[0]:.1e} | {size[1]:.1e} |")


if __name__ == "__main__":
    measure_times()
    measure_errors()
