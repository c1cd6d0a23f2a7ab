"""What sums over bodies cost beside the states that they are made from: one interleaved run, one thread.

    python benchmarks/summary.py [--bodies 16384] [--times 500] [--rounds 9]

The states alone are written into arrays that are used again, in blocks that fit the cache best. Each figure is the
least of all rounds: processor time in nanoseconds a state.
"""

import argparse
import time

import numpy as np

import polhode as ph
from polhode import _core

BLOCK = 256   # bodies whose states are written at once


def measure(functions, rounds):
    best = dict.fromkeys(functions, float("inf"))
    for _ in range(rounds):
        for name, function in functions.items():
            begin = time.process_time()
            function()
            best[name] = min(best[name], time.process_time() - begin)
    return best


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bodies", type=int, default=16384)
    parser.add_argument("--times", type=int, default=500)
    parser.add_argument("--rounds", type=int, default=9)
    given = parser.parse_args()
    n, times = given.bodies, np.linspace(0.0, 100.0, given.times)
    moments = _core._draw("uniform", 1, "moments", 0, n, [[0.02, 0.03], [0.03, 0.04], [0.035, 0.045]])
    omega = _core._draw("normal", 1, "omega", 0, n, [[0.0, 0.1], [0.0, 0.1], [1.0, 0.1]])
    attitude = _core._draw("turn", 1, "attitude", 0, n, [[0.05, 0.05, 0.05]])
    nominal = ph.FreeMotion([0.025, 0.035, 0.04], [0.0, 0.0, 1.0]).at(times)[1]
    out = (np.empty((BLOCK, times.size, 3)), np.empty((BLOCK, times.size, 4)))

    def blocks(use):
        for i in range(0, n, BLOCK):
            use(*ph.free_motion(*(a[i:i + BLOCK, None] for a in (moments, omega, attitude)), times, out=out, threads=1))

    def summary(*quantities):
        def run():
            _core._Summary(list(quantities), times.size).add_free(0, moments, omega, attitude, times, 1)
        return run

    edges = np.geomspace(1e-3, np.pi, 257)

    def numpy_angle(_, q):
        scalar = np.abs(np.einsum("tk,btk->bt", nominal, q))
        angle = 2 * np.arccos(np.minimum(scalar, 1.0))
        angle.sum(axis=0), (angle**2).sum(axis=0), angle.min(axis=0), angle.max(axis=0)
        bins = np.searchsorted(edges, angle)
        for k in range(times.size):
            np.bincount(bins[:, k], minlength=258)

    def whole(**options):
        whole_out = (np.empty((4096, times.size, 3)), np.empty((4096, times.size, 4)))
        arrays = [a[:4096, None] for a in (moments, omega, attitude)]
        return lambda: ph.free_motion(*arrays, times, out=whole_out, threads=1, **options)

    angle = {"of": "angle", "nominal": nominal}
    axis = {"of": "axis_angle", "axis": (0, 0, 1), "target": (0, 0, 1)}
    found = measure({
        "states alone, into arrays": lambda: blocks(lambda *_: None),
        "angle": summary(angle), "axis_angle": summary(axis), "omega": summary({"of": "omega"}),
        "energy": summary({"of": "energy"}), "attitude": summary({"of": "attitude", "nominal": nominal}),
        "angle and attitude": summary(angle, {"of": "attitude", "nominal": nominal}),
        "angle, axis_angle, omega, energy": summary(angle, axis, {"of": "omega"}, {"of": "energy"}),
        "angle in NumPy": lambda: blocks(numpy_angle)}, given.rounds)
    alone = found["states alone, into arrays"]
    calls = measure({"free_motion": whole(), "with progress": whole(progress=lambda *_: None)}, given.rounds)
    print(f"{n} bodies at {times.size} times, one thread, level {_core.build_info()['simd']}\n")
    print("| what | ns a state | times the states alone |\n|---|---|---|")
    for name, seconds in found.items():
        print(f"| {name} | {seconds / (n * times.size) * 1e9:.1f} | {seconds / alone:.2f} |")
    plain, reported = calls.values()
    print(f"\nfree_motion of 4096 bodies: {plain * 1e3:.1f} ms, with progress {reported * 1e3:.1f} ms "
          f"({reported / plain:.3f})")
    for kind, parameters in (("uniform", [[0, 1]]), ("normal", [[0, 1]]), ("truncated_normal", [[0, 1, -2, 2]]),
                             ("log_uniform", [[1, 2]]), ("sphere", np.empty((0, 0))), ("attitude", np.empty((0, 0)))):
        cost = measure({kind: lambda kind=kind, rows=parameters: _core._draw(kind, 1, "x", 0, n, rows)}, given.rounds)
        print(f"draw {kind}: {cost[kind] / n * 1e9:.0f} ns a body")


if __name__ == "__main__":
    main()
