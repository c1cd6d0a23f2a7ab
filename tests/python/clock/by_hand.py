"""Closed loops stepped from tick to tick in mpmath: the law and the motion, by a route of their own.

The motion between two instants is a Taylor series of the equations of rate and quaternion, written out coefficient by
coefficient. Laws are the same Python functions, called on arrays of mpf.
"""

import itertools

import mpmath as mp
import numpy as np

ORDER = 24


def product(a, b, n):
    return mp.fsum(a[k] * b[n - k] for k in range(n + 1))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def to_body(q, v):
    """R^T v by the cross product form: v + 2 p x (p x v) - 2 w p x v."""
    p, w = q[:3], q[3]
    c = cross(p, v)
    cc = cross(p, c)
    return [v[i] + 2 * cc[i] - 2 * w * c[i] for i in range(3)]


class Body:
    """A rigid body with rotors: J of the carrier, torques held, a moment in a field, rotors with viscous bearings."""

    def __init__(self, J, axes=(), inertias=(), viscous=(), field=None, damping=0):
        self.J = mp.matrix(J)
        self.inverse = self.J**-1
        self.axes = [[mp.mpf(float(x)) for x in a] for a in axes]
        self.inertias, self.viscous = [mp.mpf(x) for x in inertias], [mp.mpf(x) for x in viscous]
        self.field = field                    # series(t, order) of B in space axes
        self.damping = mp.mpf(damping)

    def series(self, t, w, q, h, torque, dipole, motor, order):
        """Coefficients of w, q and the rotors' momenta."""
        W, Q, H = [[x] for x in w], [[x] for x in q], [[x] for x in h]
        B = self.field(t, order) if self.field is not None and any(dipole) else None
        QQ, Jw = {}, [[], [], []]
        seen = [[], [], []]
        for n in range(order):
            for i in range(3):
                Jw[i].append(mp.fsum(self.J[i, j] * W[j][n] for j in range(3))
                             + mp.fsum(a[i] * hs[n] for a, hs in zip(self.axes, H, strict=True)))
            tau = [product(Jw[(i + 1) % 3], W[(i + 2) % 3], n) - product(Jw[(i + 2) % 3], W[(i + 1) % 3], n)
                   for i in range(3)]
            tau = [x - self.damping * W[i][n] + (torque[i] if n == 0 else 0) for i, x in enumerate(tau)]
            if B is not None:
                for a, b in itertools.combinations_with_replacement(range(4), 2):
                    QQ.setdefault((a, b), []).append(product(Q[a], Q[b], n))

                def R(i, j, k):   # coefficient k of R_ij
                    g = lambda a, b: QQ[min(a, b), max(a, b)][k]
                    if i == j:
                        return g(3, 3) + g(i, i) - g((i + 1) % 3, (i + 1) % 3) - g((i + 2) % 3, (i + 2) % 3)
                    third = 3 - i - j
                    sign = 1 if (i, j) in ((2, 1), (0, 2), (1, 0)) else -1
                    return 2 * (g(i, j) + sign * g(3, third))

                for i in range(3):
                    seen[i].append(mp.fsum(R(j, i, k) * B[j][n - k] for j in range(3) for k in range(n + 1)))
                c = cross(dipole, [seen[i][n] for i in range(3)])
                tau = [tau[i] + c[i] for i in range(3)]
            for r, (a, Is, c) in enumerate(zip(self.axes, self.inertias, self.viscous, strict=False)):
                speed = H[r][n] / Is - mp.fsum(a[i] * W[i][n] for i in range(3))
                effort = (motor[r] if n == 0 else 0) - c * speed
                H[r].append(effort / (n + 1))
                tau = [tau[i] - a[i] * effort for i in range(3)]
            if not self.viscous:
                for hs in H:
                    hs.append(mp.mpf(0))
            dw = self.inverse * mp.matrix(tau)
            x, y, z, s = Q
            dq = [product(s, W[0], n) + product(y, W[2], n) - product(z, W[1], n),
                  product(s, W[1], n) + product(z, W[0], n) - product(x, W[2], n),
                  product(s, W[2], n) + product(x, W[1], n) - product(y, W[0], n),
                  -product(x, W[0], n) - product(y, W[1], n) - product(z, W[2], n)]
            for i in range(3):
                W[i].append(dw[i] / (n + 1))
            for i in range(4):
                Q[i].append(dq[i] / (2 * (n + 1)))
        return W, Q, H

    def go(self, t, end, w, q, h, torque, dipole, motor):
        while t < end:
            W, Q, H = self.series(t, w, q, h, torque, dipole, motor, ORDER)
            size = max(max(abs(x[0]) for x in W), mp.mpf("1e-3"))
            tail = max(max(abs(x[ORDER]) for x in W) / size, max(abs(x[ORDER]) for x in Q), mp.mpf("1e-90"))
            step = min((mp.mpf("1e-33") / tail) ** (mp.mpf(1) / ORDER), end - t)
            value = lambda c: mp.polyval(c[::-1], step)
            w, q, h = [value(c) for c in W], [value(c) for c in Q], [value(c) for c in H]
            t += step
        return w, q, h


class Pick:
    def __init__(self, **values):
        self.__dict__.update(values)


def real(x):
    return x if isinstance(x, mp.mpf) else mp.mpf(float(x))


def half_even(x):
    low = mp.floor(x)
    rest = x - low
    return low + (1 if rest > 0.5 or (rest == 0.5 and int(low) % 2) else 0)


