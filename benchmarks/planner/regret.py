"""What accuracy costs: CPU time of solve over that of the best single run that meets the request, known by hindsight.

Run: python benchmarks/planner/regret.py [--count 4] [--seed 1] [--kinds heavy_fast gradient]

The best run is of any method, at any tolerance on a grid of 10^(1/4). A closed form is compared with its object's own
evaluation. CPU time of the thread, the least of a few runs; the machine should be quiet.
"""

import argparse
import time

import numpy as np
from family import KINDS, compute_error, compute_truth, draw, missing

import polhode as ph

GRID = 10.0 ** -np.arange(0, 16.25, 0.25)
MOST_STEPS = 500_000
CHEAP = [kind for kind in KINDS if kind not in ("custom", "windows_far", "long")]


def measure_cpu(run, least=5e-4):
    """The least CPU time of a few calls."""
    best, spent, calls = np.inf, 0.0, 0
    while calls < 2 or (spent < least and calls < 20):
        start = time.thread_time()
        run()
        took = time.thread_time() - start
        best, spent, calls = min(best, took), spent + took, calls + 1
    return best


def find_best(scene, known, accuracy, names):
    """The cheapest single run whose true error is within the accuracy; None where no method has one."""
    if not scene.torques:
        def evaluate():
            return ph.FreeMotion(scene.inertia, scene.omega, scene.attitude).at(scene.times - scene.t0)
        return measure_cpu(evaluate), "exact"
    best = None
    for name in names:
        for rtol in GRID[GRID <= 100 * accuracy]:
            run = lambda: ph.solve(scene, method=name, rtol=rtol, max_steps=MOST_STEPS)  # noqa: E731,B023
            start = time.thread_time()
            try:
                motion = run()
            except ph.InvalidInput:   # a method that does not take the scene
                break
            took = time.thread_time() - start
            if best is not None and took > 4 * best[0]:
                break
            if motion.status == "finished" and compute_error(motion, known) <= accuracy:
                took = measure_cpu(run)
                if best is None or took < best[0]:
                    best = took, f"{name} {rtol:.0e}"
                break
    return best


def judge(drawn, names):
    """One row for each accuracy that is claimed and that some run met."""
    known = compute_truth(drawn.scene)
    for accuracy in drawn.accuracies if known is not None else ():
        run = lambda: ph.solve(drawn.scene, accuracy, max_steps=MOST_STEPS)  # noqa: E731,B023
        motion = run()
        best = find_best(drawn.scene, known, accuracy, names) if motion.success else None
        if best is not None:
            method = "pieces" if motion.plan.pieces else motion.plan.method
            yield {"kind": drawn.kind, "method": method, "best": best[1].split()[0],
                   "regret": measure_cpu(run) / best[0]}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=CHEAP, metavar="KIND")
    parser.add_argument("--count", type=int, default=4, help="scenes of each kind")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if missing():
        parser.error(missing())
    names = [method["name"] for method in ph.methods() if method["adaptive"]]
    rows = [row for kind in options.kinds for index in range(options.count)
            for row in judge(draw(options.seed, kind, index), names)]
    tell("closed forms", [row for row in rows if row["method"] == "exact"])
    tell("stepped", [row for row in rows if row["method"] != "exact"])
    for kind in options.kinds:
        tell(kind, [row for row in rows if row["kind"] == kind])
    for what in ("method", "best"):
        taken = [row[what] for row in rows]
        print(f"{what}: {({name: taken.count(name) for name in sorted(set(taken))})}")


def tell(name, rows):
    if rows:
        median, most = np.quantile([row["regret"] for row in rows], (0.5, 0.95))
        print(f"{name:20} {len(rows):5} claims, regret: median {median:.2f}, 95 % {most:.2f}")


if __name__ == "__main__":
    main()
