"""Where a looser accuracy costs more than a tighter one: CPU time of solve with its certificate, on random scenes.

Run: python benchmarks/planner/inversions.py [--count 4] [--seed 1] [--kinds heavy_fast gradient] [--accuracy 1e-6 1e-9]

An accuracy counts where its error is certified. Each pair that costs more than 1.2 times as much is measured again, in
turns, with ten times the calls. Where a scene has a torque of the user's own, its calls are the cost. They are counted,
once.
"""

import argparse
import itertools

from family import KINDS, draw
from regret import CHEAP, MOST_STEPS, measure_cpu

import polhode as ph

MOST = 1.2


def has_custom(scene):
    return any(isinstance(torque, ph.torques.Custom) for torque in scene.torques)


def measure(scene, accuracy, least=5e-4):
    """The motion and its cost, CPU time or calls; None where it is not certified."""
    def run():
        return ph.solve(scene, accuracy, max_steps=MOST_STEPS)
    motion = run()
    if not (motion.success and motion.error_kind == "bounded"):
        return None
    return motion, motion.stats["derivatives"] if has_custom(scene) else measure_cpu(run, least)


def tell(motion):
    """What was run: the method, how often, with how many steps."""
    used = "pieces" if motion.plan.pieces else motion.plan.method
    return f"{used}, {motion.stats['runs']} runs, {motion.stats['steps']} steps"


def judge(scene, accuracies):
    """The pairs of accuracies whose looser one costs more, with the ratio of the costs and what was run."""
    found = {accuracy: kept for accuracy in accuracies if (kept := measure(scene, accuracy))}
    rows = []
    for loose, tight in itertools.combinations(sorted(found, reverse=True), 2):
        if found[loose][1] <= MOST * found[tight][1]:
            continue
        repeats = 1 if has_custom(scene) else 2
        costs = [(measure(scene, loose, 5e-3)[1], measure(scene, tight, 5e-3)[1]) for _ in range(repeats)]
        ratio = min(a for a, _ in costs) / min(b for _, b in costs)
        if ratio > MOST:
            rows.append((found[loose][1], ratio, loose, tight, tell(found[loose][0]), tell(found[tight][0])))
    return len(found), rows


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=CHEAP, metavar="KIND")
    parser.add_argument("--count", type=int, default=4, help="scenes of each kind")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--accuracy", type=float, nargs="+", default=[1e-3, 1e-6, 1e-9])
    options = parser.parse_args()
    scenes = claims = pairs = 0
    for index, kind in itertools.product(range(options.count), options.kinds):
        certified, rows = judge(draw(options.seed, kind, index).scene, options.accuracy)
        scenes, claims, pairs = scenes + 1, claims + certified, pairs + len(rows)
        for cost, ratio, loose, tight, one, other in rows:
            unit = f"{cost} calls" if cost >= 1 else f"{cost * 1e6:.0f} us"
            print(f"{kind} {index}, {unit}: {loose:.0e} costs {ratio:.2f} times {tight:.0e} "
                  f"({one}; {other})", flush=True)
    print(f"{scenes} scenes, {claims} certified, {pairs} pairs whose looser accuracy costs more")


if __name__ == "__main__":
    main()
