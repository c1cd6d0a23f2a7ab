"""Reference motions of Lagrange's top with a rotor on its axis, by two routes.

    python tests/reference/heavy_gyrostat_reference.py            # writes heavy_gyrostat.json next to this file
    python tests/reference/heavy_gyrostat_reference.py --check    # compares the routes alone

Route 1: the plain top with omega3 + h / C by Legendre's integrals (heavy_top_reference.py), turned back about its axis
by h t / C. Route 2: power series of the full equations J w' = (J w + h) x w + tau with all three moments, 60 digits.
Route 2 knows neither the top nor the rotation. `cond` is the largest move of the exact answer when one input moves by
half an ulp, by route 1.
"""

import json
import math
import pathlib
import random
import sys

import mpmath as mp
from attitude_series import append_row
from heavy_top_reference import legendre, moved, start
from mpmath import mpf

mp.mp.dps = 60
ANY = (0.3, -2.5, 7.7, 1e3, 1e6)
SHORT = (0.3, -2.5, 7.7, 20.0)


def families(rng):
    """(name, A, C, M, h, omega, q, times)."""
    for h in (1e-18, 1e-12, 1e-6, 1e-2, 1.0, -1.0, 30.0, 1e4):
        yield "rotor of any size", 1.0, 0.5, 1.3, h, *start(0.9, 0.3, -0.6, 2.0), ANY if abs(h) < 100 else SHORT
    for h in (0.5, 3.0, -2.0):
        yield "toy gyroscope", 1.0, 0.4, 2.0, h, *start(1.2, 0.0, 0.0, 0.0), ANY
        yield "toy gyroscope", 1.0, 0.4, 2.0, h, *start(1.5, 0.1, 0.2, 1e-3), ANY
        yield "below the pivot", 1.0, 0.8, -2.0, h, *start(1.2, 0.3, 0.4, 0.7), ANY
    for total in (5.0, 4.2, 3.8, 1.0):   # C w3 + h over sqrt(A M), a sleeping top is stable above 2
        yield "asleep, kicked", 1.0, 0.5, 1.0, total / 2 - 0.25, (1e-4, 0.0, 0.5), (0.0, 0.0, 0.0, 1.0), SHORT
        yield "asleep, tilted", 1.0, 0.5, 1.0, total / 2 - 0.25, *start(1e-3, 0.0, 0.0, 0.5), SHORT
    yield "asleep, kicked, for long", 1.0, 0.5, 1.0, 0.25, (1e-4, 0.0, 0.5), (0.0, 0.0, 0.0, 1.0), (1.0, 1e7)
    yield "no momentum about the axis", 1.0, 0.5, 1.0, -1.5, *start(1.0, 0.4, 0.0, 3.0), ANY
    yield "no momentum about the axis", 1.0, 0.5, 1.0, -1.5, *start(1.0, 0.4, 0.8, 3.0), ANY
    yield "needle and disc", 1.0, 1e-6, 1.0, 0.3, *start(0.9, 0.3, 0.6, 2.0), SHORT
    yield "needle and disc", 1.0, 2.0, 1.0, 0.3, *start(0.9, 0.3, 0.6, 2.0), ANY
    yield "sphere", 1.0, 1.0, 1.0, 0.7, *start(0.9, 0.3, 0.6, 2.0), ANY
    for s in (1e-60, 1e60):
        omega, q = start(0.9, 0.3, -0.6, 5.0)
        yield "scales", s, 0.5 * s, 1.3 * s, 0.8 * s, omega, q, SHORT
    for _ in range(16):
        speed = [10 ** rng.uniform(-2.5, 1.2) * rng.choice((-1, 1)) for _ in range(3)]
        yield "random", 1.0, 0.05 + 1.9 * rng.random(), rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 1), \
            rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 1), \
            *start(math.acos(rng.uniform(-1, 1)), *speed, rng.uniform(-3, 3), rng.uniform(-3, 3)), \
            (rng.uniform(0, 20), -(10 ** rng.uniform(1, 5)))


def turned_back(A, C, M, h, omega, q, times, digits):
    """Rows (omega, attitude) by route 1."""
    with mp.workdps(digits):
        added = mpf(h) / mpf(C)
        rows = []
        plain = legendre(A, C, M, (omega[0], omega[1], mpf(omega[2]) + added), q, times, digits)
        for t, (w1, w2, _, x, y, z, w) in zip(times, plain, strict=True):
            b = added * mpf(t)
            wp, turn = mp.mpc(w1, w2) * mp.expj(b), mp.expj(-b / 2)
            al, be = mp.mpc(w, z) * turn, mp.mpc(x, y) * mp.conj(turn)   # q (0, 0, -sin(b/2), cos(b/2))
            rows.append([wp.real, wp.imag, mpf(omega[2]), be.real, be.imag, al.imag, al.real])
        return rows


