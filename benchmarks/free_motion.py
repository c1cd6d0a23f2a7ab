"""Free motion from Python: what a call costs, with the error beside it. Run: python benchmarks/free_motion.py

Times are the smallest of many repeats of the CPU time of this thread; errors are against the stored exact answers of
tests/reference, the largest of all regimes.
"""

import csv
import pathlib
import time

import numpy as np

import polhode as ph

TABLE = pathlib.Path(__file__).parents[1] / "tests" / "reference" / "free_motion.csv"


def best(work, repeats=30):
    work()
    found = np.inf
    for _ in range(repeats):
        start = time.thread_time_ns()
        work()
        found = min(found, time.thread_time_ns() - start)
    return found


def random_bodies(n, rng):
    half = rng.uniform(0.1, 1, (n, 3)) ** 2
    attitude = rng.normal(size=(n, 4))
    return half.sum(axis=1, keepdims=True) - half, rng.normal(size=(n, 3)), attitude / np.linalg.norm(attitude, axis=1, keepdims=True)


def largest_error():
    worst = 0.0
    for row in csv.DictReader(TABLE.open()):
        number = lambda *names: np.array([float(row[name]) for name in names])  # noqa: E731
        inertia = ph.InertiaTensor.from_moments(number("I1", "I2", "I3"), physical=False)
        w, q = ph.FreeMotion(inertia, number("w1", "w2", "w3"), number("x0", "y0", "z0", "w0")).at(float(row["t"]))
        expected, p = number("o1", "o2", "o3"), number("x", "y", "z", "w")
        worst = max(worst, np.linalg.norm((w - expected) / (np.abs(expected).max() or 1)), 2 * np.linalg.norm(q - p * np.sign(p @ q)))
    return worst


def main():
    rng = np.random.default_rng(1)
    block = (0.20, 0.40, 0.52)
    generic, racket = ph.FreeMotion(block, (1, 2, 3)), ph.FreeMotion(block, (1e-4, 5, 1e-4))
    times = rng.uniform(0, 1000, 16384)
    out = (np.empty((16384, 3)), np.empty((16384, 4)))
    print(f"level {ph.build_info()['simd']}, largest error over the stored table {largest_error():.1e}")
    for name, motion in (("triaxial", generic), ("racket, near the separatrix", racket)):
        arguments = (motion.inertia, motion.omega, motion.attitude, times)
        cost = best(lambda arguments=arguments: ph.free_motion(*arguments, out=out, threads=1)) / times.size
        print(f"one body, any times, into out=: {name}: {cost:.1f} ns a state")
    grid = np.linspace(0, 1000, 1001)
    print(f"S1, 1001 samples, set-up and call included: {best(lambda: ph.FreeMotion(block, (1, 2, 3)).at(grid)) / 1e3:.1f} us")
    print(f"FreeMotion(...): {best(lambda: ph.FreeMotion(block, (1, 2, 3))) / 1e3:.2f} us; .at(float): {best(lambda: generic.at(1.5)) / 1e3:.2f} us")
    n = 100_000
    bodies = random_bodies(n, rng)
    t = rng.uniform(0, 1000, n)
    out = (np.empty((n, 3)), np.empty((n, 4)))
    print(f"S8, {n} bodies at one time each: {best(lambda: ph.free_motion(*bodies, t, out=out, threads=1), 5) / n:.1f} ns a body")
    n, m = 4000, 500
    bodies = [a[:n, None] for a in bodies]
    out = (np.empty((n, m, 3)), np.empty((n, m, 4)))
    t = np.linspace(0, 1000, m)
    print(f"outer grid {n} x {m}: {best(lambda: ph.free_motion(*bodies, t, out=out, threads=1), 5) / (n * m):.1f} ns a state")


if __name__ == "__main__":
    main()
