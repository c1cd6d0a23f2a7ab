"""Two routes to the motion of a free gyrostat that share nothing, for gyrostat_reference.py.

- `Theta`: one theta series for the quaternion, from the four invariants of the motion, at 110 and more digits. The
  roots come from a general root finder, so nothing of the library's way to them is used.
- `Taylor`: the power series of J omega' = (J omega + h) x omega and of the quaternion's equation, step by step.
"""

from attitude_series import append_row
from mpmath import mp, mpc, mpf

DIGITS = 120


def dot(a, b):
    return mp.fsum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def product(p, q):
    (a, b, c, d), (x, y, z, w) = p, q
    return [d * x + a * w + b * z - c * y, d * y - a * z + b * w + c * x,
            d * z + a * y - b * x + c * w, d * w - a * x - b * y - c * z]


def conjugate(q):
    return [-q[0], -q[1], -q[2], q[3]]


def unit(v):
    size = mp.sqrt(dot(v, v))
    return [c / size for c in v]


def turn(axis, angle):
    return [c * mp.sin(angle / 2) for c in axis] + [mp.cos(angle / 2)]


def rotate(q, v):
    return product(product(q, [*v, mpf(0)]), conjugate(q))[:3]


def direction(v):
    return unit(v) if dot(v, v) else [mpf(0), mpf(0), mpf(1)]


def spinor(m):
    if m[2] >= 0:
        first = mp.sqrt((1 + m[2]) / 2)
        return [first, mpc(m[0], m[1]) / (2 * first)]
    second = mp.sqrt((1 - m[2]) / 2)
    return [mpc(m[0], -m[1]) / (2 * second), second]


def quaternion(psi):
    size = mp.sqrt(abs(psi[0]) ** 2 + abs(psi[1]) ** 2)
    first, b = mpc(psi[0]) / size, -1j * psi[1] / size
    return [b.real, b.imag, first.imag, first.real]


def series(nome, w):
    """E, O and their derivatives."""
    out = [mpc(0)] * 4
    k, x = 0, mp.expj(w)
    while True:
        terms = [(nome ** (j * j), 2 * j) for j in {k, -k}] + [(nome ** (j * j + j), 2 * j + 1) for j in {k, -k - 1}]
        size = mpf(0)
        for weight, j in terms:
            value, at = weight * x**j, j % 2
            out[at] += value
            out[2 + at] += 1j * j * value
            size = max(size, abs(value))
        if k > 1 and size < mpf(10) ** (-mp.dps):
            return out
        k += 1


