"""A ball that a torque or a rotor changes about z within windows, with samples next to their ends, in exact numbers."""

import math
from fractions import Fraction

import polhode as ph

# The start, the first and the last time.
SPANS = {"forward": (0.0, 0.0, 3.0), "backward": (3.0, 0.0, 3.0), "middle": (1.5, 0.0, 3.0),
         "negative": (-9.0, -12.0, -6.0), "far": (1e8, 1e8, 1e8 + 3.0), "farther": (1e9, 1e9, 1e9 + 3.0),
         "million": (0.0, 0.0, 1e6), "long": (0.0, 0.0, 1e8), "tiny": (0.0, 0.0, 1e-60), "least": (0.0, 0.0, 1e-300)}
# Windows in parts of the span.
WINDOWS = {"one": [(0.3, 0.6)], "touching": [(0.2, 0.4), (0.4, 0.7)], "whole": [(0.0, 1.0)]}
KINDS = ("torque", "rotor", "formula")


def shift(t, count):
    """The float64 number some units in the last place away."""
    for _ in range(abs(count)):
        t = math.nextafter(t, math.copysign(math.inf, count))
    return t


class Ball:
    """The scene and its exact motion, as fractions. Each window has a torque or a rotor of its own."""

    def __init__(self, kind, name, last_at_edge=False, windows="one", **changes):
        self.t0, begin, end = SPANS[name]
        self.kind, span = kind, end - begin
        self.windows = [tuple(end if part == 1 else begin + part * span for part in one) for one in WINDOWS[windows]]
        edges = sorted({edge for window in self.windows for edge in window})
        times = {begin, end, *(shift(edge, count) for edge in edges if edge for count in (-2, -1, 0, 1, 2))}
        self.times = sorted(t for t in times if begin <= t <= end and (not last_at_edge or t <= edges[-1]))
        start = 1.5 / span if span > 1e-100 else 1.0   # a proof steps through some radians
        size = 2 * start if kind == "rotor" else (1e3 if span > 1e-100 else 1e-3) * start / span
        self.start, self.size = Fraction(start), Fraction(size)
        law = ph.torques.Constant((0, 0, size))
        if kind == "formula":
            law = ph.torques.Formula(text="[0, 0, k]", k=size, recognise=False)
        acting = [ph.Rotor((0, 0, 1), momentum=size, during=[window]) if kind == "rotor" else
                  ph.torques.During(law, [window]) for window in self.windows]
        self.group = "rotors" if kind == "rotor" else "torques"
        self.scene = ph.Scene(inertia=(1, 1, 1), omega=(0, 0, start), t0=self.t0, times=self.times,
                              **{self.group: acting}, **changes)

    def act(self, window, t):
        """The time for which a torque has acted; of a rotor whether it rotates, negative."""
        low, high = window
        if self.kind == "rotor":
            return -int(low <= t < high)
        return min(max(Fraction(t), Fraction(low)), Fraction(high)) - Fraction(low)

    def act_twice(self, window, t):
        """The integral of `act`."""
        low, high = map(Fraction, window)
        length = min(max(Fraction(t), low), high) - low
        return -length if self.kind == "rotor" else length**2 / 2 + length * max(Fraction(t) - high, 0)

    def changes(self, window):
        """The derivatives of the rates and of the angles by the size of a torque or a momentum."""
        first, twice = self.act(window, self.t0), self.act_twice(window, self.t0)
        return [(self.act(window, t) - first, self.act_twice(window, t) - twice - first * self.since(t))
                for t in self.times]

    def since(self, t):
        return Fraction(t) - Fraction(self.t0)

    def rates(self):
        """The exact rates about z at the times."""
        return [self.start + self.size * sum(rate for rate, _ in rows)
                for rows in zip(*map(self.changes, self.windows), strict=True)]

    def angles(self):
        """The exact angles about z at the times."""
        return [self.start * self.since(t) + self.size * sum(angle for _, angle in rows)
                for t, *rows in zip(self.times, *map(self.changes, self.windows), strict=True)]

    def columns(self):
        """The exact derivatives of the rate and of the angle at each time by name. An edge that is a sample moves to
        earlier times: the sample lies behind it. Edges at the start have zeros."""
        number = {"torque": "torque_z", "formula": "k", "rotor": "momentum"}[self.kind]
        ends = "during" if self.kind == "rotor" else "windows"
        found = {"omega_z": [(1, self.since(t)) for t in self.times]}
        for i, window in enumerate(self.windows):
            found[f"{self.group}.{i}.{number}"] = self.changes(window)
            for end, sign, edge in zip(("begin", "end"), (-1, 1), window, strict=True):
                passed = [sign * self.size * (int(t >= edge) - int(self.t0 >= edge)) if edge != self.t0 else 0
                          for t in self.times]
                found[f"{self.group}.{i}.{ends}_0_{end}"] = [
                    (0, -one) if self.kind == "rotor" else (one, one * (Fraction(t) - Fraction(edge)))
                    for one, t in zip(passed, self.times, strict=True)]
        return found

    def groups(self):
        """The names to differentiate by, for all of these columns."""
        names = {"torque": ("torque", "windows"), "formula": ("k", "windows"), "rotor": ("momentum", "during")}
        return ["omega", *(f"{self.group}.{i}.{name}" for i in range(len(self.windows)) for name in names[self.kind])]
