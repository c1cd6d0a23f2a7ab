"""Hold the interval type against MPFR on random bit patterns: containment always, and how wide the results are.

    python tests/reference/interval_mpfr.py [pairs] [seed]     (needs gmpy2 and a C++20 compiler)
    python tests/reference/interval_mpfr.py --write            stores the results of 300 pairs in interval.csv

Half of the doubles are random bit patterns (subnormal, huge, infinite and NaN among them), half are of ordinary size.
"""

from __future__ import annotations

import math
import subprocess
import sys
import tempfile
from pathlib import Path

import gmpy2
import numpy as np

HERE = Path(__file__).parent
STORED = ("sum", "difference", "product", "quotient", "square", "square root", "sine", "cosine")
NAMES = (*STORED, "exponential", "logarithm", "tanh", "angle")


def draw(pairs: int, seed: int) -> np.ndarray:
    """Return pairs of doubles of every kind, shape (pairs, 2)."""
    rng = np.random.default_rng(seed)
    values = rng.integers(0, 2**64, (pairs, 2), dtype=np.uint64, endpoint=False).view(np.float64).copy()
    ordinary = rng.random((pairs, 2)) < 0.5
    values[ordinary] = (rng.standard_normal((pairs, 2)) * 10.0 ** rng.uniform(-8, 8, (pairs, 2)))[ordinary]
    special = np.array([0.0, -0.0, 1.0, -1.0, 5e-324, 2.2250738585072014e-308, 1.7976931348623157e308, np.inf, -np.inf,
                        np.nan, 1.0 + 2.0**-52, 2.0**0.5, 1e290, 1e-290])
    chosen = rng.random((pairs, 2)) < 0.03
    values[chosen] = rng.choice(special, chosen.sum())
    near = rng.random(pairs) < 0.05   # sums that cancel
    with np.errstate(all="ignore"):
        values[near, 1] = -np.nextafter(values[near, 0], np.inf)
    return values


def exact(a: float, b: float) -> list[object]:
    """Return each result to 400 bits; None where it is not a number."""
    x, y = gmpy2.mpfr(a), gmpy2.mpfr(b)
    results = [x + y, x - y, x * y, x / y if b != 0 else None, x * x, gmpy2.sqrt(x) if a >= 0 else None]
    if abs(a) < 1e300:
        results += [gmpy2.sin(x), gmpy2.cos(x)]
    else:
        results += [None, None]
    # Far from 1 the results leave what 400 bits of a sum can hold, and the functions are unbounded there.
    results.append(gmpy2.exp(x) if abs(a) < 1e6 else None)
    results.append(gmpy2.log(x) if a > 0 else None)
    results.append(gmpy2.tanh(x))
    results.append(gmpy2.atan2(x, y) if a != 0 or b > 0 else None)   # elsewhere it is on the cut
    return results


def split(x: object) -> str:
    """Return a number as a sum of two float64 numbers, in hexadecimal."""
    high = float(x)
    return f"{high.hex()},{float(x - gmpy2.mpfr(high)).hex()}"


def write() -> None:
    """Store exact results for the test of each build: pairs whose results have both parts in range."""
    gmpy2.get_context().precision = 400
    lines = ["a,b," + ",".join(f"{name} high,{name} low" for name in STORED)]
    for a, b in draw(10_000, 3).tolist():
        usual = all(math.isfinite(x) and 1e-90 < abs(x) < 1e90 for x in (a, b)) and a > 0 and a != -b
        if usual and len(lines) <= 300:
            lines.append(",".join([a.hex(), b.hex(), *(split(x) for x in exact(a, b)[: len(STORED)])]))
    (HERE / "interval.csv").write_text("\n".join(lines) + "\n")


def main() -> None:
    """Draw, compute, compare, print."""
    if "--write" in sys.argv:
        return write()
    pairs = int(sys.argv[1]) if len(sys.argv) > 1 else 125_000
    values = draw(pairs, int(sys.argv[2]) if len(sys.argv) > 2 else 1)
    include = HERE.parents[1] / "cpp" / "include"
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "interval"
        subprocess.run(["c++", "-std=c++20", "-O2", "-ffp-contract=off", f"-I{include}",
                        str(HERE / "interval_mpfr.cpp"),
                        str(include.parent / "src" / "math" / "double_double.cpp"), "-o", str(program)], check=True)
        raw = subprocess.run([str(program)], input=values.tobytes(), stdout=subprocess.PIPE, check=True).stdout
    found = np.frombuffer(raw).reshape(pairs, len(NAMES), 5)
    gmpy2.get_context().precision = 400
    gmpy2.get_context().emin, gmpy2.get_context().emax = -(2**20), 2**20
    wrong = dict.fromkeys(NAMES, 0)
    wide: dict[str, list[float]] = {name: [] for name in NAMES}
    unbounded = dict.fromkeys(NAMES, 0)
    for (a, b), rows in zip(values.tolist(), found.tolist(), strict=True):
        if not (math.isfinite(a) and math.isfinite(b)):
            # the whole line, where the operand that counts is no number
            for name, row in zip(NAMES, rows, strict=True):
                wrong[name] += (not math.isfinite(a) or name in (*NAMES[:4], "angle")) \
                    and row[3:] != [-math.inf, math.inf] \
                    and not (name in ("sine", "cosine", "tanh") and row[3] <= -1 and row[4] >= 1)
            continue
        for name, (hi, lo, radius, lower, upper), truth in zip(NAMES, rows, exact(a, b), strict=True):
            if truth is None:
                continue
            middle = gmpy2.mpfr(hi) + gmpy2.mpfr(lo)
            inside = lower <= truth <= upper and (radius == math.inf or abs(truth - middle) <= gmpy2.mpfr(radius))
            wrong[name] += not inside
            if radius == math.inf:
                unbounded[name] += 1
            elif hi != 0 and 1e-150 < abs(hi) < 1e150:
                wide[name].append(radius / abs(hi))
    print(f"{pairs * len(NAMES)} operations")
    for name in NAMES:
        widths = np.array(wide[name])
        print(f"{name:12} wrong {wrong[name]}, relative radius median {np.median(widths):.1e}, 99 % "
              f"{np.quantile(widths, 0.99):.1e}, largest {widths.max():.1e}, unbounded {unbounded[name]}")
    sys.exit(any(wrong.values()))


if __name__ == "__main__":
    main()
