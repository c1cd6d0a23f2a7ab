"""Makes pendulum.csv: plane pendulums of triaxial bodies, their exact answers and condition numbers.

Two routes that share nothing:

- the table: theta by mpmath's Jacobi functions at 110 digits;
- `taylor`: the power series of the full equations of a heavy body, I w' = I w x w + r x (-m g R^T e_z) and the
  quaternion's, which know no angle (--check).

Inputs are float64 numbers taken as exact. Run: python pendulum_reference.py [--check]
"""

import argparse
import csv
import math
import pathlib
import random

from free_motion_reference import distance, nearby, product, unit
from mpmath import asin, atan2, cos, cosh, ellipf, ellipfun, ellipk, mp, mpf, nint, sin, sqrt, tanh

TABLE = pathlib.Path(__file__).with_name("pendulum.csv")
COLUMNS = ["family", "axis", "I1", "I2", "I3", "weight", "r1", "r2", "r3", "omega", "x0", "y0", "z0", "w0", "t",
           "rate", "x", "y", "z", "w", "largest", "cond"]


def vertical(q):
    x, y, z, w = unit(list(map(mpf, q)))
    return [2 * (x * z - w * y), 2 * (y * z + w * x), z * z + w * w - x * x - y * y]


def pendulum(axis, I, weight, arm, omega, q, t, turned=0):
    """(theta', attitude, largest |theta'|); `turned` changes tan(theta0 / 2) by this part of itself."""
    f, g = (axis + 1) % 3, (axis + 2) % 3
    I, weight, omega, t = mpf(I), mpf(weight), mpf(omega), mpf(t)
    arm, up = list(map(mpf, arm)), vertical(q)
    torque = weight * sqrt(arm[f] ** 2 + arm[g] ** 2)
    sign = -1 if omega < 0 else 1
    # from hanging, about +axis: cos ~ -r . up, sin ~ r . (up x e)
    theta = atan2(weight * (arm[f] * up[g] - arm[g] * up[f]), -weight * (arm[f] * up[f] + arm[g] * up[g])) * sign
    s0, c0 = sin(theta / 2), cos(theta / 2)
    if abs(abs(theta) - mp.pi) < mpf(10) ** -100:
        s0, c0 = mpf(1), mpf(0)
    s0 *= 1 + turned
    s0, c0 = s0 / sqrt(s0 * s0 + c0 * c0), c0 / sqrt(s0 * s0 + c0 * c0)
    frequency = sqrt(abs(torque) / I)
    p = abs(omega) / (2 * frequency)
    k2, rest = s0 * s0 + p * p, (c0 - p) * (c0 + p)
    if k2 == 0 or (p == 0 and c0 == 0):
        return mpf(0), unit(list(map(mpf, q))), mpf(0)
    k = sqrt(k2)
    if abs(rest) < mpf(10) ** -100:
        u = frequency * t + mp.atanh(s0)
        s, c, rate, largest = tanh(u), 1 / cosh(u), 2 * frequency / cosh(u), 2 * frequency
    else:
        swings = rest > 0
        m, speed = (k2, frequency) if swings else (1 / k2, k * frequency)
        u = speed * t + ellipf(asin(s0 / k if swings else s0), m)
        K = ellipk(m)
        u -= 4 * K * nint(u / (4 * K))
        sn, cn, dn = (ellipfun(name, u, m=m) for name in ("sn", "cn", "dn"))
        s, c = (k * sn, dn) if swings else (sn, cn)
        rate, largest = 2 * frequency * k * (cn if swings else dn), 2 * frequency * k
    half = [mpf(0)] * 3
    half[axis] = sign * (s * c0 - c * s0)
    return sign * rate, product(unit(list(map(mpf, q))), [*half, c * c0 + s * s0]), largest


def taylor(I, weight, arm, omega, q, time, order=40):
    """(omega, attitude) at one time by power series of a heavy body's full equations."""
    w, q = list(map(mpf, omega)), unit(list(map(mpf, q)))
    I, arm, left = list(map(mpf, I)), [mpf(weight) * mpf(v) for v in arm], mpf(time)
    speed = max(abs(v) for v in w) + sqrt(sqrt(sum(v * v for v in arm)) / min(I))
    steps = int(abs(left) * speed * 40) + 1
    h = left / steps

    def cauchy(a, b, n):
        return sum(a[j] * b[n - j] for j in range(n + 1))

    for _ in range(steps):
        W, Q, up = [[v] for v in w], [[v] for v in q], [[v] for v in vertical(q)]
        for n in range(order):
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                pull = arm[c] * up[b][n] - arm[b] * up[c][n]
                W[a].append(((I[b] - I[c]) * cauchy(W[b], W[c], n) + pull) / (I[a] * (n + 1)))
            for a in range(3):                          # up' = up x omega
                b, c = (a + 1) % 3, (a + 2) % 3
                up[a].append((cauchy(up[b], W[c], n) - cauchy(up[c], W[b], n)) / (n + 1))
            x, y, z, s = Q
            new = [cauchy(s, W[0], n) + cauchy(y, W[2], n) - cauchy(z, W[1], n),
                   cauchy(s, W[1], n) + cauchy(z, W[0], n) - cauchy(x, W[2], n),
                   cauchy(s, W[2], n) + cauchy(x, W[1], n) - cauchy(y, W[0], n),
                   -cauchy(x, W[0], n) - cauchy(y, W[1], n) - cauchy(z, W[2], n)]
            for i in range(4):
                Q[i].append(new[i] / (2 * (n + 1)))
        w, q = [mp.polyval(v[::-1], h) for v in W], unit([mp.polyval(v[::-1], h) for v in Q])
    return w, q


