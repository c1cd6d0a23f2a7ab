"""Edges of shadows in 50 digits: roots over the true anomaly, and Kepler's equation in its three classical forms."""

import mpmath

mp = mpmath.mp.clone()
mp.dps = 50


def dot(a, b):
    return mp.fsum(x * y for x, y in zip(a, b, strict=True))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def scaled(a, s):
    return [x * s for x in a]


class Conic:
    """A conic by its classical elements, from a state at t = 0."""

    def __init__(self, mu, r, v):
        self.mu, r, v = mp.mpf(mu), [mp.mpf(x) for x in r], [mp.mpf(x) for x in v]
        self.h = cross(r, v)
        size = mp.sqrt(dot(r, r))
        towards = [a / self.mu - x / size for a, x in zip(cross(v, self.h), r, strict=True)]
        self.e = mp.sqrt(dot(towards, towards))
        self.p = dot(self.h, self.h) / self.mu
        x = towards if self.e > mp.mpf(10) ** -30 else r
        self.x = scaled(x, 1 / mp.sqrt(dot(x, x)))
        z = scaled(self.h, 1 / mp.sqrt(dot(self.h, self.h)))
        self.y = cross(z, self.x)
        self.start = mp.atan2(dot(r, self.y), dot(r, self.x))
        self.shift = self.since(self.start)

    def since(self, nu):
        """The time from the periapsis."""
        e, p, mu = self.e, self.p, self.mu
        if abs(1 - e) < mp.mpf(10) ** -40:
            d = mp.tan(nu / 2)
            return mp.sqrt(p**3 / mu) / 2 * (d + d**3 / 3)
        a = p / (1 - e * e)
        if e < 1:
            turns = mp.floor((nu + mp.pi) / (2 * mp.pi))
            E = 2 * mp.atan(mp.sqrt((1 - e) / (1 + e)) * mp.tan((nu - 2 * mp.pi * turns) / 2)) + 2 * mp.pi * turns
            return mp.sqrt(a**3 / mu) * (E - e * mp.sin(E))
        H = 2 * mp.atanh(mp.sqrt((e - 1) / (e + 1)) * mp.tan(nu / 2))
        return mp.sqrt(-a**3 / mu) * (e * mp.sinh(H) - H)

    def time(self, nu):
        return self.since(nu) - self.shift

    @property
    def period(self):
        return 2 * mp.pi * mp.sqrt((self.p / (1 - self.e**2)) ** 3 / self.mu)

    def edges(self, sun, radius, looks=720):
        """Rows (time, enters) of the edges over one revolution or the whole branch, by the true anomaly."""
        s = [mp.mpf(x) for x in sun]
        s = scaled(s, 1 / mp.sqrt(dot(s, s)))
        sx, sy, radius = dot(s, self.x), dot(s, self.y), mp.mpf(radius)

        def reach(nu):   # the sign of the distance from the axis less the radius
            away = mp.sqrt(1 - (sx * mp.cos(nu) + sy * mp.sin(nu)) ** 2)
            return self.p * away - radius * (1 + self.e * mp.cos(nu))

        last = mp.pi if self.e < 1 else mp.acos(-1 / self.e) * (1 - mp.mpf(10) ** -12)
        grid = [last * (2 * mp.mpf(k) / looks - 1) for k in range(looks + 1)]
        found = []
        for a, b in zip(grid[:-1], grid[1:], strict=True):
            if reach(a) * reach(b) > 0:
                continue
            nu = mp.findroot(reach, (a, b), solver="anderson", tol=mp.mpf(10) ** -90)
            if sx * mp.cos(nu) + sy * mp.sin(nu) < 0:
                found.append((self.time(nu), bool(reach(b) < 0)))
        return found
