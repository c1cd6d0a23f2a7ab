"""Makes free_motion.csv: torque-free motions with their exact answers and condition numbers.

Two routes that share nothing with the library (theta series) nor with each other:

- `closed_form`: Legendre's way. omega by mpmath's Jacobi functions, the attitude by z-x-z angles about the angular
  momentum, the precession angle by the incomplete integral of the third kind (mpmath's Carlson forms).
- `taylor`: the power series of Euler's equations and of the quaternion's, step by step, at 50 digits.

`closed_form` makes the table; `taylor` confirms it at short times for every row (--check).
Inputs are float64 numbers taken as exact. Run: python free_motion_reference.py [--check]
"""

import argparse
import csv
import pathlib
import random

from attitude_series import append_row
from mpmath import asin, atan, atan2, atanh, cos, ellipfun, ellipk, ellippi, mp, mpf, nint, pi, sin, sqrt, tanh

TABLE = pathlib.Path(__file__).with_name("free_motion.csv")
COLUMNS = ["family", "I1", "I2", "I3", "w1", "w2", "w3", "x0", "y0", "z0", "w0", "t",
           "o1", "o2", "o3", "x", "y", "z", "w", "cond"]
DIGITS = 110   # what the closed form needs where 60 digits cancel


def product(p, q):
    (a, b, c, d), (x, y, z, w) = p, q
    return [d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x,
            d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z]


def unit(q):
    size = sqrt(sum(c * c for c in q))
    return [c / size for c in q]


def sign_of_permutation(order):
    return (-1) ** sum(order[i] > order[j] for i in range(3) for j in range(i + 1, 3))


def third_kind(n, u, m, K, complete):
    """The integral of du / (1 - n sn^2 u) from 0 to u, n <= 0."""
    if m == 1:
        b = sqrt(-n)
        return (u + b * atan(b * tanh(u))) / (1 - n)
    if n == 0:
        return u
    half_periods = nint(u / (2 * K))
    rest = u - 2 * K * half_periods
    amplitude = asin(ellipfun("sn", rest, m=m)) if m else rest
    return 2 * half_periods * complete + ellippi(n, amplitude, m)


def jacobi(u, m, K):
    if m == 1:
        return tanh(u), 1 / mp.cosh(u), 1 / mp.cosh(u)
    if m == 0:
        return sin(u), cos(u), mpf(1)
    u = u - 4 * K * nint(u / (4 * K))
    return tuple(ellipfun(f, u, m=m) for f in ("sn", "cn", "dn"))