def power_series(A, C, M, h, omega, q, time, order=50):
    """The state by route 2."""
    J, h3 = [mpf(A), mpf(A), mpf(C)], mpf(h)
    w, p = [mpf(c) for c in omega], [mpf(c) for c in q]
    size = mp.sqrt(mp.fsum(c * c for c in p))
    p = [c / size for c in p]
    rate = max(map(abs, omega)) + abs(h) / min(A, C) + math.sqrt(abs(M) / min(A, C))
    steps = int(abs(time) * rate * 3 * max(1.0, A / C)) + 1
    step = mpf(time) / steps

    def cauchy(a, b, n):
        return mp.fdot(a[:n + 1], b[n::-1])
    for _ in range(steps):
        W, Q = [[c] for c in w], [[c] for c in p]
        for n in range(order):
            x, y, z, s = Q
            tau = [2 * mpf(M) * (cauchy(y, z, n) + cauchy(s, x, n)),
                   -2 * mpf(M) * (cauchy(x, z, n) - cauchy(s, y, n)), 0]
            spin = [-h3 * W[1][n], h3 * W[0][n], mpf(0)]   # h x w
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                W[a].append(((J[b] - J[c]) * cauchy(W[b], W[c], n) + spin[a] + tau[a]) / (J[a] * (n + 1)))
            append_row(Q, W, n, cauchy)
        w, p = [mp.polyval(c[::-1], step) for c in W], [mp.polyval(c[::-1], step) for c in Q]
    return [*w, *p]


def condition(case, digits=110):
    """Largest move of the answer when one input moves by half an ulp."""
    _, A, C, M, h, omega, q, times = case
    inputs, exact = [A, C, M, h, *omega, *q], turned_back(A, C, M, h, omega, q, times, digits)
    worst = [mpf(0)] * len(times)
    for i in range(len(inputs) + 1):
        v, ts = [mpf(c) for c in inputs], [mpf(t) for t in times]
        if i == len(inputs):
            ts = [t + mpf(math.ulp(float(t))) / 2 for t in ts]
        elif inputs[i] == 0:
            continue
        else:
            v[i] += mpf(math.ulp(inputs[i])) / 2
        rows = turned_back(v[0], v[1], v[2], v[3], v[4:7], v[7:11], ts, digits)
        worst = [max(best, *new) for best, new in zip(worst, moved(rows, exact), strict=True)]
    return worst


def make_row(case):
    """A row of the table, and the distance of the two routes where power series reach."""
    name, A, C, M, h, omega, q, times = case
    exact = turned_back(A, C, M, h, omega, q, times, 220)
    rate = max(map(abs, omega)) + abs(h) / min(A, C)
    some = [i for i, t in enumerate(times) if abs(t) * rate < 120] if name != "scales" else []
    apart = [max(moved([power_series(A, C, M, h, omega, q, times[i])], [exact[i]])[0]) for i in some]
    conds = [] if "--check" in sys.argv else condition(case)
    return {"name": name, "moments": [A, A, C], "weight_arm": M, "rotor": h, "omega": list(omega),
            "attitude": list(q), "t": list(times), "answer": [[float(c) for c in row] for row in exact],
            "cond": [float(f"{float(c):.3g}") for c in conds]}, float(max(apart, default=0))


def main():
    """Make and store, or check."""
    table, worst = [], 0.0
    for case in families(random.Random(14)):
        row, apart = make_row(case)
        print(f"{row['name']:28s} routes differ by {apart:.1e}, cond {max(row['cond'], default=0):.1e}", flush=True)
        table.append(row)
        worst = max(worst, apart)
    print(f"{len(table)} motions, {sum(len(row['t']) for row in table)} states; the routes differ by {worst:.1e}")
    assert worst < 1e-30
    if "--check" not in sys.argv:
        path = pathlib.Path(__file__).with_name("heavy_gyrostat.json")
        path.write_text("[\n" + ",\n".join(json.dumps(row) for row in table) + "\n]\n")


if __name__ == "__main__":
    main()
