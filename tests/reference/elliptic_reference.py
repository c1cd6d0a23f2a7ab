"""Makes elliptic.csv: Jacobi's functions, K and the nome by mpmath, on the complementary pair (m, m1).

The smaller of m and m1 is a float64 number taken as exact; digits enough for 1 - 1e-300. Run: python
elliptic_reference.py
"""

import csv
import pathlib
import random

from mpmath import ellipfun, ellipk, exp, mp, mpf, nint, pi

TABLE = pathlib.Path(__file__).with_name("elliptic.csv")


def main():
    rng = random.Random(7)
    pairs = [(0.5, 0.5), (0.97, 0.03), (0.03, 0.97)]
    pairs += [(None, 10.0 ** -rng.uniform(0.1, 3)) for _ in range(40)]
    pairs += [(None, 10.0 ** (-300 * i / 39)) for i in range(1, 40)]
    pairs += [(10.0 ** -rng.uniform(0.1, 3), None) for _ in range(15)]
    pairs += [(10.0 ** (-300 * i / 14), None) for i in range(1, 15)]
    with TABLE.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["u", "m", "m1", "sn", "cn", "dn", "K", "nome"])
        for m, m1 in pairs:
            mp.dps = 40 + int(-mp.log10(m1 if m1 is not None else m)) * 2
            M = mpf(m) if m is not None and (m1 is None or m <= m1) else 1 - mpf(m1)
            K = ellipk(M)
            q = exp(-pi * ellipk(1 - M) / K)
            for size in (rng.uniform(-3, 0), rng.uniform(0, 3), rng.uniform(3, 6)):
                u = float(rng.choice((-1, 1)) * 10.0**size * K)
                reduced = mpf(u) - 4 * K * nint(mpf(u) / (4 * K))
                values = [float(ellipfun(f, reduced, m=M)) for f in ("sn", "cn", "dn")]
                writer.writerow([repr(u), repr(float(M)), repr(float(1 - M)), *map(repr, values), repr(float(K)),
                                 repr(float(q))])


if __name__ == "__main__":
    main()
