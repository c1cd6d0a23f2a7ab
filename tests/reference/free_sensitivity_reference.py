"""Makes free_sensitivity.csv: derivatives of torque-free motions.

The derivatives are central differences of `closed_form` in free_motion_reference.py (Legendre's form with the integral
of the third kind), with digits enough: a second step, a hundred times as long, must give the same 19 digits. Otherwise
the step is shortened. They share no formula with the library. `--check` confirms them at short times by differences of
power series (`taylor`).

The columns of a motion are its derivatives with respect to omega(0) (3), the principal moments at fixed omega(0) (3)
and small turns of the principal axes in the body (3). Each column holds d omega in body axes and the small rotation of
the attitude in space axes. Inputs are float64 numbers taken as exact. The size of a column is the larger of
|d omega| / |omega(0)| and the angle.

Run: python free_sensitivity_reference.py [--check] [--processes 2]
"""

import argparse
import csv
import multiprocessing
import pathlib
import random

from free_motion_reference import characteristic_time, closed_form, families, product, taylor
from mpmath import cos, mp, mpf, sin, sqrt

TABLE = pathlib.Path(__file__).with_name("free_sensitivity.csv")
INPUTS = ["I1", "I2", "I3", "w1", "w2", "w3", "x", "y", "z", "w", "t"]
GROUPS = ("omega", "inertia", "axes")
PARTS = ("o1", "o2", "o3", "a1", "a2", "a3")
COLUMNS = ["family", *INPUTS, *(f"{g}{c}_{part}" for g in GROUPS for c in (1, 2, 3) for part in PARTS)]
TOO_SLOW = [([5.0, 6.0, 2.0], [0.75, 1.0, 1.0])]   # on the separatrix: 900 digits do not do
LEVELS = [(110, "1e-28", "1e-26"), (300, "1e-65", "1e-63"), (900, "1e-150", "1e-148")]  # digits, step, another step


def conjugate(q):
    return [-q[0], -q[1], -q[2], q[3]]


def rotate(q, v):
    return product(product(q, [*v, mpf(0)]), conjugate(q))[:3]


def flow(route, I, omega, q0, t):
    return route(I, omega, q0, t) if route is taylor else closed_form(I, omega, q0, [t])[0]


def turned_flow(route, I, omega, q0, t, axis, angle):
    """The motion of a body whose principal axes were turned by `angle` about a body axis."""
    e = [mpf(0), mpf(0), mpf(0), cos(angle / 2)]
    e[axis] = sin(angle / 2)
    now, q = flow(route, I, rotate(conjugate(e), omega), product(q0, e), t)
    return rotate(e, now), product(q, conjugate(e))


def difference(plus, minus, width):
    """(d omega, small rotation in space axes) from two motions that are `width` apart in an input."""
    turn = product(plus[1], conjugate(minus[1]))
    return [(a - b) / width for a, b in zip(plus[0], minus[0])] + [2 * c / width / turn[3] for c in turn[:3]]


def derivatives(I, omega, q0, t, step, route=closed_form):
    """Nine columns of six numbers."""
    I, omega, q0 = [mpf(v) for v in I], [mpf(v) for v in omega], [mpf(v) for v in q0]
    size = sqrt(sum(c * c for c in q0))
    q0 = [c / size for c in q0]
    h = mpf(step)
    fast, heavy = max(map(abs, omega)), max(I)
    columns = []
    for which, values, unit in ((0, omega, fast), (1, I, heavy)):
        for c in range(3):
            # A moment's step is relative to the moment, a rate's to the largest rate.
            width = h * (values[c] if which else unit)
            ends = []
            for s in (1, -1):
                moved = list(values)
                moved[c] += s * width
                ends.append(flow(route, moved if which else I, omega if which else moved, q0, t))
            columns.append(without_noise(difference(*ends, 2 * width), values[c] if which else unit, fast))
    for axis in range(3):
        ends = [turned_flow(route, I, omega, q0, t, axis, s * h) for s in (1, -1)]
        columns.append(without_noise(difference(*ends, 2 * h), mpf(1), fast))
    return columns