def start_attitude(axis, half_angle, yaw):
    """A quaternion whose body axis is horizontal to the last bit: equal float64 products in pairs."""
    s, c, h = math.sin(half_angle), math.cos(half_angle), math.sqrt(0.5)
    if axis == 2:
        return [h * c, -h * s, h * s, h * c]
    flat = {0: [s, 0.0, 0.0, c], 1: [0.0, s, 0.0, c]}[axis]
    if not yaw:
        return flat
    return {0: [h * s, h * s, h * c, h * c], 1: [-h * s, h * s, h * c, h * c]}[axis]


def families(rng):
    """(family, axis, I, weight, arm, omega, attitude)."""
    def body():
        a, b, c = (rng.uniform(0.1, 1) ** 2 for _ in range(3))
        moments = [b + c, a + c, a + b]
        rng.shuffle(moments)
        return moments

    def arm_for(axis, kind, size=1.0):
        arm, f, g = [0.0] * 3, (axis + 1) % 3, (axis + 2) % 3
        if kind == 0:
            arm[rng.choice((f, g))] = rng.choice((-1, 1)) * size * rng.uniform(0.1, 2)
        else:
            arm[f], arm[g] = size * rng.gauss(0, 1), size * rng.gauss(0, 1)
        return arm

    def frequency(axis, I, weight, arm):
        return math.sqrt(abs(weight) * math.hypot(*arm) / I[axis])

    def tilt(axis, weight, arm, theta):
        """The half angle about the axis at which theta0 is about this."""
        q = start_attitude(axis, 0.0, False)
        f, g = (axis + 1) % 3, (axis + 2) % 3
        up = [float(v) for v in vertical(q)]
        now = math.atan2(weight * (arm[f] * up[g] - arm[g] * up[f]), -weight * (arm[f] * up[f] + arm[g] * up[g]))
        return (theta - now) / 2

    def one(family, axis, theta, p, I=None, weight=None, arm=None, yaw=None):
        I, weight = I or body(), weight or rng.choice((1.0, 9.81, -3.0)) * rng.uniform(0.5, 2)
        arm = arm or arm_for(axis, rng.randrange(2))
        omega = 2 * p * frequency(axis, I, weight, arm)
        yaw = rng.random() < 0.5 if yaw is None else yaw
        return family, axis, I, weight, arm, omega, start_attitude(axis, tilt(axis, weight, arm, theta), yaw)

    for i in range(60):
        yield one("all energies", i % 3, rng.uniform(-3.1, 3.1), rng.choice((-1, 1)) * 10.0 ** rng.uniform(-2, 1))
    for i in range(36):
        yield one("released", i % 3, rng.uniform(-3.1, 3.1), 0.0)
    for i in range(36):
        size = 10.0 ** (-14 * i / 35)
        yield one("small swings", i % 3, size * rng.uniform(-1, 1), size * rng.uniform(-1, 1))
    for i in range(72):
        near, theta = 10.0 ** (-16 * i / 71), rng.uniform(-2.5, 2.5)
        yield one("near separatrix", i % 3, theta, rng.choice((-1, 1)) * math.cos(theta / 2) * (
            1 + (-1) ** i * near))
    for i in range(36):
        near = 10.0 ** (-14 * i / 35)
        yield one("near upright", i % 3, math.pi - near, rng.choice((0.0, near, 1e-3 * near, 0.4 * near, -0.6 * near)))
    for i in range(36):
        yield one("fast", i % 3, rng.uniform(-3.1, 3.1), rng.choice((-1, 1)) * 10.0 ** rng.uniform(0, 8))
    for i in range(24):
        k2 = 0.97 + (-1) ** i * 0.03 * 10.0 ** (-16 * i / 23)
        yield one("switch", i % 3, 0.0, math.sqrt(k2) if i % 4 < 2 else math.sqrt(1 / k2))
    # Exactly on the separatrix from hanging and from 90 degrees, and exactly at rest, hanging and upright.
    for axis, arm in ((0, [0.0, 0.0, -1.0]), (1, [0.0, 0.0, -0.25]), (0, [0.0, 0.0, -4.0])):
        for sign in (1.0, -1.0):
            omega = sign * 2 * math.sqrt(abs(arm[2]))
            yield "separatrix", axis, [1.0, 1.0, 1.5], 1.0, arm, omega, [0.0, 0.0, 0.0, 1.0]
    h = math.sqrt(0.5)
    yield "separatrix", 0, [1.0, 1.2, 1.5], 2.0, [0.0, 0.0, -1.0], 2.0, [h, 0.0, 0.0, h]
    yield "separatrix", 0, [1.0, 1.2, 1.5], 2.0, [0.0, 0.0, -1.0], -2.0, [h, 0.0, 0.0, h]
    yield "separatrix", 2, [1.0, 1.2, 1.0], 2.0, [1.0, 0.0, 0.0], 2.0, [0.0, h, h, 0.0]
    for z in (1.0, -1.0):
        yield "rest", 0, [0.2, 0.4, 0.5], 3.0, [0.0, 0.0, z], 0.0, [0.0, 0.0, 0.0, 1.0]
    yield "upright", 1, [0.2, 0.4, 0.5], 3.0, [0.0, 0.0, 1.0], 1e-3, [0.0, 0.0, 0.0, 1.0]
    for i in range(24):
        scale, mass, size = (10.0 ** rng.uniform(-40, 40) for _ in range(3))
        I = [mass * v for v in body()]
        yield one("scales", i % 3, rng.uniform(-3, 3), rng.uniform(-2, 2), I, scale, arm_for(i % 3, i % 2, size))


