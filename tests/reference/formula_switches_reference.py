"""Truth of motions under formulas with switches: mpmath, each mode alone, switches located to 34 digits.

The laws are written by hand on mpmath numbers, as are their modes. A step in one mode ends where a guard changes its
sign, found by the secant rule on whole steps. Writes formula_switches.json beside this file.
"""

import json
from multiprocessing import Pool
from pathlib import Path

import mpmath as mp
from formula_motion_reference import BLOCK, FULL, START, TIMES, cross, extrapolated, f, rate, times, to_body, vector

STEP = f(1) / 2


class Clipped:
    """A proportional and differential control whose three torques are limited each."""

    def guards(self, t, w, q):
        u = [-f(0.7) * q[i] * q[3] - f(0.5) * w[i] for i in range(3)]
        return [x - f(0.2) for x in u] + [x + f(0.2) for x in u]

    def torque(self, t, w, q, I, sides):
        def one(i):
            if sides[i] > 0:
                return f(0.2)
            return -f(0.7) * q[i] * q[3] - f(0.5) * w[i] if sides[3 + i] > 0 else -f(0.2)
        return [one(i) for i in range(3)]


class Slowed:
    """Drag by parts, -c |w| w."""

    def guards(self, t, w, q):
        return list(w)

    def torque(self, t, w, q, I, sides):
        return [-f(0.3) * s * x * x for s, x in zip(sides, w)]


class Lit:
    """Light of a sun that goes round, with a shadow."""

    def guards(self, t, w, q):
        return [mp.cos(f(0.7) * t + f(0.3)) + f(0.4)]

    def torque(self, t, w, q, I, sides):
        sun = to_body(q, [mp.cos(f(0.7) * t), mp.sin(f(0.7) * t), f(0)])
        return [f(0.4) * x if sides[0] > 0 else f(0) for x in cross(vector(0.3, 0.2, 0.5), sun)]


class Bang:
    """On and off at full strength, by a line of angle and rate."""

    def guards(self, t, w, q):
        return [q[i] + f(0.5) * w[i] for i in range(3)]

    def torque(self, t, w, q, I, sides):
        return [-f(0.1) * s for s in sides]


class Step:
    """A torque that jumps with a rate, and drag."""

    def guards(self, t, w, q):
        return [w[0] - f(0.2)]

    def torque(self, t, w, q, I, sides):
        return [-f(0.1) * w[0], (-f(0.5) if sides[0] > 0 else f(0.3)) - f(0.1) * w[1], -f(0.1) * w[2]]


class Rubbed:
    """Coulomb friction about two axes of the body, which may hold, and a torque of space."""

    def shares(self, t, w, q, I, sides):
        """Of the loads: -1 or 1, or what keeps the rates of held axes at 0."""
        held = [i for i in range(2) if sides[i] == 0]
        shares = [f(s) for s in sides]
        if not held:
            return shares
        inverse = mp.inverse(mp.matrix([[f(x) for x in row] for row in I]))
        rest = [a + b for a, b in zip(self.drive(t, q), cross(times(I, w), w))]
        rest = [x - LOADS[i] * shares[i] if i < 2 else x for i, x in enumerate(rest)]
        A = mp.matrix([[inverse[i, j] * LOADS[j] for j in held] for i in held])
        b = mp.matrix([sum(inverse[i, j] * rest[j] for j in range(3)) for i in held])
        for i, s in zip(held, mp.lu_solve(A, b)):
            shares[i] = s
        return shares

    def drive(self, t, q):
        return [f(0.3) * x for x in to_body(q, [mp.cos(t), f(0), mp.sin(t)])]

    def guards(self, t, w, q):
        return [w[0], w[1]]

    def torque(self, t, w, q, I, sides):
        shares = self.shares(t, w, q, I, sides)
        return [x - (LOADS[i] * shares[i] if i < 2 else 0) for i, x in enumerate(self.drive(t, q))]


LOADS = vector(0.12, 0.2)
LAWS = [Clipped, Slowed, Lit, Bang, Step, Rubbed]


def margins(law, t, y, I, sides):
    """Numbers that are positive inside the mode."""
    w, q = y[:3], y[3:]
    values = law.guards(t, w, q)
    shares = law.shares(t, w, q, I, sides) if 0 in sides else None
    return [s * v if s != 0 else 1 - abs(shares[i]) for i, (s, v) in enumerate(zip(sides, values))]


