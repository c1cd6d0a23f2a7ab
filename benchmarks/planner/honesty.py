"""Is accuracy asked accuracy got, and at what price? Random scenes against long-double truth, seeds fixed.

Run: python benchmarks/planner/honesty.py [scenes] [--seed 1] [--regret] [--uncertified] [--tight]

Honesty: of the results that claim success, how many have their true error within the request; reported over true error.
Regret: time of solve, with every run of its certificate, over the time of the best single run that meets the request, over
all methods and tolerances on a grid of 10^(1/4), known by hindsight. CPU time of the thread, least of a few runs.
"""

import argparse
import time

import numpy as np
from family import CLASSES, Truth, draw, error

import polhode as ph

GRID = 10.0 ** -np.arange(0, 16.25, 0.25)


def cpu(run, least=5e-4):
    """The least CPU time of a few calls."""
    best, spent, calls = np.inf, 0.0, 0
    while calls < 2 or (spent < least and calls < 20):
        start = time.thread_time()
        run()
        took = time.thread_time() - start
        best, spent, calls = min(best, took), spent + took, calls + 1
    return best


def hindsight(one, known, accuracy, names):
    """The cheapest single run whose true error is within the accuracy; None where no method has one."""
    scene, best = one.scene, None
    if one.kind == "free":
        def run():
            return ph.FreeMotion(scene.inertia, scene.omega, scene.attitude).at(scene.times)
        return cpu(run), "exact"
    for name in names:
        for rtol in GRID[GRID <= 100 * accuracy]:
            run = lambda: ph.solve(scene, method=name, rtol=rtol, max_steps=500_000)  # noqa: E731
            start = time.thread_time()
            try:
                motion = run()
            except ph.InvalidInput:   # a method that does not take the scene
                break
            took = time.thread_time() - start
            if best is not None and took > 4 * best[0]:
                break
            if motion.status == "finished" and "raised" not in motion.message and error(motion, known) <= accuracy:
                took = cpu(run)
                if best is None or took < best[0]:
                    best = took, f"{name} {rtol:.0e}"
                break
    return best


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="?", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--regret", action="store_true")
    parser.add_argument("--uncertified", action="store_true")
    parser.add_argument("--tight", action="store_true", help="accuracies of 1e-12 to 1e-14")
    parser.add_argument("--show", action="store_true")
    parser.add_argument("--seconds", type=float, default=1e9)
    options = parser.parse_args()
    rng = np.random.Generator(np.random.PCG64(options.seed))
    truth, names = Truth(), [m["name"] for m in ph.methods() if m["adaptive"]]
    rows, no_truth, done, begin = [], 0, 0, time.time()
    while done < options.scenes and time.time() - begin < options.seconds:
        one = draw(rng)
        accuracy = 10 ** -rng.uniform(12, 14) if options.tight else max(one.accuracy, 1e-11)
        known = truth(one, 60_000)
        if known is None or known[0] > 1e4:
            no_truth += 1
            continue
        done += 1
        run = lambda: ph.solve(one.scene, accuracy, certify=not options.uncertified, max_steps=2_000_000)  # noqa: E731,B023
        motion = run()
        found = error(motion, known)
        best = hindsight(one, known, accuracy, names) if options.regret else None
        took = cpu(run) if options.regret else 0.0
        rows.append((one.kind, accuracy, motion.success, found, motion.error, motion.error_kind, motion.plan.method,
                     motion.stats["runs"], took, best, known[0], motion.message))
        if options.show and (found > accuracy if motion.success else True):
            print(rows[-1], flush=True)
    report(rows, no_truth, options, time.time() - begin)


def report(rows, no_truth, options, seconds):
    claims = [r for r in rows if r[2]]
    false = [r for r in claims if not r[3] <= r[1]]
    refused = [r for r in rows if not r[2]]
    print(f"{len(rows)} scenes ({no_truth} drawn without truth in reach or beyond 1e4 turns) in {seconds:.0f} s")
    print(f"claims {len(claims)}, true {100 * (1 - len(false) / max(1, len(claims))):.2f} %, false {len(false)}"
          + (f", the worst by {max(r[3] / r[1] for r in false):.2g} times" if false else ""))
    for r in false:
        print("  false:", r)
    kinds = {r[5] for r in refused}
    print(f"refused {len(refused)} ({', '.join(sorted(kinds))}); of them the true error was within the request in {sum(r[3] <= r[1] for r in refused)}")
    ratio = np.array([r[4] / r[3] for r in claims if r[3] > 0])
    print(f"reported / true error: q2.5 {np.quantile(ratio, .025):.2g}, median {np.median(ratio):.2g}, q97.5 {np.quantile(ratio, .975):.2g}; "
          f"within 1 ... 100 in {100 * np.mean((ratio >= 1) & (ratio <= 100)):.1f} %")
    for kind in CLASSES:
        some = [r for r in rows if r[0] == kind]
        if not some:
            continue
        line = f"  {kind:9} {len(some):5} scenes, claims {sum(r[2] for r in some)}, runs {np.mean([r[7] for r in some]):.2f}"
        ratios = np.array([r[4] / r[3] for r in some if r[2] and r[3] > 0])
        line += f", reported/true within 1..100 {100 * np.mean((ratios >= 1) & (ratios <= 100)):.0f} %, median {np.median(ratios):.2g}"
        if options.regret:
            regrets = np.array([r[8] / r[9][0] for r in some if r[2] and r[9]])
            if regrets.size:
                line += f"; regret median {np.median(regrets):.2f}, q95 {np.quantile(regrets, .95):.2f}, most {regrets.max():.2f}"
            line += f"; refused though some run met it {sum(1 for r in some if not r[2] and r[9])}"
        print(line)
    if options.regret:
        for label, some in (("closed forms", [r for r in rows if r[6] == "exact"]), ("stepped", [r for r in rows if r[6] != "exact"])):
            regrets = np.array([r[8] / r[9][0] for r in some if r[2] and r[9]])
            if regrets.size:
                print(f"{label}: regret median {np.median(regrets):.2f}, q95 {np.quantile(regrets, .95):.2f}, most {regrets.max():.2f}; "
                      f"needless refusals {sum(1 for r in some if not r[2] and r[9])} of {len(some)}")
        methods = [r[6] for r in rows]
        print("taken:", {m: methods.count(m) for m in sorted(set(methods))})
        winners = [r[9][1].split()[0] for r in rows if r[9]]
        print("best by hindsight:", {m: winners.count(m) for m in sorted(set(winners))})


if __name__ == "__main__":
    main()