def without_noise(column, unit, speed):
    """Zeros for a column that is zero: that of a moment in a steady rotation, say."""
    return column if size_of(column, speed) * unit > mpf(10) ** -40 else [mpf(0)] * 6


def size_of(column, speed):
    return max(sqrt(sum(c * c for c in column[:3])) / speed, sqrt(sum(c * c for c in column[3:])))


def distances(a, b, speed):
    """Of each column the distance of b from a, relative to the size of a."""
    return [size_of([x - y for x, y in zip(one, other)], speed) / (size_of(one, speed) or 1)
            for one, other in zip(a, b)]


def confirmed_derivatives(I, omega, q0, t):
    for digits, step, other_step in LEVELS:
        mp.dps = digits
        speed = sqrt(sum(mpf(c) ** 2 for c in omega))
        columns = derivatives(I, omega, q0, t, step)
        worst = max(distances(columns, derivatives(I, omega, q0, t, other_step), speed))
        if worst < mpf(10) ** -19:
            return columns
    raise ArithmeticError(f"{I}, {omega}, {t}: two steps differ by {mp.nstr(worst, 3)}")


def cases():
    """(family, I, omega, t): every regime, short and long times."""
    rng = random.Random(20261122)
    counts = {}
    for family, I, omega in families(random.Random(20240901)):
        number = counts[family] = counts.get(family, -1) + 1
        if (family != "exact" and number % 3) or not any(omega):
            continue
        turns = 10.0 ** rng.uniform(-1, 2) if number % 2 else 10.0 ** rng.uniform(-1, 8.5)
        if family == "exact":   # some of these grow exponentially
            turns = rng.uniform(0.02, 3)
        yield family, I, omega, rng.choice((-1, 1)) * turns * characteristic_time(I, omega)
    bodies = [([1.0, 2.0, 2.5], [0.3, 1.0, 2.0]), ([0.2, 0.4, 0.52], [1e-3, 5.0, 1e-3]),
              ([1.0, 1.0, 1.6], [0.4, -1, 2]),
              ([1.0, 1 + 1e-6, 1.6], [0.7, 0.2, 1e-4]), ([1.0, 1.0, 1.0], [0.3, -0.1, 0.7]),
              ([1.0, 1 + 1e-9, 1 + 2e-9], [0.3, 0.9, 0.7]), ([0.52, 0.2, 0.4], [0.0, 0.0, 2.0]),
              ([2.0, 1.0, 2.2], [1e-8, 1.0, 1e-9])]
    for I, omega in bodies:
        for turns in (1e-12, 1e-3, 0.08, 0.3, 0.9):
            yield "short", I, omega, rng.choice((-1, 1)) * turns * rng.uniform(0.7, 1.3) / max(map(abs, omega))


def rows():
    rng = random.Random(7)
    for family, I, omega, t in cases():
        q = [rng.gauss(0, 1) for _ in range(4)]
        size = sum(c * c for c in q) ** 0.5
        if (I, omega) not in TOO_SLOW:
            yield family, list(map(float, I)), list(map(float, omega)), [c / size for c in q], t


def make_row(row):
    family, I, omega, q, t = row
    columns = confirmed_derivatives(I, omega, q, t)
    return [family, *map(repr, [*I, *omega, *q, t]), *(repr(float(c)) for column in columns for c in column)]


def check(row):
    family, I, omega, q, t = row
    t = 0.3 * characteristic_time(I, omega)
    mp.dps, step, _ = LEVELS[-1]
    one = derivatives(I, omega, q, t, step)
    mp.dps = 90
    other = derivatives(I, omega, q, t, "1e-25", taylor)
    return float(max(distances(one, other, max(map(abs, omega))))), family, I, omega


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="confirm some rows by power series, write nothing")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--output", default=TABLE)
    arguments = parser.parse_args()
    with multiprocessing.Pool(arguments.processes) as pool:
        if arguments.check:
            print("largest difference of the two routes:", max(pool.map(check, list(rows())[::16], chunksize=1)))
            return
        found = pool.map(make_row, list(rows()), chunksize=1)
    with open(arguments.output, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows(found)


if __name__ == "__main__":
    main()