def behind(law, t, y, I, sides, i, direction):
    """The mode behind the surface of guard i: the other side, or held if the motion comes back from there."""
    if sides[i] == 0:
        return sides[:i] + [int(mp.sign(law.shares(t, y[:3], y[3:], I, sides)[i]))] + sides[i + 1:]
    other = sides[:i] + [-sides[i]] + sides[i + 1:]
    inverse = mp.inverse(mp.matrix([[f(x) for x in row] for row in I]))
    slope = rate(lambda t, w, q, I: law.torque(t, w, q, I, other), I, inverse)(t, y)
    if isinstance(law, Rubbed) and slope[i] * other[i] * direction < 0:
        return sides[:i] + [0] + sides[i + 1:]
    return other


def integrate(law, I, y, t, end, step, sides, found):
    inverse = mp.inverse(mp.matrix([[f(x) for x in row] for row in I]))
    direction = mp.sign(end - t)
    skip = None   # the guard whose surface the mode has just left
    while t != end:
        g = rate(lambda t, w, q, I: law.torque(t, w, q, I, sides), I, inverse)
        H = direction * min(step, abs(end - t))

        def at(h):
            return extrapolated(g, t, y, h, 16) if h != 0 else y

        new = at(H)
        first, root = None, H
        for i, value in enumerate(margins(law, t + H, new, I, sides)):
            if value > 0:
                continue

            def margin(h):
                return margins(law, t + h, at(h), I, sides)[i]

            a, fa, b, fb = f(0), margin(f(0)), H, value
            if i == skip:   # the first part of the step that is inside
                a = H / 64
                fa = margin(a)
            assert fa > 0, (law, t, i)
            for _ in range(200):   # regula falsi, Illinois
                c = (a * fb - b * fa) / (fb - fa)
                fc = margin(c)
                if abs(fc) < f(10) ** -36 or abs(b - a) < f(10) ** -35:
                    break
                if fc * fb < 0:
                    a, fa = b, fb
                else:
                    fa /= 2
                b, fb = c, fc
            if abs(c) < abs(root):
                first, root = i, c
        y = at(root)
        size = mp.sqrt(sum(x * x for x in y[3:7]))
        y = y[:3] + [x / size for x in y[3:7]]
        t, skip = (end if root == end - t else t + root), None
        if first is not None:
            sides = behind(law, t, y, I, sides, first, direction)
            found.append(t)
            skip = first
            for k, s in enumerate(sides):
                if s == 0:
                    y[k] = f(0)
    return y, sides


def truth(law, I):
    q = [f(x) for x in START["attitude"]]
    size = mp.sqrt(sum(x * x for x in q))
    start = [f(x) for x in START["omega"]] + [x / size for x in q]
    sides = [1 if x > 0 else -1 for x in law.guards(f(0), start[:3], start[3:])]
    runs = []
    for step in (STEP, STEP / 2):
        rows, switches = [], []
        for side in ([t for t in TIMES if t < 0], [t for t in TIMES if t > 0]):
            state, t = (start, sides), f(0)
            for end in side:
                state, t = integrate(law, I, state[0], t, f(end), step, state[1], switches), f(end)
                rows.append(state[0])
        runs.append((rows, switches))
    (rough, rough_switches), (rows, switches) = runs
    apart = max(abs(a - b) for x, y in zip(rough, rows) for a, b in zip(x, y))
    assert len(switches) == len(rough_switches) and apart < f(10) ** -24, (law, apart, switches, rough_switches)
    print(type(law).__name__, I[0][1], mp.nstr(apart, 3), [mp.nstr(t, 8) for t in switches], flush=True)
    return {"law": type(law).__name__, "inertia": I, "rows": [[mp.nstr(x, 25) for x in y] for y in rows],
            "switches": [mp.nstr(t, 25) for t in switches]}


if __name__ == "__main__":
    with Pool() as pool:
        cases = pool.starmap(truth, [(law(), I) for law in LAWS for I in (BLOCK, FULL)], chunksize=1)
    text = {"source": Path(__file__).name, "start": START, "times": TIMES, "cases": cases}
    Path(__file__).with_name("formula_switches.json").write_text(json.dumps(text, indent=1) + "\n")
