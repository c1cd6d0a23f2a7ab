"""Makes gyrostat.json: free gyrostats with their exact answers and condition numbers.

`Theta` of gyrostat_routes.py makes the table. `Taylor` confirms each row (--check): within a few periods by its own
steps, and at many periods by the power of the turn of one period, which it measures itself.
Inputs are float64 numbers taken as exact. Run: python gyrostat_reference.py [--check]
"""

import argparse
import json
import math
import multiprocessing
import pathlib
import random

from gyrostat_routes import DIGITS, Taylor, Theta, conjugate, distance, dot, product
from mpmath import mp, mpf

TABLE = pathlib.Path(__file__).with_name("gyrostat.json")


def steady_turn(J, h, rate):
    """omega of the steady turn omega = rate M: M = J omega + h gives M_i = h_i / (1 - rate J_i)."""
    return [rate * c / (1 - rate * i) for c, i in zip(h, J)]


def families(rng):
    """(family, J, h, omega): every regime, with its closeness to a boundary spread over decades."""
    log = lambda low, high: 10.0 ** rng.uniform(low, high)
    sign = lambda: rng.choice((-1.0, 1.0))
    normal = lambda size=1.0: [rng.gauss(0, size) for _ in range(3)]
    box = lambda: rng.choice(([1.0, 2.0, 2.5], [rng.uniform(0.5, 1) for _ in range(3)]))
    some = lambda v, keep: [c if k in keep else 0.0 for k, c in enumerate(v)]

    for _ in range(12):
        yield "random", box(), normal(log(-1, 1)), normal()
    for _ in range(4):
        yield "no rotor", box(), [0.0, 0.0, 0.0], normal()
    for i, e in enumerate((-18, -16, -12, -8, -5, -3, 1, 2, 4)):
        keep = ((2,), (0, 1), (0, 1, 2))[i % 3]
        yield "small to large", box(), some(normal(10.0**e), keep), normal()
        yield "small to large", box(), some(normal(10.0**e), (0, 1, 2)), normal()
    for keep in ((0,), (1,), (2,), (0, 1), (0, 2), (1, 2)):
        yield "axis and plane", [1.0, 1.6, 2.2], some(normal(), keep), normal()
        yield "axis and plane", [1.0, 1.6, 2.2], some(normal(0.1), keep), normal()
    for keep in ((2,), (0,), (0, 1), (0, 2), (0, 1, 2)):
        yield "symmetric", [1.0, 1.0, 1.6], some(normal(), keep), normal()
        yield "symmetric", [1.7, 1.7, 0.9], some(normal(), keep), normal()
    for e in (-1, -3, -6, -9, -12, -14, -15):
        gap = 1 + 10.0**e
        yield "near symmetric", [1.0, gap, 1.6], some(normal(), rng.choice(((2,), (0, 1, 2)))), normal()
        yield "near sphere", [1.0, gap, 1 + 10.0**e * rng.random()], normal(), normal()
    for keep in ((0,), (0, 1, 2)):
        yield "sphere", [1.3, 1.3, 1.3], some(normal(), keep), normal()
    for e in (-1, -3, -6, -9, -12):
        thin = 10.0**e
        yield "needle", [thin, 1.0, 1 + 0.5 * thin], some(normal(10.0 ** rng.uniform(-3, 0)), (1, 2)), normal()
        yield "needle", [thin, 1.0, 1 + 0.5 * thin], [thin * sign(), *normal()[:2]], normal()
    for e in range(2, 14):
        for low, high in ((-3.0, -0.1), (0.55, 0.95), (1.05, 1.9), (2.1, 6.0)):   # below, among and above 1 / J
            J, h = [0.5, 0.8, 1.0], normal()
            omega = steady_turn(J, h, rng.uniform(low, high))
            yield "near steady", J, h, [c + 10.0**-e * rng.gauss(0, 1) * max(map(abs, omega)) for c in omega]
    for e in (0, 1, 2, 4, 6, 8, 11):
        yield "racket", [0.2, 0.4, 0.52], [0.0, 10.0 ** rng.uniform(-3, -1), 0.0], [10.0**-e, 5.0, 10.0**-e * sign()]
        yield "racket", [0.2, 0.4, 0.52], [0.0, -0.05, 0.0], [10.0**-e * rng.random(), -5.0, 0.0]
    for e in (-2, -6, -12):
        yield "kicked", box(), normal(), normal(10.0**e)
        yield "kicked", [1.0, 2.0, 2.5], [0.0, 1.0, 0.0], normal(10.0**e)
    for e in (0, -1, -4, -8, -13):
        J, omega = [1.0, 2.0, 2.5], [rng.choice((0.25, -1.5, 0.75)) for _ in range(3)]
        h, kick = [-i * w for i, w in zip(J, omega)], 10.0**e if e else 0.0
        yield "no momentum", J, h, [w * (1 + kick * sign()) for w in omega]
    yield "rest", [1.0, 2.0, 2.5], [0.3, -0.2, 1.0], [0.0, 0.0, 0.0]
    yield "steady", [1.0, 2.0, 2.5], [0.0, 0.7, 0.0], [0.0, -1.5, 0.0]
    yield "steady", [2.0, 3.0, 4.0], [3.0, -4.0, 5.0], [-1.0, 1.0, -1.0]
    # With M = (3, 6, 6) and the saddle M = (0, 9, 0) the energies are equal.
    yield "separatrix", [3.0, 4.0, 6.0], [0.0, 1.5, 0.0], [1.0, 1.125, 1.0]
    yield "separatrix", [3.0, 4.0, 6.0], [0.0, 1.5, 0.0], [-1.0, 1.125, 1.0]
    for _ in range(6):
        scale, mass = 10.0 ** rng.uniform(-100, 100), log(-20, 20)
        yield "scales", [mass * c for c in box()], [mass * scale * c for c in normal()], [scale * c for c in normal()]


