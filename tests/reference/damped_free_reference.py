"""Makes damped_free.csv: bodies with the torque -c I omega, their exact answers and condition numbers.

Two routes that share nothing:

- the table: Legendre's closed form of free_motion_reference.py at the slowed time s = (1 - e^-ct) / c, 110 digits;
- `taylor`: the power series of the damped equations themselves, I w' = I w x w - c I w, which knows no slowed time.

Inputs are float64 numbers taken as exact. Run: python damped_free_reference.py [--check]
"""

import argparse
import csv
import pathlib
import random

from attitude_series import append_row
from free_motion_reference import characteristic_time, closed_form, distance, families, nearby, unit
from mpmath import exp, expm1, mp, mpf

TABLE = pathlib.Path(__file__).with_name("damped_free.csv")
COLUMNS = ["family", "I1", "I2", "I3", "c", "w1", "w2", "w3", "x0", "y0", "z0", "w0", "t",
           "o1", "o2", "o3", "x", "y", "z", "w", "cond"]
DIGITS = 110


def damped(I, c, omega, q, t):
    c, t = mpf(c), mpf(t)
    rates, attitude = closed_form(I, omega, q, [-expm1(-c * t) / c])[0]
    return [exp(-c * t) * rate for rate in rates], attitude


def taylor(I, c, omega, q, time, order=50):
    """(omega, attitude) at one time by power series of the damped equations."""
    w, q = [mpf(v) for v in omega], unit([mpf(v) for v in q])
    I, c, left = [mpf(v) for v in I], mpf(c), mpf(time)
    lam = max(abs(I[1] - I[2]) / I[0], abs(I[2] - I[0]) / I[1], abs(I[0] - I[1]) / I[2], mpf(1))
    rate = max(max(abs(v) for v in w) * max(1, exp(-c * left)) * 8 * min(lam, 30), 8 * abs(c))
    steps = int(abs(left) * rate) + 1
    h = left / steps

    def cauchy(a, b, n):
        return sum(a[j] * b[n - j] for j in range(n + 1))

    for _ in range(steps):
        W, Q = [[v] for v in w], [[v] for v in q]
        for n in range(order):
            for a in range(3):
                b, d = (a + 1) % 3, (a + 2) % 3
                W[a].append(((I[b] - I[d]) * cauchy(W[b], W[d], n) / I[a] - c * W[a][n]) / (n + 1))
            append_row(Q, W, n, cauchy)
        w, q = [mp.polyval(v[::-1], h) for v in W], [mp.polyval(v[::-1], h) for v in Q]
    return w, unit(q)


def answer_and_condition(I, c, omega, q, t):
    """The exact answer, and its largest move when one input moves by half a unit in the last place."""
    answer = damped(I, c, omega, q, t)
    inputs = [*I, c, *omega, t]
    worst = mpf(0)
    for k, value in enumerate(inputs):
        if value == 0:
            continue
        moved = list(map(mpf, inputs))
        moved[k] = nearby(value, 1)
        worst = max(worst, *distance(answer, damped(moved[:3], moved[3], moved[4:7], q, moved[7])))
    return answer, worst


def rows():
    rng = random.Random(20261122)
    for number, (family, I, omega) in enumerate(families(rng)):
        if number % 3 == 2 and family not in ("exact", "switch"):
            continue
        turn = characteristic_time(I, omega)
        q = [rng.gauss(0, 1) for _ in range(4)]
        size = sum(v * v for v in q) ** 0.5
        turned = 10.0 ** rng.uniform(-2, 8)              # revolutions in all time, 1 / (c turn)
        c = 1 / (turned * turn)
        exponent = 10.0 ** rng.uniform(-12, 2)           # c t
        if number % 5 == 0:                              # a drive; times before the start of a brake are one too
            c, exponent = -c, min(exponent, 5.0)
        t = exponent / abs(c)
        if number % 7 == 0:
            t = -min(exponent, 5.0) / abs(c)
        yield family, list(map(float, I)), float(c), list(map(float, omega)), [v / size for v in q], float(t)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="confirm the table's route by power series")
    arguments = parser.parse_args()
    mp.dps = DIGITS
    if arguments.check:
        worst = mpf(0)
        for number, (family, I, _, omega, q, _) in enumerate(rows()):
            if number % 10:
                continue
            turn = characteristic_time(I, omega)
            for c, t in ((0.7 / turn, 0.5 * turn), (-0.3 / turn, 0.4 * turn)):
                mp.dps = DIGITS
                answer = damped(I, c, omega, q, t)
                mp.dps = 60
                apart = max(distance(answer, taylor(I, c, omega, q, t)))
                worst = max(worst, apart)
                if apart > mpf(10) ** -40:
                    print(family, I, c, omega, t, mp.nstr(apart, 3))
        print("largest difference of the two routes:", mp.nstr(worst, 3))
        return
    with open(TABLE, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for family, I, c, omega, q, t in rows():
            answer, cond = answer_and_condition(I, c, omega, q, t)
            writer.writerow([family, *map(repr, [*I, c, *omega, *q, t]),
                             *(repr(float(v)) for v in [*answer[0], *answer[1]]), f"{float(cond):.3e}"])


if __name__ == "__main__":
    main()