def closed_form(I, omega, q0, times):
    """[(omega, attitude)] at each of the times, mpf throughout."""
    I, omega, q0 = [mpf(v) for v in I], [mpf(v) for v in omega], unit([mpf(v) for v in q0])
    moments = [I[a] * omega[a] for a in range(3)]
    LL, T2 = sum(c * c for c in moments), sum(moments[a] * omega[a] for a in range(3))   # exact: 64 digits do
    L = sqrt(LL)
    order = sorted(range(3), key=lambda a: I[a])
    low, middle, high = (I[a] for a in order)
    moving = [a for a in range(3) if omega[a] != 0]
    distance = LL - T2 * middle
    constant = (not moving or low == high or len(moving) == 1
                or (low == middle and omega[order[2]] == 0) or (middle == high and omega[order[0]] == 0))
    if constant:
        size = sqrt(sum(c * c for c in omega))
        axis = [c / size for c in omega] if moving else [mpf(0)] * 3
        return [(omega, product(q0, [c * sin(size * t / 2) for c in axis] + [cos(size * t / 2)]))
                for t in map(mpf, times)]
    if distance < 0 or (distance == 0 and middle == high):
        order = order[::-1]          # the axis encircled comes last
    sigma = sign_of_permutation(order)
    J = [I[a] for a in order]
    m = [sigma * moments[a] for a in order]   # a reflection of all three axes makes an odd permutation proper
    if m[2] < 0:
        turn = [1, -1, -1]                    # half a turn about the first axis
    else:
        turn = [1, 1, 1]
    m = [t * c for t, c in zip(turn, m)]
    inverse = [1 / v for v in J]
    # m_i^2 as in MacCullagh's ellipsoid: with 2T and L^2 given, two components follow from the second
    A = (T2 - LL * inverse[2]) / (inverse[0] - inverse[2])           # amplitude of m1, squared
    B = (T2 - LL * inverse[2]) / (inverse[1] - inverse[2])           # of m2
    C = (LL * inverse[0] - T2) / (inverse[0] - inverse[2])           # of m3
    modulus = (inverse[0] - inverse[1]) / (inverse[1] - inverse[2]) * (T2 - LL * inverse[2]) / (LL * inverse[0] - T2)
    if distance == 0:
        modulus = mpf(1)
    rate = sqrt((inverse[1] - inverse[2]) * (inverse[0] - inverse[2]) * C)
    rate *= 1 if J[2] > J[0] else -1
    K = ellipk(modulus) if modulus != 1 else None
    # u(0) from (sn, cn) of the start: the amplitude, then F by ellippi with n = 0
    sn, cn = m[1] / sqrt(B), m[0] / sqrt(A)
    if modulus == 1:
        u0, mirrored = atanh(sn), m[0] < 0
    else:
        amplitude = atan2(sn, cn)
        turns = nint(amplitude / pi)
        u0, mirrored = mp.ellipf(amplitude - turns * pi, modulus) + 2 * turns * K, False
    n = -C * modulus / A
    complete = ellippi(n, modulus) if modulus not in (0, 1) and n != 0 else None
    rate *= -1 if mirrored else 1             # cn < 0 for ever on that half of the separatrix: u runs backwards
    factor = (T2 - LL * inverse[2]) * L / A / rate

    def pair(u, t):
        s, c, d = jacobi(u, modulus, K)
        c = -c if mirrored else c
        now = [sqrt(A) * c, sqrt(B) * s, sqrt(C) * d]
        phi = L * inverse[2] * t + factor * (third_kind(n, u, modulus, K, complete)
                                             - third_kind(n, u0, modulus, K, complete))
        theta, psi = atan2(sqrt(now[0] ** 2 + now[1] ** 2), now[2]), atan2(now[0], now[1])
        q = [sin(theta / 2) * cos((phi - psi) / 2), sin(theta / 2) * sin((phi - psi) / 2),
             cos(theta / 2) * sin((phi + psi) / 2), cos(theta / 2) * cos((phi + psi) / 2)]
        return now, q

    def given_axes(v):
        out = [mpf(0)] * 3
        for k, a in enumerate(order):
            out[a] = sigma * turn[k] * v[k]
        return out

    _, first = pair(u0, mpf(0))
    first = given_axes(first[:3]) + [first[3]]
    left = product(q0, [-first[0], -first[1], -first[2], first[3]])
    answers = []
    for t in map(mpf, times):
        now, q = pair(u0 + rate * t, t)
        q = given_axes(q[:3]) + [q[3]]
        answers.append((given_axes([now[k] * inverse[k] for k in range(3)]), product(left, q)))
    return answers


def taylor(I, omega, q0, time, order=50):
    """(omega, attitude) at one time by power series, to about 50 digits."""
    w, q = [mpf(v) for v in omega], unit([mpf(v) for v in q0])
    I, left = [mpf(v) for v in I], mpf(time)
    size = max(abs(v) for v in w)
    if size == 0:
        return w, q
    # Steps well inside the radius of convergence, which the largest rate of change of omega bounds.
    lam = max(abs(I[1] - I[2]) / I[0], abs(I[2] - I[0]) / I[1], abs(I[0] - I[1]) / I[2], mpf(1))
    steps = int(abs(left) * size * 8 * min(lam, 30)) + 1
    h = left / steps

    def cauchy(a, b, n):
        return sum(a[j] * b[n - j] for j in range(n + 1))

    for _ in range(steps):
        W, Q = [[c] for c in w], [[c] for c in q]
        for n in range(order):
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                W[a].append((I[b] - I[c]) * cauchy(W[b], W[c], n) / (I[a] * (n + 1)))
            append_row(Q, W, n, cauchy)
        w, q = [mp.polyval(c[::-1], h) for c in W], [mp.polyval(c[::-1], h) for c in Q]
    return w, unit(q)


def distance(a, b):
    """(omega relative to max |omega|, angle in rad) between two answers."""
    scale = max(abs(c) for c in a[0]) or mpf(1)
    between = product([-a[1][0], -a[1][1], -a[1][2], a[1][3]], b[1])
    turn = 2 * asin(min(mpf(1), sqrt(sum(c * c for c in between[:3]))))
    return sqrt(sum((x - y) ** 2 for x, y in zip(a[0], b[0]))) / scale, turn


def nearby(value, steps):
    """The float half an ulp is measured at: value (1 + steps 2^-53), exactly."""
    return mpf(value) * (1 + mpf(steps) / 2**53)


