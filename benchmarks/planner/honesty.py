"""Is accuracy asked accuracy got, and at what price? Random scenes against long-double truth, seeds fixed.

Run: python benchmarks/planner/honesty.py [scenes] [--seed 1] [--regret] [--uncertified] [--tight] [--save rows.jsonl]

Honesty: of the results that claim success, how many have their true error within the request; reported over true error.
Regret: time of solve, with every run of its certificate, over the time of the best single run that meets the request,
over all methods and tolerances on a grid of 10^(1/4), known by hindsight. CPU time of the thread, least of a few runs.

Every scene is drawn from (seed, number) alone. With --save each result is a line of a file, and a second run goes on
where the first one ended; --first 1000 begins elsewhere, and --merge a.jsonl b.jsonl reports what several files hold.
"""

import argparse
import json
import pathlib
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


def judge(number, options, truth, names):
    """One scene as a dict; `kind` alone where it has no truth in reach, goes beyond 1e4 turns or was not asked for."""
    rng = np.random.Generator(np.random.PCG64([options.seed, number]))
    one = draw(rng)
    low, high = options.accuracy
    accuracy = 10 ** -rng.uniform(low, high) if options.drawn_anew else max(one.accuracy, 1e-11)
    row = {"number": number, "kind": one.kind}
    if options.kind and one.kind != options.kind:
        return row
    known = truth(one, 60_000)
    if known is None or known[0] > 1e4:
        return row
    run = lambda: ph.solve(one.scene, accuracy, certify=not options.uncertified, max_steps=2_000_000)  # noqa: E731
    motion = run()
    best = hindsight(one, known, accuracy, names) if options.regret else None
    return row | {"accuracy": accuracy, "success": motion.success, "found": error(motion, known), "error": motion.error,
                  "error_kind": motion.error_kind, "method": motion.plan.method, "runs": motion.stats["runs"],
                  "turns": known[0], "took": cpu(run) if options.regret else 0.0, "best": best,
                  "message": motion.message}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("scenes", nargs="?", type=int, default=200)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0, help="number of the first scene that is drawn")
    parser.add_argument("--regret", action="store_true")
    parser.add_argument("--uncertified", action="store_true")
    parser.add_argument("--kind", choices=CLASSES)
    parser.add_argument("--tight", action="store_const", dest="accuracy", const=(12.0, 14.0),
                        help="accuracies of 1e-12 to 1e-14")
    parser.add_argument("--floor", action="store_const", dest="accuracy", const=(10.0, 12.0),
                        help="accuracies of 1e-10 to 1e-12")
    parser.add_argument("--save", type=pathlib.Path)
    parser.add_argument("--merge", type=pathlib.Path, nargs="+")
    options = parser.parse_args()
    options.drawn_anew = options.accuracy is not None
    options.accuracy = options.accuracy or (2.0, 12.0)
    if options.merge:
        rows = {row["number"]: row for path in options.merge for row in read(path)}
        return report(list(rows.values()), options)
    rows = read(options.save) if options.save and options.save.exists() else []
    number = max((row["number"] + 1 for row in rows), default=options.first)
    truth, names = Truth(), [m["name"] for m in ph.methods() if m["adaptive"]]
    done = sum("found" in row for row in rows)
    while done < options.scenes:
        rows.append(judge(number, options, truth, names))
        done += "found" in rows[-1]
        number += 1
        if options.save:
            with options.save.open("a") as file:
                file.write(json.dumps(rows[-1]) + "\n")
    return report(rows, options)


def read(path):
    return [json.loads(line) for line in path.read_text().splitlines()]


def spread(values):
    return f"median {np.median(values):.2f}, q95 {np.quantile(values, .95):.2f}, most {np.max(values):.2f}"


def report(drawn, options):
    rows = [row for row in drawn if "found" in row]
    claims = [r for r in rows if r["success"]]
    false = [r for r in claims if not r["found"] <= r["accuracy"]]
    refused = [r for r in rows if not r["success"]]
    print(f"{len(rows)} scenes, numbers {drawn[0]['number']} to {drawn[-1]['number']} of seed {options.seed}; "
          f"the {len(drawn) - len(rows)} others have no truth in reach, go beyond 1e4 turns or are not of the kind "
          "asked for")
    print(f"claims {len(claims)}, true {100 * (1 - len(false) / max(1, len(claims))):.2f} %, false {len(false)}"
          + (f", the worst by {max(r['found'] / r['accuracy'] for r in false):.2g} times" if false else ""))
    for r in false:
        print("  false:", r)
    kinds = {r["error_kind"] for r in refused}
    needless = [r for r in refused if r["found"] <= r["accuracy"]]
    print(f"refused {len(refused)} ({', '.join(sorted(kinds))}); of them the true error was within the request in "
          f"{len(needless)} ({100 * len(needless) / len(rows):.1f} %)")
    ratio = np.array([r["error"] / r["found"] for r in claims if r["found"] > 0])
    print(f"reported / true error: q2.5 {np.quantile(ratio, .025):.2g}, median {np.median(ratio):.2g}, q97.5 "
          f"{np.quantile(ratio, .975):.2g}; "
          f"within 1 ... 100 in {100 * np.mean((ratio >= 1) & (ratio <= 100)):.1f} %")
    for kind in CLASSES:
        some = [r for r in rows if r["kind"] == kind]
        if not some:
            continue
        line = (f"  {kind:9} {len(some):5} scenes, claims {sum(r['success'] for r in some)}, "
                f"runs {np.mean([r['runs'] for r in some]):.2f}")
        ratios = np.array([r["error"] / r["found"] for r in some if r["success"] and r["found"] > 0])
        line += (f", reported/true within 1..100 {100 * np.mean((ratios >= 1) & (ratios <= 100)):.0f} %, "
                 f"median {np.median(ratios):.2g}")
        print(line + tell_regret(some))
    for label, some in (("closed forms", [r for r in rows if r["method"] == "exact"]),
                        ("stepped", [r for r in rows if r["method"] != "exact"])):
        if tell_regret(some):
            print(label + tell_regret(some) + f" of {len(some)}")
    if any(r["best"] for r in rows):
        methods, winners = [r["method"] for r in rows], [r["best"][1].split()[0] for r in rows if r["best"]]
        print("taken:", {m: methods.count(m) for m in sorted(set(methods))})
        print("best by hindsight:", {m: winners.count(m) for m in sorted(set(winners))})


def tell_regret(rows):
    regrets = [r["took"] / r["best"][0] for r in rows if r["success"] and r["best"]]
    if not regrets:
        return ""
    refused = sum(1 for r in rows if not r["success"] and r["best"])
    return f"; regret {spread(regrets)}; refused though some run met it {refused}"


if __name__ == "__main__":
    main()
