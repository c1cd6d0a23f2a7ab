"""Truth of motions under torques that are formulas: mpmath, extrapolated midpoint steps, 34 digits.

Each law is written here by hand on mpmath numbers, so that neither the trace nor the series of the package takes part.
The step is halved until the last 28 digits stay. Writes formula_motion.json beside this file.
"""

import json
from pathlib import Path

import mpmath as mp

mp.mp.dps = 40
f = mp.mpf


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def to_body(q, v):
    """R^T v by two cross products."""
    p, w = [-q[0], -q[1], -q[2]], q[3]
    twice = [2 * x for x in cross(p, v)]
    more = cross(p, twice)
    return [v[i] + w * twice[i] + more[i] for i in range(3)]


def times(M, v):
    return [sum(f(M[i][j]) * v[j] for j in range(3)) for i in range(3)]


def vector(*numbers):
    return [f(x) for x in numbers]


# The numbers are float64 where the package's formulas have them: f(0.3) is that float64.
def heavy(t, w, q, I):
    return [-x for x in cross(vector(0.3, -0.2, 0.7), to_body(q, vector(0, 0, 1)))]


def gradient(t, w, q, I):
    u = to_body(q, [mp.cos(f(0.4) * t + f(0.3)), mp.sin(f(0.4) * t + f(0.3)), f(0)])
    return [3 * f(0.4) ** 2 * x for x in cross(u, times(I, u))]


def pd(t, w, q, I):
    return [-f(0.7) * q[i] * q[3] - f(k) * w[i] for i, k in enumerate((0.5, 0.5, 0.4))]


def saturated(t, w, q, I):
    return [f(0.3) * mp.tanh((-f(0.7) * q[i] * q[3] - f(0.5) * w[i]) / f(0.3)) for i in range(3)]


def drag(t, w, q, I):
    speed = mp.sqrt(sum(x * x for x in w))
    return [-f(0.08) * speed * x for x in w]


def spring(t, w, q, I):
    """Towards a direction of space, as strong as the angle between them."""
    aim, axis = to_body(q, vector(0, 1, 0)), vector(0, 0, 1)
    across = cross(axis, aim)
    sine = mp.sqrt(sum(x * x for x in across))
    angle = mp.atan2(sine, aim[2])
    return [f(0.6) * angle / sine * x - f(0.05) * v for x, v in zip(across, w)]


def dipole(t, w, q, I):
    a = f(0.9) * t
    field = [f(0.6) * mp.cos(a), f(1.1) * mp.sin(a), f(0.3)]
    return cross(vector(0.2, 0.1, -0.3), to_body(q, field))


def mixture(t, w, q, I):
    size = f(1.5) + w[0] ** 2 + w[1] ** 2
    return [f(0.2) * mp.exp(-f(0.1) * t) * mp.sin(w[2]) - f(0.1) * w[0],
            f(0.1) * mp.log(size) * q[0] - f(0.05) * w[1] ** 3,
            f(0.3) * size ** f(-1.3) * mp.cos(f(0.7) * t)]


def wheels(t, w, q, I, h):
    """Three wheels under a PD law whose torque saturates smoothly; h is their momentum."""
    u = [f(0.05) * mp.tanh((-f(0.2) * q[i] * q[3] - f(0.5) * w[i]) / f(0.05)) for i in range(3)]
    return [a - b for a, b in zip(u, cross(w, h))], [-x for x in u]


def orbit(t, w, q, I, s):
    """Gravity gradient and a dipole in a dipole field along an eccentric orbit, whose r and v are states."""
    r, v = s[:3], s[3:]
    size = mp.sqrt(sum(x * x for x in r))
    up = to_body(q, [x / size for x in r])
    tide = [3 * f(0.5) / size ** 3 * x for x in cross(up, times(I, up))]
    north = [f(0.1), f(0), f(1)]
    along = sum(a * b for a, b in zip(north, r)) / size
    field = [(3 * along * a / size - b) / size ** 3 for a, b in zip(r, north)]
    dip = cross(vector(0.05, -0.02, 0.03), to_body(q, field))
    return [a + b for a, b in zip(tide, dip)], v + [-f(0.5) * x / size ** 3 for x in r]


