"""Speed of rotations beside SciPy's, in one run, each with its error.

    python benchmarks/attitude.py [--count 1000000] [--repeats 9] [--json FILE]

A time is that of one call from Python, allocation of the result and page faults included, over the number of
rotations: the median of repeats in which the two take turns, on the processor's clock and on the wall's (the same on a
machine that does nothing else). Both get the same input arrays, and run in one thread. An error is the largest
difference of a matrix, vector or trace from a reference in extended precision (80 bits) over a sample.
"""

import argparse
import json
import platform
import statistics
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy
from scipy.spatial.transform import Rotation as SciPy

import polhode as ph

Long = np.longdouble
SAMPLE = 20_000


def matrix(quat):
    """R of the direction of a quaternion, in extended precision."""
    x, y, z, w = np.moveaxis(quat.astype(Long), -1, 0)
    s = 2 / (x * x + y * y + z * z + w * w)
    rows = [
        [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
        [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
        [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), (0, 1), (-2, -1))


def euler_matrix(sequence, angles):
    product = np.eye(3, dtype=Long)
    for letter, angle in zip(sequence, np.moveaxis(angles.astype(Long), -1, 0)):
        i = "xyz".index(letter.lower())
        turn = np.zeros((len(angles), 3, 3), Long)
        j, k = (i + 1) % 3, (i + 2) % 3
        turn[:, i, i], turn[:, j, j], turn[:, k, k] = 1, np.cos(angle), np.cos(angle)
        turn[:, k, j], turn[:, j, k] = np.sin(angle), -np.sin(angle)
        product = dot(product, turn) if letter.isupper() else dot(turn, product)
    return product


def dot(a, b):
    return np.einsum("...ij,...jk->...ik", a, b)


def cases(count: int) -> list[tuple[str, Callable[[Any], Any], Callable[[Any, slice], Any]]]:
    """Name, the call given the class, the error of its result over a slice."""
    rng = np.random.default_rng(1)
    angles = rng.uniform(-np.pi, np.pi, (count, 3))
    vectors = rng.normal(size=(count, 3))
    quats = [SciPy.random(count, rng=seed).as_quat() for seed in (2, 3)]
    left, right = ({cls: cls.from_quat(quat) for cls in (ph.Rotation, SciPy)} for quat in quats)
    matrices = left[SciPy].as_matrix()
    rotvecs = left[SciPy].as_rotvec()

    def largest(difference):
        return float(np.abs(difference).max())

    def of_rotation(expected):
        return lambda result, part: largest(matrix(result[part].as_quat()) - expected(part))

    def exact(part):
        return matrix(quats[0][part])

    return [
        ("from_euler ZYX", lambda cls: cls.from_euler("ZYX", angles),
         of_rotation(lambda part: euler_matrix("ZYX", angles[part]))),
        ("from_euler zxz", lambda cls: cls.from_euler("zxz", angles),
         of_rotation(lambda part: euler_matrix("zxz", angles[part]))),
        ("multiply", lambda cls: left[cls] * right[cls],
         of_rotation(lambda part: dot(exact(part), matrix(quats[1][part])))),
        ("apply", lambda cls: left[cls].apply(vectors),
         lambda result, part: largest(result[part] - np.einsum("nij,nj->ni", exact(part), vectors[part].astype(Long)))),
        ("inv", lambda cls: left[cls].inv(), of_rotation(lambda part: np.swapaxes(exact(part), -1, -2))),
        ("as_matrix", lambda cls: left[cls].as_matrix(), lambda result, part: largest(result[part] - exact(part))),
        ("from_matrix", lambda cls: cls.from_matrix(matrices), of_rotation(lambda part: matrices[part].astype(Long))),
        ("as_rotvec", lambda cls: left[cls].as_rotvec(), lambda result, part: largest(result[part] - rotvecs[part])),
        ("from_rotvec", lambda cls: cls.from_rotvec(rotvecs), of_rotation(exact)),
        ("as_euler ZYX", lambda cls: left[cls].as_euler("ZYX"),
         lambda result, part: largest(euler_matrix("ZYX", result[part]) - exact(part))),
        ("magnitude", lambda cls: left[cls].magnitude(),
         lambda result, part: largest(
             2 * np.cos(result[part].astype(Long)) + 1 - np.trace(exact(part), axis1=1, axis2=2))),
        ("from_quat", lambda cls: cls.from_quat(quats[0]), of_rotation(exact)),
    ]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=1_000_000)
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--json", metavar="FILE")
    options = parser.parse_args()
    part = slice(0, min(SAMPLE, options.count))
    print(f"{options.count} rotations, ns each, median of {options.repeats} repeats in turns; "
          f"NumPy {np.__version__}, SciPy {scipy.__version__}, {platform.machine()}, one thread")
    print(f"{'':16}|{'polhode CPU':>12}{'wall':>8}{'error':>9} |{'SciPy CPU':>12}{'wall':>8}{'error':>9} |{'ratio':>6}")
    table = []
    for name, call, error in cases(options.count):
        classes = {"polhode": ph.Rotation, "scipy": SciPy}
        row: dict[str, Any] = {"call": name}
        taken: dict[str, list[tuple[float, float]]] = {who: [] for who in classes}
        for who, cls in classes.items():
            row[f"{who}_error"] = error(call(cls), part)
        for _ in range(options.repeats):
            for who, cls in classes.items():
                start = time.thread_time(), time.perf_counter()
                call(cls)
                taken[who].append((time.thread_time() - start[0], time.perf_counter() - start[1]))
        for who, times in taken.items():
            row[f"{who}_cpu_ns"], row[f"{who}_wall_ns"] = (
                1e9 * statistics.median(clock) / options.count for clock in zip(*times))
        row["ratio"] = row["scipy_cpu_ns"] / row["polhode_cpu_ns"]
        table.append(row)
        print(f"{name:16}" + "".join(
            f"|{row[who + '_cpu_ns']:12.1f}{row[who + '_wall_ns']:8.1f}{row[who + '_error']:9.0e} " for who in classes
        ) + f"|{row['ratio']:6.1f}", flush=True)
    if options.json:
        with open(options.json, "w") as file:
            json.dump({"count": options.count, "repeats": options.repeats, "rows": table}, file, indent=1)


if __name__ == "__main__":
    main()
