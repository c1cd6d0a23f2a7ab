"""The closed forms from Python: what each job costs, with its error and its goal beside. Each instruction set runs in
its own process.

    python benchmarks/free_motion.py            # one core
    python benchmarks/free_motion.py --threads  # and two threads against one on 100 000 x 500 states (2.8 GB)

Times are the smallest of many repeats of the CPU time of this thread, so that other work counts as little as it can;
two threads are timed by the clock on the wall. Errors of single times are against the stored exact answers of
tests/reference, the largest of all regimes; those of grids are told as the distance from single times.
"""

import argparse
import csv
import json
import os
import pathlib
import subprocess
import sys
import time

import numpy as np
from timing import best

import polhode as ph

TABLE = pathlib.Path(__file__).parents[1] / "tests" / "reference" / "free_motion.csv"
BLOCK, START = (0.20, 0.40, 0.52), (0.0, 0.0, 0.0, 1.0)
TOP = ((1.0, 1.0, 0.5), 1.3, (0.1, 0.2, 5.0), (0.6, 0.0, 0.0, 0.8))
GENERIC, RACKET = (BLOCK, (1, 2, 3), START), (BLOCK, (1e-4, 5, 1e-4), START)
NEARLY = ((0.4, 0.4 * (1 + 1e-15), 0.52), (1, 2, 3), START)
WHEEL = (BLOCK, (0.1, -0.3, 0.5), (1, 2, 3), START)

# job: goals in ns (us where it says so) on avx512 and avx2, for an Intel Xeon with two 512-bit operations a cycle.
# Those of avx2 are of the loops alone, with their output in the cache.
GOALS = {
    "free motion, any times": (5.0, 6),
    "free motion, uniform grid": (4.3, 4.7),
    "free motion, any times, directions alone": (None, None),
    "free motion, any times, float32": (2, None),
    "near the separatrix, any times": (7, None),
    "nearly symmetric, any times": (5.0, 6),
    "heavy top, any times": (7, None),
    "heavy top, uniform grid": (None, None),
    "gyrostat, any times": (None, None),
    "S8: a body at one time each, set-up included": (150, None),
    "outer grid, bodies x 500 times": (None, None),
    "free_motion of one body at 1001 times [us]": (10, None),
    "S1's 1001 samples, call and set-up [us]": (None, None),
    "FreeMotion(...) [us]": (None, None),
    "HeavyTop(...) [us]": (None, None),
    ".at(float) [us]": (None, None),
}


def random_bodies(n, rng):
    half = rng.uniform(0.1, 1, (n, 3)) ** 2
    attitude = rng.normal(size=(n, 4))
    attitude /= np.linalg.norm(attitude, axis=1, keepdims=True)
    return half.sum(axis=1, keepdims=True) - half, rng.normal(size=(n, 3)), attitude


def largest_error():
    worst = 0.0
    for row in csv.DictReader(TABLE.open()):
        def number(*names, row=row):
            return np.array([float(row[name]) for name in names])

        inertia = ph.InertiaTensor.from_moments(number("I1", "I2", "I3"), physical=False)
        w, q = ph.FreeMotion(inertia, number("w1", "w2", "w3"), number("x0", "y0", "z0", "w0")).at(float(row["t"]))
        expected, p = number("o1", "o2", "o3"), number("x", "y", "z", "w")
        worst = max(worst, np.linalg.norm((w - expected) / (np.abs(expected).max() or 1)),
                    2 * np.linalg.norm(q - p * np.sign(p @ q)))
    return worst


def grid_distance(motion, grid):
    w, q = motion.at(grid)
    pairs = [motion.at(float(t)) for t in grid]
    w1, q1 = np.array([a for a, _ in pairs]), np.array([b for _, b in pairs])
    return max(np.linalg.norm(w - w1, axis=1).max() / np.abs(w1).max(), 2 * np.linalg.norm(q - q1, axis=1).max())


def outer(n, m=500):
    moments, omega, attitude = (a[:, None] for a in random_bodies(n, np.random.default_rng(2)))
    out = (np.empty((n, m, 3)), np.empty((n, m, 4)))
    times = np.linspace(0, 1000, m)
    return lambda threads: ph.free_motion(moments, omega, attitude, times, out=out, threads=threads)


