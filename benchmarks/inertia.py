"""Principal axes and physical checks of many tensors: time and error of polhode and of numpy.linalg, side by side.

    python benchmarks/inertia.py [--count 1000000] [--repeat 5]

Times are the best of the repeats, one thread, arrays in memory. Errors are the worst over a sample, against mpmath in
50 digits for the moments; the residual is |I V - V diag(moments)|, all as a part of the largest moment.
"""

import argparse
import time

import mpmath as mp
import numpy as np

import polhode as ph


def bodies(count, rng):
    """Inertia tensors of random bodies: moments in the ratio 1 : 3 at most, turned anyhow."""
    factor = rng.normal(size=(count, 3, 3))
    spread = factor @ factor.transpose(0, 2, 1)
    tensors = np.trace(spread, axis1=1, axis2=2)[:, None, None] * np.eye(3) - spread
    return (tensors + tensors.transpose(0, 2, 1)) / 2


def nearly_equal(count, rng):
    """Two moments apart by 1e-10 of themselves."""
    q, _ = np.linalg.qr(rng.normal(size=(count, 3, 3)))
    tensors = q * np.array([1, 1 + 1e-10, 1.5]) @ q.transpose(0, 2, 1)
    return (tensors + tensors.transpose(0, 2, 1)) / 2


def best_time(call, repeat):
    best = np.inf
    for _ in range(repeat):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return best


def worst_errors(solver, tensors):
    moments, axes = solver(tensors)
    top = np.abs(moments).max(-1)
    residual = np.abs(tensors @ axes - axes * moments[:, None, :]).max((1, 2)) / top
    error = 0.0
    with mp.workdps(50):
        for tensor, found in zip(tensors, moments):
            exact = sorted(mp.eigsy(mp.matrix(tensor.tolist()), eigvals_only=True))
            error = max(error, max(float(abs(mp.mpf(f) - x) / exact[-1]) for f, x in zip(found, exact)))
    return error, residual.max()


def margins_by_numpy(tensors):
    a, b, c = np.moveaxis(np.linalg.eigvalsh(tensors), -1, 0)
    return (a + b - c) / c, None


def worst_margin(check, tensors):
    with mp.workdps(50):
        exact = [sorted(mp.eigsy(mp.matrix(tensor.tolist()), eigvals_only=True)) for tensor in tensors]
        return max(float(abs((a + b - c) / c - mp.mpf(x))) for (a, b, c), x in zip(exact, check(tensors)[0]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--sample", type=int, default=500, help="tensors compared with mpmath")
    options = parser.parse_args()
    solvers = {"polhode": ph.inertia.principal_axes, "numpy.linalg.eigh": lambda a: tuple(np.linalg.eigh(a))}
    print(f"{'tensors':14} {'solver':18} {'ns each':>8} {'moments':>9} {'residual':>9}")
    for make in (bodies, nearly_equal):
        tensors = make(options.count, np.random.default_rng(7))
        for name, solver in solvers.items():
            seconds = best_time(lambda: solver(tensors), options.repeat)
            error, residual = worst_errors(solver, tensors[: options.sample])
            print(f"{make.__name__:14} {name:18} {seconds / options.count * 1e9:8.0f} {error:9.1e} {residual:9.1e}")
    print(f"\n{'physical checks':33} {'ns each':>8} {'margins':>9}")
    tensors = bodies(options.count, np.random.default_rng(7))
    for name, check in {"polhode.inertia.check": ph.inertia.check, "numpy.linalg.eigvalsh": margins_by_numpy}.items():
        seconds = best_time(lambda: check(tensors), options.repeat)
        print(f"{name:33} {seconds / options.count * 1e9:8.0f} {worst_margin(check, tensors[: options.sample]):9.1e}")


if __name__ == "__main__":
    main()
