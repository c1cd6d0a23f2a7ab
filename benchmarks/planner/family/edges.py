"""Scenes that proofs are judged on: samples within some units in the last place of the ends of windows.

`draw_edges(seed, index)` gives plain numbers. `make_scene` makes the scene.
"""

import math

import numpy as np

import polhode as ph

from .dice import Dice

CLOCKS = ("zero", "any", "far", "far_from_start", "middle", "before", "tiny_span", "fast", "slow", "rest")
SHIFTS = (-2, -1, 0, 1, 2)   # of samples from edges, in units in the last place
TORQUES = ("body", "space", "gravity", "damping", "angular_damping", "gradient")


def draw_edges(seed, index):
    """The numbers of a scene; the clocks take turns."""
    clock, dice = CLOCKS[index % len(CLOCKS)], Dice(seed, "edges", index)
    pace = {"fast": dice.decade(6, 12), "slow": dice.decade(-12, -6), "far_from_start": dice.decade(-8.5, -7.5)}.get(
        clock, dice.decade(-1, 1))
    span = dice.decade(-0.7, 0.6) / pace
    t0 = {"zero": 0.0, "far": dice.sign() * 1e8, "middle": 0.5 * span, "rest": 0.0, "tiny_span": 0.0,
          "far_from_start": 0.0}.get(clock, dice.sign() * dice.decade(-2, 2) / pace)
    if clock == "tiny_span":
        span = dice.decade(-300, -20)
    if clock == "far_from_start":
        span = dice.decade(7.5, 8)
    begin = t0 - span if clock in ("before", "middle") else t0
    end = t0 if clock == "before" else t0 + span
    draft = Draft(dice, pace, begin, end)
    omega = pace * dice.direction()
    if clock == "rest":
        omega, t0 = 0 * omega, 0.0
    torques = [draft.torque() for _ in range(dice.whole(0, 2))]
    rotors = [draft.rotor() for _ in range(dice.whole(0 if torques else 1, 2))]
    if clock == "rest":
        torques, rotors = [draft.windowed(draft.constant("body"))], []
    edges = {e for one in (*torques, *rotors) for window in one.get("windows", ()) for e in window}
    times = {begin, end, *dice.uniform(begin, end, 2).tolist()}
    for edge in edges:
        times |= {shift(edge, count) for count in SHIFTS}
        times |= {edge + dice.sign() * dice.decade(-16, -4) * abs(end - begin) for _ in range(2)}
    low, high = min(begin, end), max(begin, end)
    if clock not in ("middle", "before"):
        times = {t for t in times if t >= t0}
    times = sorted(t for t in times if low - span <= t <= high + span)
    return {"clock": clock, "inertia": draft.inertia.tolist(), "omega": omega.tolist(),
            "attitude": dice.attitude().tolist(), "t0": float(t0), "times": times, "torques": torques,
            "rotors": rotors, "pace": math.frexp(pace)[1], "accuracy": float(dice.decade(-12, -5))}


def shift(t, count):
    """The float64 number some units in the last place away."""
    for _ in range(abs(count)):
        t = math.nextafter(t, math.copysign(math.inf, count))
    return t


class Draft:
    """Torques and rotors for a body and a span."""

    def __init__(self, dice, pace, begin, end):
        self.dice, self.pace, self.begin, self.end = dice, pace, begin, end
        moments = np.diag(dice.box())
        self.size = dice.decade(-9, 9)
        if dice.chance(0.4):
            turn = ph.Rotation.from_quat(dice.attitude()).as_matrix()
            moments = turn @ moments @ turn.T
            moments = 0.5 * (moments + moments.T)
        self.inertia = self.size * moments

    def window(self, low=0.0):
        first, last = self.dice.breaks(2, low)
        width = self.end - self.begin
        begin, end = self.begin + first * width, self.begin + last * width
        return [float(begin), float(end) if self.dice.chance(0.6) and end > begin else float(self.end + width)]

    def windowed(self, one):
        return {**one, "windows": [self.window()]}

    def constant(self, frame):
        torque = self.dice.decade(-1, 0.3) * self.size * self.pace ** 2 * self.dice.direction()
        return {"kind": frame, "torque": torque.tolist()}

    def torque(self):
        dice, size, pace = self.dice, self.size, self.pace
        kind = dice.pick(TORQUES)
        if kind in ("body", "space"):
            one = self.constant(kind)
        elif kind == "gravity":
            one = {"kind": kind, "weight": float(size * pace ** 2), "arm": dice.direction().tolist()}
        elif kind == "damping":
            one = {"kind": kind, "matrix": np.diag(0.3 * size * pace * dice.uniform(0.1, 1, 3)).tolist()}
        elif kind == "angular_damping":
            one = {"kind": kind, "rate": float(0.3 * pace * dice.uniform(0.1, 1))}
        else:
            one = {"kind": kind, "mean_motion": float(pace * dice.uniform(0.2, 1)), "phase": float(dice.uniform(-3, 3))}
        return self.windowed(one) if dice.chance(0.8) else one

    def spin(self):
        """A rotor without windows."""
        dice = self.dice
        axis = dice.pick(([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, -2.0, 2.0]))
        momentum = float(self.size * self.pace * dice.decade(-1, 0.3))
        if dice.chance(0.5):
            return {"axis": axis, "momentum": momentum}
        return {"axis": axis, "inertia": float(1e-2 * self.size), "speed": momentum / float(1e-2 * self.size)}

    def rotor(self):
        return self.windowed(self.spin()) if self.dice.chance(0.8) else self.spin()


def make_torque(numbers):
    kind, types = numbers["kind"], ph.torques
    torque = {"body": lambda: types.Constant(numbers["torque"]),
              "space": lambda: types.Constant(numbers["torque"], "space"),
              "gravity": lambda: types.Gravity(numbers["weight"], numbers["arm"]),
              "damping": lambda: types.Damping(numbers["matrix"]),
              "angular_damping": lambda: types.AngularDamping(numbers["rate"]),
              "gradient": lambda: types.GravityGradient(numbers["mean_motion"], numbers["phase"])}[kind]()
    return types.During(torque, numbers["windows"]) if "windows" in numbers else torque


def make_rotor(numbers):
    options = {key: numbers[key] for key in ("momentum", "inertia", "speed", "free") if key in numbers}
    return ph.Rotor(numbers["axis"], **options, **({"during": numbers["windows"]} if "windows" in numbers else {}))


def make_scene(numbers):
    """The scene of some plain numbers."""
    matrix = np.array(numbers["inertia"])
    diagonal = np.array_equal(matrix, np.diag(np.diag(matrix)))
    return ph.Scene(inertia=np.diag(matrix) if diagonal else matrix, omega=numbers["omega"],
                    attitude=numbers["attitude"], torques=[make_torque(one) for one in numbers["torques"]],
                    rotors=[make_rotor(one) for one in numbers["rotors"]], times=numbers["times"], t0=numbers["t0"])