def measure():
    rng = np.random.default_rng(1)
    n = 65536  # so that the call itself, 10 to 20 us, is little
    times, grid = rng.uniform(0, 1000, n), np.linspace(0, 1000, n)
    out = (np.empty((n, 3)), np.empty((n, 4)))
    cost = {}
    for name, t in (("any times", times), ("uniform grid", grid)):
        cost[f"free motion, {name}"] = best(lambda t=t: ph.free_motion(*GENERIC, t, out=out, threads=1)) / n
        cost[f"heavy top, {name}"] = best(lambda t=t: ph.heavy_top(*TOP, t, out=out, threads=1)) / n
    axes, singles = np.empty((n, 3)), (np.empty((n, 3), np.float32), np.empty((n, 4), np.float32))
    cost["free motion, any times, directions alone"] = best(
        lambda: ph.free_motion(*GENERIC, times, out=axes, want="direction", axis=(0, 0, 1), threads=1)) / n
    cost["free motion, any times, float32"] = best(
        lambda: ph.free_motion(*GENERIC, times, out=singles, dtype="float32", threads=1)) / n
    cost["nearly symmetric, any times"] = best(lambda: ph.free_motion(*NEARLY, times, out=out, threads=1)) / n
    cost["gyrostat, any times"] = best(lambda: ph.gyrostat(*WHEEL, times, out=out, threads=1)) / n
    cost["near the separatrix, any times"] = best(lambda: ph.free_motion(*RACKET, times, out=out, threads=1)) / n
    many = 100_000
    bodies, t, out = random_bodies(many, rng), rng.uniform(0, 1000, many), (np.empty((many, 3)), np.empty((many, 4)))
    name = "S8: a body at one time each, set-up included"
    cost[name] = best(lambda: ph.free_motion(*bodies, t, out=out, threads=1), 5) / many
    run = outer(4000)
    cost["outer grid, bodies x 500 times"] = best(lambda: run(1), 7) / (4000 * 500)
    samples = np.linspace(0, 1000, 1001)
    cost["free_motion of one body at 1001 times [us]"] = best(lambda: ph.free_motion(*GENERIC, samples), 300) / 1e3
    cost["S1's 1001 samples, call and set-up [us]"] = best(lambda: ph.FreeMotion(*GENERIC).at(samples), 300) / 1e3
    motion = ph.FreeMotion(*GENERIC)
    for name, work in ((".at(float) [us]", lambda: motion.at(1.5)),
                       ("FreeMotion(...) [us]", lambda: ph.FreeMotion(*GENERIC)),
                       ("HeavyTop(...) [us]", lambda: ph.HeavyTop(*TOP))):
        cost[name] = best(lambda work=work: [work() for _ in range(100)], 100) / 1e5
    far = np.linspace(0, 1000, 4096)
    errors = [largest_error(), grid_distance(motion, far), grid_distance(ph.HeavyTop(*TOP), far)]
    return {"level": ph.build_info()["simd"], "cost": cost, "errors": errors}


def two_threads():
    """Wall time of one thread over that of two, interleaved; and the processor time of both, which other work disturbs
    less: its ratio says what two threads could do with two cores of their own."""
    run = outer(100_000)
    run(2)
    wall, processor = {1: [], 2: []}, {1: [], 2: []}
    for _ in range(4):
        for threads in (1, 2):
            start, spent = time.perf_counter(), time.process_time()
            run(threads)
            wall[threads].append((time.perf_counter() - start) / 5e-2)
            processor[threads].append((time.process_time() - spent) / 5e-2)
    (one, two), (alone, both) = ([min(found[k]) for k in (1, 2)] for found in (wall, processor))
    print(f"outer grid 100 000 x 500, ns a state: by the clock {one:.2f} with one thread, {two:.2f} with two, "
          f"{one / two:.2f} times faster (goal 1.7); processor time {alone:.2f} and {both:.2f}, so "
          f"{2 * alone / both:.2f} "
          f"times on idle cores; load {os.getloadavg()[0]:.1f}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--threads", action="store_true")
    parser.add_argument("--one", action="store_true", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        return print(json.dumps(measure()))
    if options.threads:
        return two_threads()
    found = {}
    for level in ("avx512", "avx2"):
        run = subprocess.run([sys.executable, __file__, "--one"], check=True, capture_output=True,
                             env={**os.environ, "POLHODE_SIMD": level})
        answer = json.loads(run.stdout)
        found[answer["level"]] = answer
    print(f"load {os.getloadavg()[0]:.1f}; ns a state unless it says us, goal beside it")
    print(f"{'':48}" + "".join(f"{level:>9}{'goal':>7}" for level in found))
    for job, goals in GOALS.items():
        line = f"{job:48}"
        for level, answer in found.items():
            goal = goals[level != "avx512"]
            line += f"{answer['cost'][job]:9.2f}{goal or '':>7}"
        print(line)
    for level, answer in found.items():
        table, free, top = answer["errors"]
        print(f"{level}: largest error over the stored table {table:.1e}; a grid from single times {free:.1e}, top "
              f"{top:.1e}")


if __name__ == "__main__":
    main()