def integral(t, w, q, I, s):
    """A PID law: the integrator starts at rest, at 0."""
    return [-f(0.7) * q[i] * q[3] - f(0.9) * w[i] - f(0.1) * s[i] for i in range(3)], [x * q[3] for x in q[:3]]


STATES = {wheels: [0.01, 0.02, 0.03], orbit: [1.0, 0.2, -0.1, 0.1, 0.5, 0.3], integral: [0.0, 0.0, 0.0]}
LAWS = [heavy, gradient, pd, saturated, drag, spring, dipole, mixture]
BLOCK = [[1.0, 0, 0], [0, 2.0, 0], [0, 0, 2.5]]
FULL = [[1.2, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 1.7]]
START = {"omega": [0.3, 1.0, -0.2], "attitude": [0.1, 0.5, 0.5, 0.7]}
TIMES = [-1.5, 0.75, 3.0, 8.0]


def rate(law, I, inverse):
    def derivative(t, y):
        w, q = y[:3], y[3:7]
        tau, more = law(t, w, q, I, y[7:]) if law in STATES else (law(t, w, q, I), [])
        gyroscopic = cross(times(I, w), w)
        spin = [q[3] * w[i] + c for i, c in enumerate(cross(q[:3], w))]
        change = [sum(inverse[i, j] * (tau[j] + gyroscopic[j]) for j in range(3)) for i in range(3)]
        return change + [x / 2 for x in spin] + [-sum(q[i] * w[i] for i in range(3)) / 2] + more
    return derivative


def extrapolated(g, t, y, H, columns):
    """Gragg's midpoint rule with 2, 4, ..., extrapolated (Hairer, Norsett & Wanner 1993, II.9)."""
    table = []
    for j in range(1, columns + 1):
        n, h = 2 * j, H / (2 * j)
        before, now = y, [a + h * b for a, b in zip(y, g(t, y))]
        for k in range(1, n):
            slope = g(t + k * h, now)
            before, now = now, [a + 2 * h * b for a, b in zip(before, slope)]
        slope = g(t + H, now)
        row = [[(a + b + h * c) / 2 for a, b, c in zip(now, before, slope)]]
        for k in range(1, j):
            part = f(j) ** 2 / f(j - k) ** 2 - 1
            row.append([a + (a - b) / part for a, b in zip(row[-1], table[-1][k - 1])])
        table.append(row)
    return table[-1][-1]


def integrate(g, y, t, end, steps, columns=16):
    H = (end - t) / steps
    for k in range(steps):
        y = extrapolated(g, t + k * H, y, H, columns)
        size = mp.sqrt(sum(x * x for x in y[3:7]))
        y = y[:3] + [x / size for x in y[3:7]] + y[7:]
    return y


def truth(law, I):
    inverse = mp.inverse(mp.matrix([[f(x) for x in row] for row in I]))
    g = rate(law, I, inverse)
    q = [f(x) for x in START["attitude"]]
    size = mp.sqrt(sum(x * x for x in q))
    rows = []
    y, at = None, None
    for t in TIMES:
        if at is None or t * at < 0:
            y, at = [f(x) for x in START["omega"]] + [x / size for x in q] + [f(x) for x in STATES.get(law, [])], f(0)
        span = abs(f(t) - at)
        steps, last, apart = int(mp.ceil(span / f(0.5))), None, f(1)
        while not apart < f(10) ** -26:
            now = integrate(g, y, at, f(t), steps)
            apart = max(abs(a - b) for a, b in zip(last, now)) if last else f(1)
            steps, last = 2 * steps, now
        y, at = last, f(t)
        rows.append([mp.nstr(x, 26) for x in y])
    return rows


if __name__ == "__main__":
    cases = [{"law": law.__name__, "inertia": I, "rows": truth(law, I)}
             for law in [*LAWS, *STATES] for I in (BLOCK, FULL)]
    text = {"source": Path(__file__).name, "start": START, "times": TIMES, "cases": cases}
    Path(__file__).with_name("formula_motion.json").write_text(json.dumps(text, indent=1) + "\n")