def run(body, w, q, times, controllers, h=(), held=False, t0=0.0):
    """Return rows (w, q) at the times. Each controller: a dict of period, function, output, and the rest by name.

    `held`: the rotors' momenta are what a controller sets, and J w + h stays.
    """
    w, q = [real(x) for x in w], [real(x) for x in q]
    size = mp.sqrt(mp.fsum(x * x for x in q))
    q, h = [x / size for x in q], [real(x) for x in h]
    close = lambda a, b: max(a, b) < mp.inf and abs(a - b) <= 9e-16 * max(abs(a), abs(b))
    n = len(controllers)
    states = [{k: np.array([real(x) for x in np.ravel(v)], object) if np.ndim(v) else real(v)
               for k, v in c.get("states", {}).items()} for c in controllers]
    ticks, queue, off = [0] * n, [[] for _ in range(n)], [mp.inf] * n
    command = [[mp.mpf(0)] * c.get("count", 3) for c in controllers]
    for i, c in enumerate(controllers):
        while c.get("start", 0.0) + ticks[i] * c["period"] < t0 - 1e-12:
            ticks[i] += 1
    t, rows, last = mp.mpf(t0), [], max(times)
    samples = sorted(times)

    def hold(i, value):
        nonlocal w, h
        if controllers[i].get("output", "torque") == "rotor_momentum":
            kick = [mp.fsum(a[k] * (old - new) for a, old, new in zip(body.axes, h, value,
                                                                      strict=True)) for k in range(3)]
            dw = body.inverse * mp.matrix(kick)
            w, h = [w[k] + dw[k] for k in range(3)], list(value)
        command[i] = list(value)

    def act(now):
        for i in range(n):
            if off[i] < now or close(off[i], now):
                off[i] = mp.inf
                hold(i, [mp.mpf(0)] * len(command[i]))
        before = list(w), list(q), list(h)
        for i, c in enumerate(controllers):
            tick = c.get("start", 0.0) + ticks[i] * c["period"]
            if (tick > now and not close(tick, now)) or tick > last or close(tick, last):
                continue
            W, Q, H = before
            sign = -1 if Q[3] < 0 else 1
            omega = list(W)
            if c.get("quantum"):
                omega = [half_even(x / mp.mpf(c["quantum"])) * mp.mpf(c["quantum"]) for x in omega]
            m = Pick(t=mp.mpf(tick), omega=np.array(omega, object), attitude=np.array([sign * x for x in Q], object))
            if body.field is not None:
                m.field = np.array(to_body(Q, [x[0] for x in body.field(mp.mpf(tick), 1)]), object)
            if body.inertias:
                m.speed = np.array([hs / Is - mp.fsum(a[k] * W[k] for k in range(3)) if not held else hs / Is
                                    for hs, Is, a in zip(H, body.inertias, body.axes, strict=True)], object)
            p = Pick(**{k: np.array([real(x) for x in v], object) if np.ndim(v) else real(v) for k,
                        v in c.get("parameters", {}).items()})
            result = c["function"](m.t, m, Pick(**states[i]), p)
            if isinstance(result, tuple):
                result, new = result
                states[i] = {**states[i], **new}
            value = [mp.mpf(x) for x in result]
            if c.get("limit"):
                value = [max(-mp.mpf(c["limit"]), min(mp.mpf(c["limit"]), x)) for x in value]
            queue[i].append((mp.mpf(tick + c.get("delay", 0.0)), value))
            ticks[i] += 1
        for i, c in enumerate(controllers):
            while queue[i] and (queue[i][0][0] < now or close(queue[i][0][0], now)):
                at, value = queue[i].pop(0)
                hold(i, value)
                if c.get("width"):
                    off[i] = mp.mpf(float(at) + c["width"])

    def put(now):
        while samples and (samples[0] <= now or close(samples[0], now)):
            samples.pop(0)
            rows.append(list(w) + list(q))

    act(t)
    put(t)
    while samples:
        stops = [mp.mpf(c.get("start", 0.0) + ticks[i] * c["period"]) for i, c in enumerate(controllers)]
        stops = [s for s in stops if s < last and not close(s, last)]
        stops += [x[0][0] for x in queue if x] + off + [mp.mpf(samples[0])]
        stop = min(stops)
        if samples and close(stop, samples[0]):
            near = [s for s in stops if close(s, stop)]
            stop = min(near)
        kinds = {c.get("output", "torque"): command[i] for i, c in enumerate(controllers)}
        torques = [command[i] for i, c in enumerate(controllers) if c.get("output", "torque") == "torque"]
        total = [mp.fsum(one[k] for one in torques) for k in range(3)]
        motor = kinds.get("rotor_torque", [mp.mpf(0)] * len(h))
        w, q, h = body.go(t, stop, w, q, h, total, kinds.get("dipole", [0] * 3), motor)
        t = stop
        act(t)
        put(t)
    return rows


def circular_dipole(mu, radius, inclination, strength):
    """The field of an untilted dipole on a circular orbit that starts at its node, as a series in time."""
    n = mp.sqrt(mp.mpf(mu) / mp.mpf(radius) ** 3)

    def series(t, order):
        ci, si = mp.cos(mp.mpf(inclination)), mp.sin(mp.mpf(inclination))
        cos = [n**k * mp.cos(n * t + k * mp.pi / 2) / mp.factorial(k) for k in range(order + 1)]
        sin = [n**k * mp.sin(n * t + k * mp.pi / 2) / mp.factorial(k) for k in range(order + 1)]
        u = [cos, [x * ci for x in sin], [x * si for x in sin]]
        scale = mp.mpf(strength) / mp.mpf(radius) ** 3
        return [[scale * (3 * product(u[2], u[i], k) - (1 if i == 2 and k == 0 else 0)) for k in range(order + 1)]
                for i in range(3)]

    return series