def rows():
    rng = random.Random(20261122)
    for number, (family, axis, I, weight, arm, omega, q) in enumerate(families(rng)):
        frequency = math.sqrt(abs(weight) * math.hypot(*arm) / I[axis])
        swings = 10.0 ** (rng.uniform(-1, 6) if number % 3 else rng.uniform(-1, 1))
        t = rng.choice((-1, 1)) * swings * 6 / max(frequency, abs(omega))
        if family in ("separatrix", "near upright", "near separatrix"):
            t = rng.choice((-1, 1)) * 10.0 ** rng.uniform(-1, 1.5) / frequency
        yield family, axis, I, weight, arm, omega, q, t


def answer_and_condition(axis, I, weight, arm, omega, q, t):
    answer = pendulum(axis, I[axis], weight, arm, omega, q, t)
    scale = answer[2] or mpf(1)

    def apart(other):
        return max(abs(other[0] - answer[0]) / scale, distance(([mpf(1)], answer[1]), ([mpf(1)], other[1]))[1])

    near = lambda v: nearby(v, 1)
    moment = I[axis]
    moved = [pendulum(axis, near(moment), weight, arm, omega, q, t),
             pendulum(axis, moment, near(weight), arm, omega, q, t),
             pendulum(axis, moment, weight, arm, near(omega), q, t),
             pendulum(axis, moment, weight, arm, omega, q, near(t)),
             pendulum(axis, moment, weight, arm, omega, q, t, mpf(2) ** -53)]
    return answer, max(map(apart, moved))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="confirm the table's route by power series")
    arguments = parser.parse_args()
    mp.dps = 110
    if arguments.check:
        worst = mpf(0)
        for number, (family, axis, I, weight, arm, omega, q, t) in enumerate(rows()):
            if number % 9:
                continue
            speed = math.sqrt(abs(weight) * math.hypot(*arm) / I[axis]) + abs(omega)
            t = math.copysign(min(abs(t), 1 / speed), t)
            mp.dps = 110
            rate, attitude, largest = pendulum(axis, I[axis], weight, arm, omega, q, t)
            expected = [mpf(0)] * 3
            expected[axis] = rate
            mp.dps = 60
            full = [0.0] * 3
            full[axis] = omega
            rates, turned = taylor(I, weight, arm, full, q, t)
            apart = max(max(abs(a - b) for a, b in zip(rates, expected)) / (largest or 1),
                        distance(([mpf(1)], attitude), ([mpf(1)], turned))[1])
            # The axis is horizontal to the last bit, so the full equations never leave the plane.
            worst = max(worst, apart)
            if apart > mpf(10) ** -30:
                print(family, axis, I, weight, arm, omega, q, t, mp.nstr(apart, 3))
        print("largest difference of the two routes:", mp.nstr(worst, 3))
        return
    with open(TABLE, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for family, axis, I, weight, arm, omega, q, t in rows():
            (rate, attitude, largest), cond = answer_and_condition(axis, I, weight, arm, omega, q, t)
            inputs = map(float, [*I, weight, *arm, omega, *q, t])
            writer.writerow([family, axis, *map(repr, inputs),
                             *(repr(float(v)) for v in [rate, *attitude, largest]), f"{float(cond):.3e}"])


if __name__ == "__main__":
    main()