def nearby(value):
    return mpf(value) * (1 + mpf(1) / 2**53)


def scale_of(answers, omega):
    return max([max(map(abs, a[0])) for a in answers] + [max(abs(mpf(c)) for c in omega)]) or mpf(1)


def answers_and_conditions(J, h, omega, q, times):
    """The exact answers, and how far each moves (omega, angle) when one input moves by half an ulp: the largest."""
    mp.dps = DIGITS
    answers = [Theta(J, h, omega, q).at(t) for t in times]
    scale = scale_of(answers, omega)
    worst = [[mpf(0), mpf(0)] for _ in times]
    inputs = [*J, *h, *omega]
    for k in range(len(inputs) + 1):
        if k < len(inputs) and inputs[k] == 0:
            continue
        moved, later = [mpf(c) for c in inputs], [mpf(t) for t in times]
        if k < len(inputs):
            moved[k] = nearby(moved[k])
        else:
            later = [nearby(t) for t in times]
        other = Theta(moved[:3], moved[3:6], moved[6:], q)
        for i, t in enumerate(later):
            worst[i] = [max(a, b) for a, b in zip(worst[i], distance(answers[i], other.at(t), scale))]
    return answers, worst


def cases():
    rng = random.Random(1885)
    for family, J, h, omega in families(rng):
        q = [rng.gauss(0, 1) for _ in range(4)]
        size = math.sqrt(sum(c * c for c in q))
        yield family, J, h, omega, [c / size for c in q], [rng.random() for _ in range(5)], rng.choice((-1, 1))


def times_of(case):
    family, J, h, omega, q, draws, sign = case
    mp.dps = DIGITS
    period = Theta(J, h, omega, q).period
    if not 0 < period < mp.inf or family == "separatrix":
        period = 6 / max([abs(c) for c in omega] + [abs(c / i) for c, i in zip(h, J)] + [1e-300])
    period = float(period)
    periods = 2 * draws[0], -3 * draws[1], 10 ** (1 + 3 * draws[2]), -(10 ** (4 + 2 * draws[3]))
    return [0.0] + [sign * p * period for p in periods]


def make_row(case):
    family, J, h, omega, q, _, _ = case
    times = times_of(case)
    answers, cond = answers_and_conditions(J, h, omega, q, times)
    keep = [i for i in range(len(times)) if max(cond[i]) < 1e-3]
    return {"name": family, "moments": J, "momentum": h, "omega": omega, "attitude": q, "t": [times[i] for i in keep],
            "scale": float(scale_of(answers, omega)),
            "answer": [[float(c) for part in answers[i] for c in part] for i in keep],
            "cond": [[float(mp.nstr(c, 4)) for c in cond[i]] for i in keep]}


def check_row(case):
    """The largest difference of the two routes; None where power series would take too long."""
    family, J, h, omega, q, _, _ = case
    mp.dps = DIGITS
    theta, times = Theta(J, h, omega, q), times_of(case)
    mp.dps = 60
    taylor, period = Taylor(J, h, omega, q), theta.period
    most = 150
    if not 0 < period < mp.inf or float(period) * taylor.speed > most:
        some = [t for t in times if abs(t) * taylor.speed < most] or [most / taylor.speed / 3]
        pairs = [(theta.at(t), taylor.advance(taylor.start, t)) for t in some]
        return family, float(max(max(distance(a, b, scale_of([a], omega))) for a, b in pairs))
    returned = taylor.advance(taylor.start, period)
    gap = mp.sqrt(dot(*[[a - b for a, b in zip(returned[0], taylor.start[0])]] * 2))
    once = product(returned[1], conjugate(taylor.start[1]))        # the turn of one period, in space
    size = mp.sqrt(dot(once[:3], once[:3]))
    angle, axis = mp.atan2(size, once[3]), [c / size for c in once[:3]]
    worst = gap / scale_of([], omega)
    for t in times:
        n = int(mp.nint(t / period))
        state = taylor.advance(taylor.start, t - n * period)
        many = product([c * mp.sin(n * angle) for c in axis] + [mp.cos(n * angle)], state[1])
        worst = max(worst, *distance(theta.at(t), (state[0], many), scale_of([state], omega)))
    return family, float(worst)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="confirm the table's route by power series, write nothing")
    arguments = parser.parse_args()
    with multiprocessing.Pool(2) as pool:
        if arguments.check:
            for family, apart in pool.imap(check_row, cases()):
                print(f"{family:20s} the routes differ by {apart:.1e}", flush=True)
            return
        rows = list(pool.imap(make_row, cases()))
    TABLE.write_text("[\n" + ",\n".join(json.dumps(row) for row in rows) + "\n]\n")
    print(len(rows), "motions,", sum(len(r["t"]) for r in rows), "states")


if __name__ == "__main__":
    main()
