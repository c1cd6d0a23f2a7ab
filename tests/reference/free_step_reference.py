"""Truth for the free step: the turn of a free body over one step, by mpmath with 30 digits.

    python tests/reference/free_step_reference.py > tests/reference/free_step.csv

Independent of the formulas of polhode/step.hpp: Taylor series of Euler's equations and of the quaternion's, with 40
terms, over parts of a step in which the body turns by less than 0.5 rad.
Columns: kind, moments, L, h, and the quaternion p with R(p) from the principal axes after the step to those before.
"""

import random

from mpmath import ceil, mp, mpf, nstr, sqrt

mp.dps = 34
TERMS = 40


def part(moments, L, p, h):
    """Move (L in principal axes, p) by h with the Taylor series of L' = L x w and p' = p (w, 0) / 2."""
    a, b = [[x] for x in L], [[x] for x in p]
    w = [[x / I] for x, I in zip(L, moments)]

    def convolve(u, v, n):
        return sum(u[j] * v[n - j] for j in range(n + 1))

    for n in range(TERMS):
        next_a = [(convolve(a[(i + 1) % 3], w[(i + 2) % 3], n) - convolve(a[(i + 2) % 3], w[(i + 1) % 3], n)) / (n + 1)
                  for i in range(3)]
        x, y, z, s = b
        halves = [convolve(s, w[0], n) + convolve(y, w[2], n) - convolve(z, w[1], n),
                  convolve(s, w[1], n) + convolve(z, w[0], n) - convolve(x, w[2], n),
                  convolve(s, w[2], n) + convolve(x, w[1], n) - convolve(y, w[0], n),
                  -convolve(x, w[0], n) - convolve(y, w[1], n) - convolve(z, w[2], n)]
        for i in range(3):
            a[i].append(next_a[i])
            w[i].append(next_a[i] / moments[i])
        for i in range(4):
            b[i].append(halves[i] / (2 * (n + 1)))

    def value(c):
        return sum(x * h**k for k, x in enumerate(c))

    return [value(c) for c in a], [value(c) for c in b]


def turn(moments, L, h):
    moments, L, h = [mpf(x) for x in moments], [mpf(x) for x in L], mpf(h)
    rate = max(abs(x) / I for x, I in zip(L, moments))
    count = max(1, int(ceil(abs(h) * rate / mpf("0.5"))))
    p = [mpf(0), mpf(0), mpf(0), mpf(1)]
    for _ in range(count):
        L, p = part(moments, L, p, h / count)
    size = sqrt(sum(x * x for x in p))
    return [x / size for x in p]


def cases():
    rng = random.Random(15)
    bodies = {"box": (0.2, 0.4, 0.5), "other order": (0.5, 0.2, 0.4), "near-symmetric": (1.0, 1.001, 0.6),
              "symmetric": (0.4, 0.4, 0.2), "disk": (0.5, 1.0, 0.5), "needle": (0.05, 1.0, 1.0),
              "sphere": (1.0, 1.0, 1.0)}
    for kind, moments in bodies.items():
        for h in (0.1, 0.5, 1.0, -1.0):
            w = [rng.gauss(0, 1) for _ in range(3)]
            size = sum(x * x for x in w) ** 0.5
            yield kind, moments, [I * x / size for I, x in zip(moments, w)], h
    yield "racket", (0.2, 0.4, 0.5), [0.2e-4, 2.0, 0.5e-4], 1 / 60
    yield "racket", (0.2, 0.4, 0.5), [0.2e-4, 0.4, 0.5e-4], 1.0
    for axis in range(3):
        yield "principal", (0.2, 0.4, 0.5), [(0.2, 0.4, 0.5)[i] * (i == axis) for i in range(3)], 2.0


if __name__ == "__main__":
    print("kind,I1,I2,I3,L1,L2,L3,h,x,y,z,w")
    for kind, moments, L, h in cases():
        p = turn(moments, L, h)
        print(kind, *(repr(float(x)) for x in (*moments, *L, h)), *(nstr(x, 25) for x in p), sep=",")
