"""The exact motion of plain numbers in fixed point: 190 bits and more, with Python's integers.

Rates and quaternion are expanded in Taylor series about a time. The torques see the attitude through the rotation
matrix of the quaternion. Proofs have neither that matrix nor fixed point: the two share the equations of the rates and
of the quaternion.
"""

import math
from fractions import Fraction
from operator import mul

import numpy as np
from mpmath import mp, mpf

ORDER = 44
DIGITS = 125   # bits to which a step is exact
CYCLE = ((0, 1, 2), (1, 2, 0), (2, 0, 1))


def invert(m):
    """The inverse of a (3, 3) matrix of fractions."""
    def minor(i, j):
        a, b, c, d = (j + 1) % 3, (j + 2) % 3, (i + 1) % 3, (i + 2) % 3
        return m[a][c] * m[b][d] - m[a][d] * m[b][c]

    size = sum(m[0][j] * minor(j, 0) for j in range(3))
    return [[minor(i, j) / size for j in range(3)] for i in range(3)]


def root(x, bits):
    """The square root of a fraction, to a part in 2^bits."""
    shift = 2 * bits + 2 * max(0, x.denominator.bit_length() - x.numerator.bit_length())
    return Fraction(math.isqrt((x.numerator << shift) // x.denominator), 1 << (shift // 2))


def unit(v, bits):
    v = [Fraction(c) for c in v]
    length = root(sum(c * c for c in v), bits)
    return [c / length for c in v]


class Body:
    """A body in units of its own: 2^-pace seconds, 2^weight kg m^2."""

    def __init__(self, numbers):
        self.numbers, spans = numbers, [abs(Fraction(t) - Fraction(numbers["t0"])) for t in numbers["times"]]
        self.pace, self.time = numbers["pace"], Fraction(2) ** numbers["pace"]
        least = min((s * self.time for s in spans if s), default=Fraction(1))
        self.bits = 190 + max(0, least.denominator.bit_length() - least.numerator.bit_length())
        matrix = [[Fraction(c) for c in row] for row in numbers["inertia"]]
        self.spin = []   # of each rotor
        for rotor in numbers["rotors"]:
            axis = unit(rotor["axis"], self.bits)
            if "momentum" in rotor:
                size = Fraction(rotor["momentum"])
            else:
                speed = Fraction(rotor["speed"])
                if rotor.get("free"):
                    speed += sum(a * Fraction(w) for a, w in zip(axis, numbers["omega"], strict=True))
                    matrix = [[matrix[i][j] - Fraction(rotor["inertia"]) * axis[i] * axis[j] for j in range(3)]
                              for i in range(3)]
                size = Fraction(rotor["inertia"]) * speed
            self.spin.append([size * a for a in axis])
        weight = Fraction(2) ** math.frexp(max(abs(c) for row in numbers["inertia"] for c in row))[1]
        self.of_torque, self.of_momentum = 1 / (self.time ** 2 * weight), 1 / (self.time * weight)
        scaled = [[c / weight for c in row] for row in matrix]
        self.I = [[self.fix(c) for c in row] for row in scaled]
        self.inverse = [[self.fix(c) for c in row] for row in invert(scaled)]

    def fix(self, x):
        x = Fraction(x)
        return (x.numerator << self.bits) // x.denominator

    def start(self):
        return [self.fix(Fraction(w) / self.time) for w in self.numbers["omega"]] + \
               [self.fix(q) for q in unit(self.numbers["attitude"], self.bits)]

    def find_momentum(self, acts):
        h = [Fraction(0)] * 3
        for spin, rotor in zip(self.spin, self.numbers["rotors"], strict=True):
            if acts(rotor):
                h = [a + b for a, b in zip(h, spin, strict=True)]
        return [self.fix(c * self.of_momentum) for c in h]


class Expansion:
    """The series about a time [s], under some torques and a momentum of rotors."""

    def __init__(self, body, state, h, torques, time):
        self.body, self.bits, self.h, self.torques = body, body.bits, h, torques
        self.w, self.q = [[c] for c in state[:3]], [[c] for c in state[3:]]
        self.R, self.L = [[[] for _ in range(3)] for _ in range(3)], [[], [], []]
        self.seen = {i: self.make_orbit(t, time) for i, t in enumerate(torques) if t["kind"] == "gradient"}
        for n in range(ORDER):
            self.extend(n)

    def make_orbit(self, torque, time):
        """Series of the orbit angle's cosine and sine, and room for the radial vector and I times it."""
        rate = Fraction(torque["mean_motion"])
        with mp.workprec(self.bits + 64):
            angle = rate * time + Fraction(torque["phase"])
            angle = mpf(angle.numerator) / angle.denominator
            c, s = ([int(mp.floor(mp.ldexp(f(angle), self.bits)))] for f in (mp.cos, mp.sin))
        step = self.body.fix(rate / self.body.time)
        for n in range(ORDER):
            c.append((-step * s[n] >> self.bits) // (n + 1))
            s.append((step * c[n] >> self.bits) // (n + 1))
        return c, s, [[], [], []], [[], [], []]

    def multiply(self, a, b, n):
        return sum(map(mul, a[:n + 1], b[n::-1])) >> self.bits

    def cross(self, a, b, n):
        return [self.multiply(a[j], b[k], n) - self.multiply(a[k], b[j], n) for _, j, k in CYCLE]

    def apply(self, matrix, v):
        return [sum(map(mul, row, v)) >> self.bits for row in matrix]

    def extend(self, n):
        x, y, z, s = self.q
        one = 1 << self.bits if n == 0 else 0
        p = {(i, j): self.multiply(self.q[i], self.q[j], n) for i in range(4) for j in range(i, 4)}
        rows = [[one - 2 * (p[1, 1] + p[2, 2]), 2 * (p[0, 1] - p[2, 3]), 2 * (p[0, 2] + p[1, 3])],
                [2 * (p[0, 1] + p[2, 3]), one - 2 * (p[0, 0] + p[2, 2]), 2 * (p[1, 2] - p[0, 3])],
                [2 * (p[0, 2] - p[1, 3]), 2 * (p[1, 2] + p[0, 3]), one - 2 * (p[0, 0] + p[1, 1])]]
        for i in range(3):
            for j in range(3):
                self.R[i][j].append(rows[i][j])
        momentum = self.apply(self.body.I, [w[n] for w in self.w])
        for i in range(3):
            self.L[i].append(momentum[i] + (self.h[i] if n == 0 else 0))
        tau, drag = self.cross(self.L, self.w, n), [0, 0, 0]
        for i, torque in enumerate(self.torques):
            if torque["kind"] == "angular_damping":
                rate = self.body.fix(Fraction(torque["rate"]) / self.body.time)
                drag = [d + (rate * w[n] >> self.bits) for d, w in zip(drag, self.w, strict=True)]
            else:
                tau = [a + b for a, b in zip(tau, self.find_torque(i, torque, n), strict=True)]
        turn = [self.multiply(s, self.w[i], n) + self.multiply(self.q[j], self.w[k], n) -
                self.multiply(self.q[k], self.w[j], n) for i, j, k in CYCLE]
        turn.append(-sum(self.multiply(self.q[i], self.w[i], n) for i in range(3)))
        for w, change, lost in zip(self.w, self.apply(self.body.inverse, tau), drag, strict=True):
            w.append((change - lost) // (n + 1))
        for q, change in zip(self.q, turn, strict=True):
            q.append(change // (2 * (n + 1)))

    def find_torque(self, index, torque, n):
        """Coefficient n of a torque in body axes."""
        fix, unit_, R = self.body.fix, self.body.of_torque, self.R
        if torque["kind"] == "body":
            return [fix(c * unit_) if n == 0 else 0 for c in map(Fraction, torque["torque"])]
        if torque["kind"] == "space":
            tau = [fix(Fraction(c) * unit_) for c in torque["torque"]]
            return [sum(tau[i] * R[i][j][n] for i in range(3)) >> self.bits for j in range(3)]
        if torque["kind"] == "gravity":   # W e_z x r
            arm = [fix(Fraction(torque["weight"]) * Fraction(c) * unit_) for c in torque["arm"]]
            return [R[2][j][n] * arm[k] - R[2][k][n] * arm[j] >> self.bits for _, j, k in CYCLE]
        if torque["kind"] == "damping":
            matrix = [[fix(-Fraction(c) * self.body.of_momentum) for c in row] for row in torque["matrix"]]
            return self.apply(matrix, [w[n] for w in self.w])
        c, s, u, Iu = self.seen[index]   # 3 n^2 u x I u
        for j in range(3):
            u[j].append(self.multiply(R[0][j], c, n) + self.multiply(R[1][j], s, n))
        for series, value in zip(Iu, self.apply(self.body.I, [series[n] for series in u]), strict=True):
            series.append(value)
        strength = fix(3 * (Fraction(torque["mean_motion"]) / self.body.time) ** 2)
        return [strength * v >> self.bits for v in self.cross(u, Iu, n)]

    def find_length(self):
        """A step over which the last two terms are below 2^-DIGITS, of few digits; None where they are 0."""
        sizes = [(max(abs(c[n]) for c in (*self.w, *self.q)).bit_length() - self.bits, n)
                 for n in (ORDER - 1, ORDER) if any(c[n] for c in (*self.w, *self.q))]
        power = min(((-DIGITS - size) / n for size, n in sizes), default=None)
        if power is None:
            return None
        whole = math.floor(power)
        return Fraction(int(256 * 2 ** (power - whole)), 256) * Fraction(2) ** whole

    def at(self, span):
        """The state after a span in the body's units."""
        found = []
        for series in (*self.w, *self.q):
            total = 0
            for c in reversed(series):
                total = (total * span >> self.bits) + c
            found.append(total)
        return found


def compute_exact(numbers):
    """Rows of integers, rates and quaternion, and the body: a rate is the integer times 2^(pace - bits)."""
    body, found = Body(numbers), {}
    t0 = Fraction(numbers["t0"])
    windowed = [*numbers["torques"], *numbers["rotors"]]
    edges = sorted({Fraction(e) for one in windowed for window in one.get("windows", ()) for e in window})

    def acts_at(t):
        return lambda one: "windows" not in one or any(a <= t < b for a, b in one["windows"])

    def jump(state, before, after):
        change = [sum(map(mul, row, [b - a for a, b in zip(before, after, strict=True)])) >> body.bits
                  for row in body.inverse]
        return [w - c for w, c in zip(state[:3], change, strict=True)] + state[3:]

    for sign in (1, -1):
        times = sorted({Fraction(t) for t in numbers["times"] if (Fraction(t) >= t0) == (sign > 0)},
                       key=lambda t: sign * t)
        if not times:
            continue
        state, now, h = body.start(), t0, body.find_momentum(acts_at(t0))
        stops = [e for e in edges[::sign] if sign * t0 < sign * e < sign * times[-1]] + [times[-1]]
        for stop in stops:
            acts = acts_at((now + stop) / 2) if stop != now else acts_at(now)
            after = body.find_momentum(acts)
            state, h = jump(state, h, after), after
            torques = [torque for torque in numbers["torques"] if acts(torque)]
            while True:
                series = Expansion(body, state, h, torques, now)
                length = series.find_length()
                step = stop - now if length is None else sign * length / body.time
                step = min(step, stop - now, key=abs)
                while times and sign * times[0] <= sign * (now + step):
                    t = times.pop(0)
                    row = series.at(body.fix((t - now) * body.time))
                    found[t] = jump(row, h, body.find_momentum(acts_at(t))) if t == stop else row
                state, now = series.at(body.fix(step * body.time)), now + step
                if now == stop:
                    break
    return [found[Fraction(t)] for t in numbers["times"]], body


def count_outside(motion, numbers, truth=None):
    """How many numbers of the exact motion lie outside of a motion's bounds, and how many were judged.

    Without a truth of all times only those are computed that have bounds."""
    kept = slice(None)
    if truth is None:
        kept = np.isfinite(motion.omega_upper).all(axis=1) & np.isfinite(motion.attitude_upper).all(axis=1)
        numbers = {**numbers, "times": motion.t[kept].tolist()}
    rows, body = truth or compute_exact(numbers)
    slack, scale = Fraction(1, 1 << (DIGITS - 35)), Fraction(1, 1 << body.bits)
    if min(abs(Fraction(t) - Fraction(numbers["t0"])) * body.time for t in numbers["times"]) < Fraction(1, 1 << 70):
        slack = Fraction(1, 1 << (body.bits - 100))   # of a span so short the series are exact to the last bits
    outside = judged = 0
    for lower, upper, part, unit_ in ((motion.omega_lower, motion.omega_upper, slice(0, 3), body.time),
                                      (motion.attitude_lower, motion.attitude_upper, slice(3, 7), 1)):
        for row, low, high in zip(rows, lower[kept], upper[kept], strict=True):
            for x, a, b in zip(row[part], low.tolist(), high.tolist(), strict=True):
                if math.isfinite(a) and math.isfinite(b):
                    judged += 1
                    exact = x * scale
                    outside += not Fraction(a) / unit_ - slack <= exact <= Fraction(b) / unit_ + slack
    return outside, judged