def answer_and_condition(I, omega, q0, t):
    """The exact answer, and how far it moves when one input moves by half an ulp: the largest of omega's move and the
    angle over all inputs."""
    answer, later = closed_form(I, omega, q0, [t, nearby(t, 1)])
    worst = max(distance(answer, later))
    inputs = [*I, *omega]
    for k, value in enumerate(inputs):
        if value == 0:
            continue
        moved = list(map(mpf, inputs))
        moved[k] = nearby(value, 1)
        worst = max(worst, *distance(answer, closed_form(moved[:3], moved[3:], q0, [t])[0]))
    for k, value in enumerate(q0):     # q(t) = q0 r(t): a turn of q0 turns every later attitude as much
        moved = list(map(mpf, q0))
        moved[k] = nearby(value, 1)
        worst = max(worst, distance((omega, unit(list(map(mpf, q0)))), (omega, unit(moved)))[1])
    return answer, worst


def families(random):
    """(family, I, omega): every regime, with its closeness to the boundary spread over decades."""
    log = lambda low, high: 10.0 ** random.uniform(low, high)
    sign = lambda: random.choice((-1.0, 1.0))
    normal = lambda: [random.gauss(0, 1) for _ in range(3)]

    def shuffled(I, w):
        order = random.sample(range(3), 3)
        return [I[a] for a in order], [sign() * w[a] for a in order]

    def box():
        a, b, c = (random.uniform(0.1, 1) ** 2 for _ in range(3))
        return sorted([b + c, a + c, a + b])

    for _ in range(80):
        yield "boxes", *shuffled(box(), normal())
    for i in range(90):           # around the unstable axis: m1 from 1 to 1e-30
        size = 10.0 ** (-15 * i / 89)
        w = random.choice(([size, 5.0, 0.0], [0.0, 5.0, size], [size, 5.0, size * random.uniform(0.1, 3)]))
        yield "separatrix", *shuffled(box(), w)
    for i in range(60):           # across the separatrix far from the unstable axis
        I = random.choice(([1.0, 2.0, 3.0], [0.2, 0.4, 0.52], box()))
        w3 = 1.0
        w1 = (I[2] * (I[2] - I[1]) / (I[0] * (I[1] - I[0]))) ** 0.5 * w3
        yield "across", *shuffled(I, [w1 * (1 + sign() * 10.0 ** (-17 * i / 59)), random.uniform(0.1, 2), w3])
    for i in range(80):           # nearly symmetric, both kinds
        gap = 10.0 ** (-1 - 14 * i / 79)
        I = random.choice(([1.0, 1.0 + gap, 1.6], [1.0, 1.7, 1.7 * (1 + gap)], [0.5, 1.0, 1.0 + gap]))
        yield "near-symmetric", *shuffled(I, normal())
    for i in range(60):           # nearly symmetric and nearly equatorial
        gap, tilt = 10.0 ** (-1 - 14 * i / 59), log(-12, -1)
        if i % 2:
            yield "near-equatorial", *shuffled([1.0, 1.0 + gap, 1.6], [1.0, random.uniform(-1, 1), tilt])
        else:
            yield "near-equatorial", *shuffled([1.0, 1.6, 1.6 * (1 + gap)], [tilt, random.uniform(-1, 1), 1.0])
    for i in range(60):           # nearly spherical
        gap = 10.0 ** (-1 - 14 * i / 59)
        yield "near-sphere", *shuffled([1.0, 1.0 + gap * random.random(), 1.0 + gap], normal())
    for i in range(60):           # needles
        thin = 10.0 ** (-12 * i / 59)
        yield "needle", *shuffled([thin, 1.0, 1.0 + thin * random.uniform(-0.9, 0.9)], normal())
    for i in range(40):           # near a steady rotation about a stable axis
        tilt = 10.0 ** (-15 * i / 39)
        w = random.choice(([1.0, tilt, tilt], [tilt, tilt * random.random(), 1.0]))
        yield "near-steady", *shuffled(box(), w)
    for i in range(60):           # scales
        scale, mass = 10.0 ** (-150 + 300 * i / 59), log(-30, 30)
        yield "scales", *shuffled([mass * v for v in box()], [scale * v for v in normal()])
    for _ in range(30):           # planar bodies, I3 = I1 + I2
        a, b = log(-3, 0), 1.0
        yield "planar", *shuffled([a, b, a + b], normal())
    exact = [
        ([1.0, 1.0, 1.0], [1.0, 2.0, 3.0]), ([2.0, 2.0, 2.0], [0.0, 0.0, -1.0]), ([1.0, 2.0, 3.0], [0.0, 0.0, 0.0]),
        ([1.0, 2.0, 3.0], [1.0, 0.0, 0.0]), ([1.0, 2.0, 3.0], [0.0, -1.0, 0.0]), ([1.0, 2.0, 3.0], [0.0, 0.0, 2.0]),
        ([1.0, 2.0, 3.0], [1.7, 1.0, 0.0]), ([1.0, 2.0, 3.0], [0.0, 1.0, 0.3]), ([1.0, 2.0, 3.0], [1.0, 0.0, 0.3]),
        ([1.0, 1.0, 2.0], [1.0, 0.0, 0.0]), ([1.0, 1.0, 2.0], [1.0, 1.0, 0.0]), ([1.0, 1.0, 2.0], [0.0, 0.0, 1.0]),
        ([1.0, 1.0, 2.0], [1.0, 0.5, 1.0]), ([1.0, 2.0, 2.0], [1.0, 0.0, 0.0]), ([1.0, 2.0, 2.0], [0.0, 0.6, 0.8]),
        ([1.0, 2.0, 2.0], [1.0, 0.6, 0.8]), ([2.0, 1.0, 2.0], [1.0, -3.0, 0.1]), ([0.4, 0.4, 0.2], [0.5, 0.0, 4.0]),
        ([0.2, 0.4, 0.52], [1.0, 2.0, 3.0]), ([0.2, 0.4, 0.52], [1e-4, 5.0, 1e-4]),
        ([10.0, 20.0, 26.0], [1.0, 15.0, 1.0]),
    ]
    # Exactly on the separatrix: I1 (I2 - I1) w1^2 = I3 (I3 - I2) w3^2 in integers, both branches, w2 of either sign or
    # 0.
    for I, ratio in (([2.0, 5.0, 6.0], 1.0), ([3.0, 4.0, 6.0], 2.0), ([3.0, 5.0, 6.0], 1.0), ([4.0, 5.0, 9.0], 3.0)):
        for w2 in (0.0, 0.75, -20.0, 1e-8):
            exact.append((I, [random.choice((-1, 1)) * ratio, w2, random.choice((-1, 1)) * 1.0]))
    for I, w in exact:
        yield "exact", *shuffled(I, w)
    for i in range(30):           # where the library changes from one form of its series to the other: k^2 = 0.97
        k2 = 0.97 + sign() * 10.0 ** (-16 * i / 29) * 0.03
        yield "switch", *shuffled([1.0, 2.0, 3.0], [(3 * k2) ** 0.5, 0.0, -1.0])


