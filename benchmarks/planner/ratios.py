"""What the choice of a method costs: CPU time of solve over that of the cheapest method whose certificate holds.

Run: python benchmarks/planner/ratios.py [--count 2] [--seed 1] [--scenes 5] [--kinds heavy_fast gradient]

All certificates bound the error, so no truth from outside is needed. The choice itself is among what is compared, so a
ratio is 1 or more. Scenes with a closed form are left out, and so are those whose choice is refused or not certified.
Scenes that are cut into pieces count apart. The CPU time of the thread is the least of a few runs on a quiet machine.
"""

import argparse
import collections

import numpy as np
from family import KINDS, draw
from regret import CHEAP, MOST_STEPS, measure_cpu

import polhode as ph

ACCURACIES = (1e-2, 1e-3, 1e-4, 1e-6, 1e-9)


def measure(scene, accuracy, method=None):
    """The CPU time of a solve with its certificate, and what was used; None where it is refused or not certified."""
    run = lambda: ph.solve(scene, accuracy, method=method, max_steps=MOST_STEPS)  # noqa: E731
    try:
        motion = run()
    except ph.InvalidInput:   # a method that does not take the scene
        return None
    if not (motion.success and motion.error_kind == "bounded"):
        return None
    return measure_cpu(run), "pieces" if motion.plan.pieces else motion.plan.method


def judge(scene, accuracy, names):
    """The ratio, the choice and the cheapest way of one scene; None for a closed form or without a certificate."""
    chosen = measure(scene, accuracy)
    if chosen is None or chosen[1] == "exact":
        return None
    named = {name: found for name in names if (found := measure(scene, accuracy, name))}
    best = min(named, key=lambda name: named[name][0], default=chosen[1])
    if not named or chosen[0] <= named[best][0]:
        return 1.0, chosen[1], chosen[1]
    return chosen[0] / named[best][0], chosen[1], best


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=CHEAP, metavar="KIND")
    parser.add_argument("--count", type=int, default=2, help="scenes of each kind")
    parser.add_argument("--scenes", type=int, help="how many scenes in all; by default all of them")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    names = [method["name"] for method in ph.methods() if method["adaptive"]]
    keys = [(kind, index) for index in range(options.count) for kind in options.kinds][:options.scenes]
    scenes = {key: draw(options.seed, *key).scene for key in keys}
    for accuracy in ACCURACIES:
        rows = {key: row for key, scene in scenes.items() if (row := judge(scene, accuracy, names))}
        tell(f"{accuracy:.0e} one piece", {key: row for key, row in rows.items() if row[1] != "pieces"})
        tell(f"{accuracy:.0e} in pieces", {key: row for key, row in rows.items() if row[1] == "pieces"})


def tell(name, rows):
    if not rows:
        return
    ratios = [row[0] for row in rows.values()]
    worst = max(rows, key=lambda key: rows[key][0])
    missed = collections.Counter(row[1:] for row in rows.values() if row[1] != row[2])
    print(f"{name}: {len(rows):3} scenes, mean {np.mean(ratios):.2f}, median {np.median(ratios):.2f}, "
          f"95 % {np.quantile(ratios, 0.95):.2f}, most {max(ratios):.2f} ({worst[0]} {worst[1]}); "
          + ", ".join(f"{chosen} for {best}: {n}" for (chosen, best), n in missed.most_common()), flush=True)


if __name__ == "__main__":
    main()
