"""The steppers beside other programs: the time of one run at the cheapest setting whose true error meets each level.

    python benchmarks/steppers.py [S4 S5 ...] [-o results.json] [--calls]

Who takes part is what `polhode chart` knows: the methods of the list and the programs that are installed, a missing one
named as missing. A time is the least CPU time of the thread over interleaved repeats, all samples included, since the
machine may be busy. Start-up and compilation are not in it: each setting runs once before the clock. --calls: what a
torque of the user's own costs per call.
"""

import argparse
import json
import pathlib
import sys
import time

import numpy as np

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
from measures import error, truth  # noqa: E402

import polhode as ph  # noqa: E402
from polhode.charts.candidates import candidates  # noqa: E402

SCENES = ("S4", "S5", "S6", "S7", "S7b", "S9")
LEVELS = (1e-3, 1e-6, 1e-9, 1e-12)
REPEATS, LONGEST = 7, 2.0   # of each point; no repeat of what takes longer than this [s]


def sweep(one, reference, taking_part):
    """Every setting of everyone on a scene: {name: [(label, error, least seconds)]}."""
    points = {}
    for candidate in taking_part:
        try:
            run = candidate.start(one)
        except Exception as why:   # a peer that cannot be built is a line of the table, not the end of it
            print(f"  {candidate.name}: {why}")
            continue
        for label, value in candidate.settings(one):
            try:
                answer = run(value, LONGEST)   # what is compiled at the first run is compiled here
                begin = time.thread_time()
                run(value, LONGEST)
                seconds = time.thread_time() - begin
            except Exception as why:
                points.setdefault(candidate.name, []).append([label, str(why), None, None])
                break
            point = [label, error(answer.omega, answer.attitude, reference), seconds,
                     lambda run=run, value=value: run(value, None)]
            points.setdefault(candidate.name, []).append(point)
            if seconds > LONGEST:
                break
    for _ in range(REPEATS):
        for rows in points.values():
            for point in rows:
                if point[3] is not None and point[2] < LONGEST / REPEATS:
                    begin = time.thread_time()
                    point[3]()
                    point[2] = min(point[2], time.thread_time() - begin)
    return {name: [tuple(point[:3]) for point in rows] for name, rows in points.items()}


def show(name, points):
    print(f"\n{name:24}" + "".join(f"{level:>12.0e}" for level in LEVELS) + f"{'least error':>14}")
    for who, rows in points.items():
        good = [(e, s) for _, e, s in rows if s is not None]
        if not good:
            print(f"{who:24}{rows[0][1]}")
            continue
        cells = ""
        for level in LEVELS:
            times = [s for e, s in good if e <= level]
            cells += f"{1e6 * min(times):9.0f} us" if times else f"{'-':>12}"
        print(f"{who:24}{cells}{min(e for e, _ in good):14.1e}")


def least(function, repeats=9):
    best = np.inf
    for _ in range(repeats):
        begin = time.thread_time()
        result = function()
        best = min(best, time.thread_time() - begin)
    return best, result


def show_calls():
    """The same torque built in, compiled and in Python: the difference a right-hand side, and the callable's part."""
    values, methods = (0.01, -0.02, 0.03), {"dop853": 1e-12, "rk45": 1e-9}
    built_in = ph.torques.Constant(values)

    def extra(torque, repeats=25):
        """Seconds a right-hand side beyond the torque that is built in, by method; interleaved."""
        one, other = (ph.Scene(inertia=(0.2, 0.4, 0.52), omega=(1, 2, 3), torques=[t], times=[0.0, 100.0])
                      for t in (torque, built_in))
        best = {}
        for method, rtol in methods.items():
            cost = [np.inf, np.inf]
            for _ in range(repeats):
                for k, scene in enumerate((one, other)):
                    begin = time.thread_time()
                    motion = ph.solve(scene, method=method, rtol=rtol)
                    cost[k] = min(cost[k], (time.thread_time() - begin) / motion.stats["derivatives"])
            best[method] = cost[0] - cost[1]
            print(f"  built in, {method}: {1e9 * cost[1]:.1f} ns a right-hand side")
        return best

    def python(t, omega, attitude):
        return values

    def show(name, torque, own):
        for method, seconds in extra(torque).items():
            print(f"{name}, {method}: {1e9 * seconds:.1f} ns a call, {1e9 * own:.1f} of them its own, "
                  f"{1e9 * (seconds - own):.1f} ours")

    own = least(lambda: [python(0.0, None, None) for _ in range(100_000)])[0] / 1e5
    show("Python callable", ph.torques.Custom(python), own)
    try:
        from numba import cfunc, njit, types
    except ImportError:
        print("compiled: numba is not installed")
        return
    pointer = types.CPointer(types.double)

    @cfunc(types.void(types.double, pointer, pointer, pointer, types.voidptr))
    def compiled(t, omega, attitude, torque, data):
        torque[0], torque[1], torque[2] = 0.01, -0.02, 0.03

    called = compiled.ctypes

    @njit
    def call_many(n, omega, torque):
        for _ in range(n):
            called(0.0, omega.ctypes, omega.ctypes, torque.ctypes, omega.ctypes)
        return torque[0]

    numbers, count = np.ones(4), 1_000_000
    call_many(1, numbers, numbers)
    show("compiled (numba)", ph.torques.Custom(compiled), least(lambda: call_many(count, numbers, numbers))[0] / count)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", default=SCENES)
    parser.add_argument("-o", "--output", help="write every point as JSON")
    parser.add_argument("--calls", action="store_true", help="what a torque of the user's own costs, and nothing else")
    parser.add_argument("--no-peers", action="store_true")
    options = parser.parse_args()
    if options.calls:
        return show_calls()
    results = {"polhode": ph.build_info(), "scenes": {}}
    for name in options.scenes:
        one = ph.Scene.load(name)
        taking_part = [c for c in candidates(with_peers=not options.no_peers) if c.family in ("method", "peer")
                       and not c.refuses(one)]
        results["scenes"][name] = sweep(one, truth(name), taking_part)
        show(name, results["scenes"][name])
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps(results, indent=1))


if __name__ == "__main__":
    main()