def characteristic_time(I, omega):
    """About one period of omega or one turn, whichever is shorter in sight."""
    return 6.0 / max(abs(v) for v in omega) if any(omega) else 1.0


def rows():
    rng = random.Random(20240901)
    for number, (family, I, omega) in enumerate(families(rng)):
        turns = 10.0 ** rng.uniform(-1, 9) if number % 3 else 10.0 ** rng.uniform(-1, 2)
        t = rng.choice((-1, 1)) * turns * characteristic_time(I, omega)
        q = [rng.gauss(0, 1) for _ in range(4)]
        size = sum(c * c for c in q) ** 0.5
        yield family, list(map(float, I)), list(map(float, omega)), [c / size for c in q], t


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="confirm the closed form by power series, write nothing")
    parser.add_argument("--output", default=TABLE)
    arguments = parser.parse_args()
    if arguments.check:
        worst = mpf(0)
        for family, I, omega, q, _ in rows():
            t = 0.3 * characteristic_time(I, omega)
            mp.dps = DIGITS
            answer = closed_form(I, omega, q, [t])[0]
            mp.dps = 60
            apart = max(distance(answer, taylor(I, omega, q, t)))
            worst = max(worst, apart)
            if apart > mpf(10) ** -45:
                print(family, I, omega, t, mp.nstr(apart, 3))
        print("largest difference of the two routes:", mp.nstr(worst, 3))
        return
    mp.dps = DIGITS
    with open(arguments.output, "w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        for family, I, omega, q, t in rows():
            answer, cond = answer_and_condition(I, omega, q, t)
            writer.writerow([family, *map(repr, [*I, *omega, *q, t]),
                             *(repr(float(c)) for c in [*answer[0], *answer[1]]),
                             f"{float(cond):.3e}"])


if __name__ == "__main__":
    main()
