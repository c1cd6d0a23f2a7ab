"""Reference motions of Lagrange's top, by two routes that share nothing with the code under test.

    python tests/reference/heavy_top_reference.py            # writes heavy_top.json next to this file (half an hour)
    python tests/reference/heavy_top_reference.py --quick    # the same without route 1

Route 1 (`Taylor`): the equations of motion in (omega, q), power series at 60 digits. A nutation period later the top
is where it was but for two turns, q(t + T) = R_z(dphi) q(t) R_z(dpsi), so that one period reaches any time.
Route 2 (`legendre`): the cubic in u = cos(tilt), u through sn, the two azimuths by Legendre's integral of the third
kind (Whittaker, Analytical Dynamics, section 71). Degenerate starts are nudged by 1e-60, far below what is compared.
The product uses neither (theta series). `cond` is the largest move of the exact answer when one input moves by half
an ulp, by route 2.

Needs mpmath; gmpy2 makes it ten times faster.
"""

import cmath
import json
import math
import pathlib
import random
import sys

import mpmath as mp

mp.mp.dps = 60
ORDER = 70


class Taylor:
    """State (w1, w2, x, y, z, w) of moments (A, A, C), weight_arm M, spin w3."""

    def __init__(self, A, C, M, omega, q):
        self.A, self.C, self.M = mp.mpf(A), mp.mpf(C), mp.mpf(M)
        self.w3 = mp.mpf(omega[2])
        n = mp.sqrt(mp.fsum(mp.mpf(c) ** 2 for c in q))
        self.start = [mp.mpf(omega[0]), mp.mpf(omega[1])] + [mp.mpf(c) / n for c in q]

    def series(self, state):
        """Coefficients of the six functions; also of u' = g1 w2 - g2 w1 (up to a factor the speed of the tilt)."""
        w1, w2, x, y, z, w = ([s] for s in state)
        g1, g2, du = [], [], []
        r, m, w3 = (self.A - self.C) / self.A * self.w3, self.M / self.A, self.w3

        def conv(a, b):
            return mp.fdot(a, reversed(b))

        for n in range(ORDER):
            g1.append(2 * (conv(x, z) - conv(w, y)))
            g2.append(2 * (conv(y, z) + conv(w, x)))
            du.append(conv(g1, w2) - conv(g2, w1))
            h = mp.mpf(1) / (n + 1)
            nw1, nw2 = h * (r * w2[n] + m * g2[n]), h * (-r * w1[n] - m * g1[n])
            h /= 2
            nx = h * (conv(w, w1) + y[n] * w3 - conv(z, w2))
            ny = h * (conv(w, w2) + conv(z, w1) - x[n] * w3)
            nz = h * (w[n] * w3 + conv(x, w2) - conv(y, w1))
            nw = -h * (conv(x, w1) + conv(y, w2) + z[n] * w3)
            for series, value in zip((w1, w2, x, y, z, w), (nw1, nw2, nx, ny, nz, nw)):
                series.append(value)
        return (w1, w2, x, y, z, w), du

    @staticmethod
    def step(columns):
        """Where the last terms are 1e-57 of the first."""
        h = mp.inf
        for n in (ORDER, ORDER - 1):
            speed = max(*(abs(c[0]) for c in columns[:2]), mp.mpf(10) ** -300)
            top = max(max(abs(c[n]) for c in columns[:2]) / speed, max(abs(c[n]) for c in columns[2:]))
            if top:
                h = min(h, mp.exp((mp.log(mp.mpf(10) ** -57) - mp.log(top)) / n))
        return h

    def integrate(self, t):
        state, left = self.start, mp.mpf(t)
        while True:
            columns, _ = self.series(state)
            h = self.step(columns)
            if h >= left:
                return self.value(columns, left)
            state, left = self.value(columns, h), left - h

    @staticmethod
    def value(columns, h):
        return [mp.polyval(c[::-1], h) for c in columns]

    def period(self, limit=600):
        """(T, state at T), T from one turning point of the tilt to the next but one, carried back to the start."""
        state, now, zeros = self.start, mp.mpf(0), []
        fastest = abs(self.w3) * (1 + self.C / self.A) + mp.hypot(*self.start[:2]) + mp.sqrt(abs(self.M) / self.A)
        for _ in range(limit):
            columns, du = self.series(state)
            h = min(self.step(columns) / 2, 1 / (2 * fastest))  # no two turning points in a step
            a, b = du[0], mp.polyval(du[::-1], h)
            if a == 0:
                a = -b
                if not zeros:
                    zeros.append(now)
                    a = b
            if a * b < 0:
                zeros.append(now + self.root(du, h))
            if len(zeros) >= 3:
                T = zeros[2] - zeros[0]
                return T, self.integrate(T)
            state, now = self.value(columns, h), now + h
        raise ArithmeticError("no period found")

    @staticmethod
    def root(series, h):
        lo, hi, derivative = mp.mpf(0), h, [n * c for n, c in enumerate(series)][1:]
        sign = mp.sign(mp.polyval(series[::-1], hi))
        x = (lo + hi) / 2
        for _ in range(400):
            f = mp.polyval(series[::-1], x)
            lo, hi = (lo, x) if mp.sign(f) == sign else (x, hi)
            new = x - f / mp.polyval(derivative[::-1], x)
            if not lo <= new <= hi:
                new = (lo + hi) / 2
            if abs(new - x) < h * mp.mpf(10) ** -57:
                return new
            x = new
        return x

    def at(self, times, bounded=True):
        """Rows (w1, w2, w3, x, y, z, w) at each time; `bounded=False`: no period is sought (steady, homoclinic)."""
        rows = []
        T, turned = None, None
        for t in map(mp.mpf, times):
            if T is None and bounded:
                T, end = self.period()
                # q_T = R_z(p) q_0 R_z(s): alpha = w + i z turns by (p + s)/2, beta = x + i y by (p - s)/2
                ref = self.start if min(self.size(self.start)) > mp.mpf("1e-20") else None
                if ref is None:
                    probe = self.integrate(T / 7)
                    other = Taylor.__new__(Taylor)
                    other.__dict__.update(self.__dict__)
                    other.start = probe
                    ref, end = probe, other.integrate(T)
                turned = [(end[5] + 1j * end[4]) / (ref[5] + 1j * ref[4]),
                          (end[2] + 1j * end[3]) / (ref[2] + 1j * ref[3])]
                turned = [c / abs(c) for c in turned]
            N = int(mp.floor(t / T)) if bounded else 0
            s = self.integrate(t - N * T) if bounded else self.integrate(t)
            al, be, wp = s[5] + 1j * s[4], s[2] + 1j * s[3], s[0] + 1j * s[1]
            if N:
                ta, tb = turned[0] ** N, turned[1] ** N
                al, be, wp = al * ta, be * tb, wp * tb / ta  # e^{-i s} = e^{i((p - s) - (p + s))/2}
            rows.append([wp.real, wp.imag, self.w3, be.real, be.imag, al.imag, al.real])
        return rows

    @staticmethod
    def size(s):
        return abs(s[5] + 1j * s[4]), abs(s[2] + 1j * s[3])