class Theta:
    """The closed form of one motion: at(t) gives (omega, attitude)."""

    def __init__(self, J, h, omega, attitude):
        self.J, self.h, self.omega = ([mpf(c) for c in v] for v in (J, h, omega))
        self.q0 = unit([mpf(c) for c in attitude])
        self.turned = None
        J, h, omega = self.J, self.h, self.omega
        A = self.A = [1 / c for c in J]
        M = [J[i] * omega[i] + h[i] for i in range(3)]
        self.L = mp.sqrt(dot(M, M))
        g = [A[i] * h[i] for i in range(3)]
        self.period = mpf(0)
        tiny = mpf(10) ** (-DIGITS + 15)
        moved = mp.sqrt(dot(cross(M, omega), cross(M, omega)))
        self.c = None
        if self.L == 0 or moved <= tiny * self.L * max(map(abs, omega)):
            self.lam, self.c, self.m = mpf(0), omega, direction(M)
        elif J[0] == J[1] == J[2]:
            self.lam, self.c, self.m = A[0], [-c for c in g], direction(M)
        else:
            for i in range(3):
                j, k = (i + 1) % 3, (i + 2) % 3
                if J[j] == J[k] and h[j] == h[k] == 0:
                    self.lam, self.m = A[j], direction(M)
                    self.c = [omega[i] - A[j] * M[i] if a == i else mpf(0) for a in range(3)]
                elif J[j] == J[k] and h[j] != 0 and h[k] != 0:
                    size = mp.sqrt(h[j] ** 2 + h[k] ** 2)
                    axes = [[mpf(a == b) for b in range(3)] for a in range(3)]
                    axes[j][j] = axes[k][k] = h[j] / size
                    axes[j][k], axes[k][j] = h[k] / size, -h[k] / size
                    self.axes = axes
                    frame = [dot(axes[a], h) for a in range(3)], [dot(axes[a], omega) for a in range(3)]
                    frame[0][k] = mpf(0)
                    self.turned = Theta(J, *frame, [0, 0, 0, 1])
                    self.period = self.turned.period
                    return
        if self.c is None:
            self.set_up(A, g, M, omega)

    def set_up(self, A, g, M, omega):
        L = self.L
        m = [c / L for c in M]
        sg = dot(omega, m) / L
        u, a = [(omega[i] - sg * M[i]) / L for i in range(3)], [c - sg for c in A]
        N = [i for i in range(3) if g[i] != 0]
        Z = [i for i in range(3) if g[i] == 0]

        def times(p, q):
            out = [mpf(0)] * (len(p) + len(q) - 1)
            for i, x in enumerate(p):
                for j, y in enumerate(q):
                    out[i + j] += x * y
            return out

        def add(p, q):
            n = max(len(p), len(q))
            return [x + y for x, y in zip([0] * (n - len(p)) + p, [0] * (n - len(q)) + q)]

        p = [mpf(0)]
        for i in N:
            term = times([-m[i], u[i]], [-m[i], u[i]])
            for j in N:
                term = times(term, [mpf(1), -a[j]]) if j != i else term
            p = add(p, term)
        term = [sum((m[i] ** 2 for i in Z), mpf(0)), -sum((m[i] ** 2 * a[i] for i in Z), mpf(0))]
        for j in N:
            term = times(term, [mpf(1), -a[j]])
        p = add(p, term)
        while len(p) > len(N) + 2:
            p = p[1:]
        found = mp.polyroots(p, maxsteps=3000, extraprec=8 * DIGITS, error=False) if N else [-p[1] / p[0]]
        pairs = [(mpf(a[i]), i) for i in Z] + [(x, None) for x in found]
        self.roots = pairs
        small = mpf(10) ** (-DIGITS // 2)
        real = sorted(((mpf(mp.re(x)), i) for x, i in pairs if abs(mp.im(x)) <= small * max(abs(x), small)),
                      key=lambda r: r[0])
        vectors = []
        for x, i in real:
            if i is not None:
                n, v = [mpf(k == i) for k in range(3)], mpf(0)
            else:
                n, v = [g[k] / (a[k] - x) for k in range(3)], L
                size = max(map(abs, [*n, v]))
                n, v = [c / size for c in n], v / size
            nn = dot(n, n) - v * v
            vectors.append((n, v, nn, abs(nn) / (dot(n, n) + v * v)))
        if len(real) == 2:
            ra, rb = real[0][0], real[1][0]
            other = [x for x, _ in pairs if abs(mp.im(x)) > small * max(abs(x), small)]
            be, ga = -mp.re(other[0] + other[1]), mp.re(other[0] * other[1])
            Sm = 2 * ga + 2 * ra * rb + be * (ra + rb)
            Df2 = (be * be - 4 * ga) * (ra - rb) ** 2
            options = [(0, 1)]
        else:
            r = [x for x, _ in real]
            Sm = (r[2] - r[0]) * (r[3] - r[1]) + (r[3] - r[0]) * (r[2] - r[1])
            Df2 = ((r[1] - r[0]) * (r[3] - r[2])) ** 2
            options = [(0, 1), (2, 3)]
        for attempt in (0, 1):
            SW = (abs(Sm) + mp.sqrt(Sm * Sm - Df2)) / 2
            mm = Df2 / (4 * SW * SW)
            nome = self.nome = mp.qfrom(m=mm) if mm else mpf(0)
            if abs(nome) < mpf("0.0433") or attempt:
                break
            Sm = -((r[1] - r[0]) * (r[3] - r[2]) + (r[2] - r[0]) * (r[3] - r[1]))
            Df2 = ((r[3] - r[0]) * (r[2] - r[1])) ** 2
            options = [(0, 3), (1, 2)]
        pick = max(options, key=lambda o: min(vectors[o[0]][3], vectors[o[1]][3]))
        self.nome = nome = mpf(mp.re(nome))
        E0, O0 = (mp.re(c) for c in series(nome, mpf(0))[:2])
        self.trig = Sm >= 0
        nu = L * mp.sqrt(SW / 2) / E0**2
        nu = mpc(nu) if self.trig else mpc(0, nu)
        (na, va, nna, _), (nb, vb, nnb, _) = (vectors[i] for i in pick)
        sa, sb = mp.sqrt(mpc(nna)), mp.sqrt(mpc(nnb))
        na, va, nb, vb = [c / sa for c in na], va / sa, [c / sb for c in nb], vb / sb
        across = cross(na, nb)
        rho = [across[i] - 1j * (va * nb[i] - vb * na[i]) for i in range(3)]
        size = mp.sqrt(sum(c * c for c in rho))
        rho = [c / size for c in rho]
        rho = [-c for c in rho] if mp.re(rho[2]) < 0 else rho
        bE, bO = [1 + rho[2], rho[0] + 1j * rho[1]], [-rho[0] + 1j * rho[1], 1 + rho[2]]
        bE, bO = ([c / mp.sqrt(abs(b[0]) ** 2 + abs(b[1]) ** 2) for c in b] for b in (bE, bO))

        def disc(b):
            mu = [(b[1], -1j * b[1], b[0]), (b[0], 1j * b[0], -b[1])]
            H2 = dot(omega, m) - dot(g, m)

            def Z(k, l):
                return sum(L * A[i] * mu[k][i] * mu[l][i] - g[i] * (mu[k][i] * b[l] + mu[l][i] * b[k])
                           for i in range(3)) - 2 * H2 * b[k] * b[l] / 2
            return Z(0, 1) ** 2 - Z(0, 0) * Z(1, 1)

        psi0 = spinor(m)
        wm = omega
        slope = [0.5j * (wm[2] * psi0[0] + mpc(wm[0], -wm[1]) * psi0[1]),
                 0.5j * (mpc(wm[0], wm[1]) * psi0[0] - wm[2] * psi0[1])]
        for attempt in (0, 1):
            det = bE[0] * bO[1] - bE[1] * bO[0]
            c0 = disc(bE)
            if abs(c0) < abs(disc(bO)) and not attempt:
                bE, bO = bO, [-c for c in bE]
                continue
            s = mp.sqrt(-c0 / (4 * det**2 * nu**2 * E0**2 * O0**2))
            xE = (psi0[0] * bO[1] - psi0[1] * bO[0]) / det
            ao = (bE[0] * psi0[1] - bE[1] * psi0[0]) / (det * s)
            w0 = self.solve_phase(nome, xE, ao, psi0, slope, det * s * nu)
            if self.trig and nome and abs(w0.imag) > -mp.log(abs(nome)) / 4 and not attempt:
                bE, bO = bO, [-c for c in bE]
                continue
            break
        self.bE, self.bO, self.nu, self.w0 = bE, [s * c for c in bO], nu, w0
        V, dV = self.sums(mpf(0))
        inner = lambda x, y: mp.conj(x[0]) * y[0] + mp.conj(x[1]) * y[1]
        self.kappa = dot(omega, m) / 2 - mp.im(inner(psi0, dV) / inner(psi0, V))
        self.first = conjugate(quaternion(V))
        self.left = product(self.q0, self.first)
        if self.trig:
            self.period = 2 * mp.pi / abs(nu)
        else:
            self.period = (-mp.log(abs(nome)) / abs(nu) * (1 if nome > 0 else 2)) if nome else mp.inf

    @staticmethod
    def solve_phase(nome, xE, ao, psi0, slope, target):
        R = mp.sqrt(xE * xE - 4 * nome * (1 - 2 * nome) * ao * ao)
        R = R if abs(xE + R) >= abs(xE - R) else -R
        w = mp.acos(mpc(ao * (1 - 2 * nome) / (xE + R)))
        for _ in range(60):
            E, O, dE, dO = series(nome, w)
            step = (xE * O - ao * E) / (xE * dO - ao * dE)
            w -= step
            if abs(step) < mpf(10) ** (-mp.dps * 3 // 4):
                break
        wronskian = (psi0[0] * slope[1] - psi0[1] * slope[0]) / target

        def mismatch(w):
            E, O, dE, dO = series(nome, w)
            factor = (ao / O) ** 2 if abs(O) > abs(E) else (xE / E) ** 2
            return abs((dO * E - O * dE) * factor - wronskian)
        return min((w, -w), key=mismatch)

    def sums(self, t):
        E, O, dE, dO = series(self.nome, self.w0 + self.nu * t)
        return ([E * a + O * b for a, b in zip(self.bE, self.bO)],
                [self.nu * (dE * a + dO * b) for a, b in zip(self.bE, self.bO)])

    def at(self, t):
        t = mpf(t)
        if self.turned:
            omega, q = self.turned.at(t)
            back = lambda v: [sum(self.axes[a][b] * v[a] for a in range(3)) for b in range(3)]
            return back(omega), product(self.q0, back(q[:3]) + [q[3]])
        if self.c is not None:
            size = mp.sqrt(dot(self.c, self.c))
            own = turn([c / size for c in self.c], size * t) if size else [0, 0, 0, mpf(1)]
            M = rotate(conjugate(own), [self.L * c for c in self.m])
            spin = product(turn(self.m, self.lam * self.L * t), own)
            omega = [self.lam * M[i] + self.c[i] for i in range(3)]
            return omega, product(self.q0, spin)
        if not self.trig and self.nome:     # back into one passage, so that nothing overflows
            n = int(mp.nint(t / self.period))
            V, phase = self.sums(t - n * self.period)[0], mp.expj(self.kappa * t) * self.passage(n)
        else:
            V, phase = self.sums(t)[0], mp.expj(self.kappa * t)
        V = [phase * c for c in V]
        q = quaternion(V)
        size = abs(V[0]) ** 2 + abs(V[1]) ** 2
        cr = 2 * mp.conj(V[0]) * V[1] / size
        m = [cr.real, cr.imag, (abs(V[0]) ** 2 - abs(V[1]) ** 2) / size]
        omega = [self.A[i] * (self.L * m[i] - self.h[i]) for i in range(3)]
        return omega, product(self.left, q)

    def passage(self, n):
        """The phase that n periods add to the sums: E(w + i Lam) = E(w) e^(-2iw) / Q for Lam = -ln Q."""
        return mp.expj(-2 * self.w0.real * (n if self.nome > 0 else 2 * n))


class Taylor:
    """Power series of omega and of the quaternion."""

    def __init__(self, J, h, omega, attitude, order=60):
        self.J, self.h = [mpf(c) for c in J], [mpf(c) for c in h]
        self.start, self.order = ([mpf(c) for c in omega], unit([mpf(c) for c in attitude])), order
        rate = max(abs(c) for c in omega) + max(abs(c) / i for c, i in zip(h, J))
        spread = max(abs(a - b) / c for a in J for b in J for c in J)
        self.speed = float(rate * max(1, spread)) or 1.0

    def advance(self, state, time):
        steps = int(abs(time) * self.speed * 5) + 1
        h, (w, q), J = mpf(time) / steps, state, self.J

        def cauchy(a, b, n):
            return mp.fdot(a[:n + 1], b[n::-1])
        for _ in range(steps):
            W, Q = [[c] for c in w], [[c] for c in q]
            for n in range(self.order):
                for a in range(3):
                    b, c = (a + 1) % 3, (a + 2) % 3
                    W[a].append(((J[b] - J[c]) * cauchy(W[b], W[c], n) + self.h[b] * W[c][n] - self.h[c] * W[b][n])
                                / (J[a] * (n + 1)))
                append_row(Q, W, n, cauchy)
            w, q = [mp.polyval(c[::-1], h) for c in W], unit([mp.polyval(c[::-1], h) for c in Q])
        return w, q


def distance(a, b, scale):
    """(omega relative to the scale, angle in rad) between two answers."""
    between = product(conjugate(a[1]), b[1])
    angle = 2 * mp.asin(min(mpf(1), mp.sqrt(dot(between[:3], between[:3]))))
    return mp.sqrt(dot(*[[x - y for x, y in zip(a[0], b[0])]] * 2)) / scale, angle