def legendre(A, C, M, omega, q, times, digits=330):
    """Rows as Taylor.at, by elliptic integrals; so many digits, for the nudged starts cancel up to half of them."""
    with mp.workdps(digits):
        return _legendre(A, C, M, omega, q, times, mp.mpf(10) ** -(2 * digits // 11))


def _legendre(A, C, M, omega, q, times, eps):
    A, C, M = mp.mpf(A), mp.mpf(C), mp.mpf(M)
    w1, w2, w3 = map(mp.mpf, omega)
    speed = max(abs(w1), abs(w2), abs(w3), mp.sqrt(abs(M) / A))
    x, y, z, w = map(mp.mpf, q)
    n = mp.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / n + eps, y / n + eps * 2, z / n - eps / 3, w / n + eps / 7
    if M == 0:
        M = A * speed**2 * eps**2
    # nudges of relative size eps on the start; amplitudes of 1e-30 survive, exact zeros become generic
    w1, w2 = w1 + speed * eps / 3, w2 - speed * eps / 5
    n = mp.sqrt(x * x + y * y + z * z + w * w)
    x, y, z, w = x / n, y / n, z / n, w / n
    flip = M < 0
    if flip:
        x, y, z, w = w, z, -y, -x
        w2, w3, M = -w2, -w3, -M
    a, bt = C * w3 / A, 2 * M / A
    u0 = z * z + w * w - x * x - y * y
    g1, g2 = 2 * (x * z - w * y), 2 * (y * z + w * x)
    b = w1 * g1 + w2 * g2 + a * u0
    du0 = g1 * w2 - g2 * w1
    ee = w1 * w1 + w2 * w2 + bt * u0
    # u'^2 = (ee - bt u)(1 - u^2) - (b - a u)^2; all roots by mpmath, then polished
    cubic = [bt, -ee - a * a, 2 * a * b - bt, ee - b * b]
    with mp.workdps(2 * mp.mp.dps + 100):
        roots = sorted(mp.polyroots(cubic, maxsteps=2000, extraprec=6 * mp.mp.dps), key=lambda r: mp.re(r))
    u1, u2, u3 = (mp.re(r) for r in roots)
    D, E = u2 - u1, bt * (u3 - u1)
    m = (u2 - u1) / (u3 - u1)
    p = mp.sqrt(E) / 2
    s0 = mp.sqrt(min(max((u0 - u1) / D, mp.mpf(0)), mp.mpf(1)))
    phi0 = mp.asin(s0) * (1 if du0 >= 0 else -1)
    K = mp.ellipk(m)
    F0 = mp.ellipf(phi0, m)
    nA, nB = -D / (1 + u1), D / (1 - u1)
    complete = {}

    def azimuths(N, phi, tau):
        """Integrals of alpha's and beta's phase rates from u = u1."""
        def third(n_):
            if N and n_ not in complete:
                complete[n_] = mp.ellippi(n_, m)
            whole = 2 * N * complete[n_] if N else 0
            return (whole + mp.ellippi(n_, phi, m)) / p
        fa = (w3 - a) / 2 * tau + (a + b) / 2 / (1 + u1) * third(nA)
        fb = (a - w3) / 2 * tau + (b - a) / 2 / (1 - u1) * third(nB)
        return fa, fb

    start = azimuths(0, phi0, F0 / p)
    al0, be0 = w + 1j * z, x + 1j * y
    rows = []
    for t in map(mp.mpf, times):
        v = p * t + F0
        N = int(mp.nint(v / (2 * K)))
        r = v - 2 * N * K
        sn, cn, dn = (mp.ellipfun(k, r, m=m) for k in ("sn", "cn", "dn"))
        phi = mp.atan2(sn, cn)
        u = u1 + D * sn * sn
        du = 2 * D * p * sn * cn * dn
        end = azimuths(N, phi, v / p)
        ta, tb = mp.expj(end[0] - start[0]), mp.expj(end[1] - start[1])
        al = al0 / abs(al0) * mp.sqrt((1 + u) / 2) * ta
        be = be0 / abs(be0) * mp.sqrt((1 - u) / 2) * tb
        dal = al * (du / (2 * (1 + u)) + 1j * ((w3 - a) / 2 + (a + b) / 2 / (1 + u)))
        dbe = be * (-du / (2 * (1 - u)) + 1j * ((a - w3) / 2 + (b - a) / 2 / (1 - u)))
        wp = 2 * (mp.conj(al) * dbe - be * mp.conj(dal))
        row = [wp.real, wp.imag, w3, be.real, be.imag, al.imag, al.real]
        if flip:
            w1_, w2_, w3_, x, y, z, w = row
            row = [w1_, -w2_, -w3_, -w, -z, y, x]
        rows.append(row)
    return rows


def start(theta, dtheta, dphi, w3, phi=0.4, psi=-0.3):
    """Doubles (omega, q) of a top tilted by theta, from the z-x-z angles and their rates."""
    al, be = math.cos(theta / 2) * cmath.exp(0.5j * (phi + psi)), math.sin(theta / 2) * cmath.exp(0.5j * (phi - psi))
    wp = (dtheta + 1j * dphi * math.sin(theta)) * cmath.exp(-1j * psi)
    return (wp.real, wp.imag, w3), (be.real, be.imag, al.imag, al.real)


ANY = (0.3, 7.7, 1e3, 1e6, 1e9)
SHORT = (0.3, 2.5, 7.7, 20.0)
ONCE = (0.3, 2.5, 7.7, 20.0, 150.0)
UP, DOWN, LEVEL = (0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0), (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))


def regimes():
    """(name, A, C, M, omega, q, times, kind of motion for route 1)."""
    yield "looping", 1.0, 0.5, 1.3, *start(0.9, 0.0, -0.6, 5.0), ANY, True
    yield "looping", 2.0, 3.1, 4.0, *start(1.1, 0.3, -0.2, 3.0), ANY, True
    yield "cuspidal", 1.0, 0.4, 1.0, *start(0.7, 0.0, 0.0, 6.0), ANY, True
    yield "cuspidal", 3.0, 0.02, 1.0, *start(2.2, 0.0, 0.0, 9.0), ANY, True
    yield "monotone", 1.0, 0.6, 1.0, *start(0.8, 0.2, 1.5, 5.0), ANY, True
    yield "monotone", 1.0, 1.9, 0.3, *start(1.9, 0.2, -2.9, 0.7), ANY, True
    yield "pendulum", 1.0, 0.5, 1.0, *start(2.5, 0.3, 0.0, 0.0), ANY, True
    yield "pendulum", 1.0, 0.5, 1.0, *start(2.5, 3.3, 0.0, 0.0), ANY, True
    yield "pendulum", 1.0, 1.5, 0.7, (0.4, 0.0, 0.0), (0.6, 0.0, 0.0, 0.8), ANY, True
    yield "pendulum", 1.0, 1.5, 0.7, (4.0, 0.0, 0.0), (0.6, 0.0, 0.0, 0.8), ANY, True
    yield "spherical pendulum", 1.0, 0.5, 1.0, *start(2.5, 0.3, 0.9, 0.0), ANY, True
    yield "spherical pendulum", 1.0, 0.5, 1.0, *start(0.2, 0.0, 1e-3, 0.0), ANY, True
    for sign in (1, -1):  # the two steady rates at one tilt, rounded to doubles
        a, c, theta = 0.5 * 6.0, math.cos(1.0), 1.0
        rate = (a + sign * math.sqrt(a * a - 4 * c * 1.1)) / (2 * c)
        yield "steady precession", 1.0, 0.5, 1.1, *start(theta, 0.0, rate, 6.0), ANY, True
        for off in (1e-3, 1e-9, 1e-14):
            yield "near steady", 1.0, 0.5, 1.1, *start(theta, off, rate * (1 + off), 6.0), ANY, True
    yield "steady precession", 1.0, 0.5, 1.0, (0.0, 1.0, 2.0), LEVEL, ANY, False
    for w3 in (8.0, 4.1, 4.0, 3.9, 1.0, 0.0):  # critical at 4
        yield "sleeping", 1.0, 0.5, 1.0, (0.0, 0.0, w3), UP, SHORT if w3 < 4.05 else ANY, False
        for kick in (1e-1, 1e-4, 1e-8):
            yield "sleeping, kicked", 1.0, 0.5, 1.0, (kick, 0.0, w3), UP, ANY if w3 > 4.05 else ONCE, True
            yield "sleeping, tilted", 1.0, 0.5, 1.0, *start(kick, 0.0, 0.0, w3), ANY if w3 > 4.05 else ONCE, True
    for tilt in (1e-1, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14, 1e-15):
        yield "near homoclinic", 1.0, 0.5, 1.0, *start(tilt, 0.0, 0.0, 2.0), ONCE, True
        yield "near homoclinic", 1.0, 0.5, 1.0, *start(tilt, 0.0, 0.0, 0.0), ONCE, True
        yield "near homoclinic", 1.0, 0.5, 1.0, (2.0 * (1 + tilt), 0.0, 0.0), DOWN, ONCE, True
        yield "near homoclinic", 1.0, 0.5, 1.0, (2.0 * (1 - tilt), 0.0, 0.0), DOWN, ONCE, True
        yield "near homoclinic", 1.0, 1.0, 12.5, (4.0 * (1 + tilt), 3.0, 3.0), LEVEL, ONCE, True
        yield "near homoclinic", 1.0, 1.0, 12.5, (4.0 * (1 - tilt), 3.0, 3.0), LEVEL, ONCE, True
    yield "homoclinic", 1.0, 0.5, 1.0, (2.0, 0.0, 0.0), DOWN, SHORT, False
    yield "homoclinic", 1.0, 0.5, -1.0, (0.0, 2.0, 0.0), UP, SHORT, False
    for tilt in (1e-9, 1e-20, 1e-30):  # next to the vertical, with a kick that is not small beside the tilt
        yield "near vertical", 1.0, 0.5, 1.0, (2.0, 1e-3, 0.3), (1.0, 0.0, tilt / 3, tilt), ONCE, True
        yield "near vertical", 1.0, 0.5, 1.0, (1e-2, 1e-3, 0.3), (tilt / 3, -tilt, 0.0, 1.0), ONCE, True
        yield "near vertical", 1.0, 0.5, 1.0, (0.2, 1e-3, 4.8), (tilt / 3, -tilt, 0.0, 1.0), ANY, True
        yield "near vertical", 1.0, 0.5, 1.0, (0.7, 0.0, 0.3), (1.0, 0.0, tilt / 3, tilt), ANY, True
    yield "homoclinic", 1.0, 1.0, 12.5, (4.0, 3.0, 3.0), LEVEL, SHORT, False
    for kick in (1.0, 1e-4, 1e-8, 1e-16):
        yield "hanging, kicked", 1.0, 0.5, 1.0, (kick, 0.0, 0.0), DOWN, ANY, True
        yield "hanging, kicked", 1.0, 0.5, 1.0, (kick, -kick / 3, 3.0), DOWN, ANY, True
        yield "hanging, kicked", 1.0, 0.5, -1.0, (0.0, kick, 3.0), UP, ANY, True
        tilted = (math.sqrt(1 - kick**2 / 2), 0.0, kick / 2, kick / 2)
        yield "hanging, tilted", 1.0, 0.5, 1.0, (0.0, 0.0, 0.7), tilted, ANY, True
    yield "hanging", 1.0, 0.5, 1.0, (0.0, 0.0, 2.0), DOWN, ANY, False
    yield "hanging", 1.0, 0.5, 1.0, (0.0, 0.0, 0.0), DOWN, ANY, False
    for M in (0.0, 1e-300, 1e-100, 1e-20, 1e-12, 1e-6, -1e-9, -1e-300):
        yield "weight to zero", 1.0, 0.7, M, *start(0.8, 0.4, 0.9, 2.0), ANY, M != 0
    yield "weight to zero", 1.0, 0.7, 0.0, (0.0, 0.0, 2.0), UP, ANY, False
    yield "weight to zero", 1.0, 1.7, 1e-9, *start(0.8, 0.0, 0.0, 2.0), ANY, True
    for M in (1.0, 0.2, -0.2, -1.0, -7.0):
        yield "negative and positive weight", 1.0, 0.8, M, *start(2.1, 0.6, 0.4, 2.0), ANY, True
    for s in (1e-150, 1e-60, 1e60, 1e150):
        omega, q = start(0.9, 0.3, -0.6, 5.0)
        yield "scales", 1.0, 0.5, 1.3 * s * s, tuple(w * s for w in omega), q, tuple(t / s for t in ANY), False
        yield "scales", s, 0.5 * s, 1.3 * s, omega, q, ANY, False
    for C in (1e-12, 1e-6, 1e-3, 2.0 - 1e-12, 2.0):
        yield "needle and disc", 1.0, C, 1.0, *start(0.9, 0.3, 0.6, 2.0), ANY, True
    yield "fast", 1.0, 0.5, 1.0, *start(0.9, 0.0, 0.0, 1e4), (0.3, 7.7, 1e3, 1e5), True
    yield "fast", 1.0, 0.5, 1.0, *start(0.9, 1.0, 1e4, 3.0), (0.3, 7.7, 1e3, 1e5), True


def random_tops(count, rng):
    for _ in range(count):
        speed = [10 ** rng.uniform(-2.5, 1.2) * rng.choice((-1, 1)) for _ in range(3)]
        body = (1.0, 2 * rng.random(), rng.choice((-1, 1)) * 10 ** rng.uniform(-2, 1))
        yield "random", *body, *start(math.acos(rng.uniform(-1, 1)), *speed, rng.uniform(-3, 3), rng.uniform(-3, 3)), \
            (rng.uniform(0, 20), 10 ** rng.uniform(1, 9)), False


def at_rest(rows):
    """Nothing moves but by the nudge."""
    return max(abs(a - b) for r in rows for a, b in zip(r[3:], rows[0][3:])) < 1e-20 and abs(rows[0][2]) < 1e-20


def moved(rows, exact):
    """Largest (angle, |omega| relative to max |omega|) for each row; small differences kept."""
    top = max(mp.sqrt(mp.fsum(c * c for c in r[:3])) for r in exact)
    top = top if top > mp.mpf(10) ** -250 and not at_rest(exact) else mp.mpf(1)
    out = []
    for r, s in zip(rows, exact):
        sign = 1 if mp.fsum(a * b for a, b in zip(r[3:], s[3:])) >= 0 else -1
        turn = mp.sqrt(mp.fsum((a - sign * b) ** 2 for a, b in zip(r[3:], s[3:])))
        out.append((4 * mp.asin(min(turn / 2, 1)), mp.sqrt(mp.fsum((a - b) ** 2 for a, b in zip(r[:3], s[:3]))) / top))
    return out


def condition(A, C, M, omega, q, times, signs):
    """Largest move of the answer when one input moves by half an ulp; a coarser route 2 tells."""
    exact = legendre(A, C, M, omega, q, times, 140)
    inputs = [A, C, M, *omega, *q]
    worst = [[mp.mpf(0)] * 2 for _ in times]
    for i in range(len(inputs) + 1):
        for sign in signs:
            v = [mp.mpf(c) for c in inputs]
            ts = [mp.mpf(t) for t in times]
            if i < len(inputs):
                if inputs[i] == 0:
                    continue
                v[i] += sign * mp.mpf(math.ulp(inputs[i])) / 2
            else:
                ts = [mp.mpf(t) + sign * mp.mpf(math.ulp(t)) / 2 for t in times]
            rows = legendre(v[0], v[1], v[2], v[3:6], v[6:10], ts, 140)
            for best, new in zip(worst, moved(rows, exact)):
                best[:] = [max(a, b) for a, b in zip(best, new)]
    return worst


def make_row(case):
    name, A, C, M, omega, q, times, bounded = case
    exact = legendre(A, C, M, omega, q, times)
    check = None
    if name != "random" and "--quick" not in sys.argv:
        some = [t for t in times if bounded or t * max(map(abs, (*omega, math.sqrt(abs(M) / A)))) < 300]
        try:
            rows = Taylor(A, C, M, omega, q).at(some, bounded)
        except ArithmeticError:  # too long a nutation: compare the first times alone
            some = [t for t in times if t < 30]
            rows = Taylor(A, C, M, omega, q).at(some, False)
        check = float(max((max(m) for m in moved(rows, exact[:len(some)])), default=0))
    conds = condition(A, C, M, omega, q, times, (1, -1) if "homoclinic" in name else (1,))
    keep = [i for i in range(len(times)) if max(conds[i]) < 1e-4]
    return {"name": name, "moments": [A, A, C], "weight_arm": M, "omega": list(omega), "attitude": list(q),
            "t": [times[i] for i in keep], "answer": [[float(c) for c in exact[i]] for i in keep],
            "cond": [[float(f"{float(c):.3g}") for c in conds[i]] for i in keep]}, check


def main():
    import multiprocessing
    cases = [*regimes(), *random_tops(80, random.Random(20))]
    table, worst = [], 0.0
    with multiprocessing.Pool(2) as pool:
        for row, check in pool.imap(make_row, cases):
            cond = max(map(max, row["cond"]), default=0)
            print(f"{row['name']:30s} routes differ by {check}, cond {cond:.1e}", flush=True)
            worst = max(worst, check or 0.0)
            table.append(row)
    print(f"{len(table)} tops, {sum(len(r['t']) for r in table)} states; the routes differ by at most {worst:.1e}")
    path = pathlib.Path(__file__).with_name("heavy_top.json")
    path.write_text("[\n" + ",\n".join(json.dumps(row) for row in table) + "\n]\n")


if __name__ == "__main__":
    main()
