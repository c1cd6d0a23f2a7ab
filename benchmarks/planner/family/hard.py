"""Kinds that made false bounds once. Each is whole: it takes no further start, times or torque."""

import numpy as np

import polhode as ph

from .kinds import make_table
from .torques import LASTING, rotors, rotors_windows, windows_one, windows_several, windows_touching

HARD, kind = make_table()
WANTS = (("omega",), ("attitude",), ("omega", "attitude"))


def turn_up(up, about):
    """An attitude that takes a body's direction to the vertical and turns by an angle about it."""
    half = np.array([up[1], -up[0], 0.0, 1 + up[2]]) if up[2] > -0.999999 else np.array([0, 1.0, 0, 0])
    lift = ph.Rotation.from_quat(half / np.linalg.norm(half))
    return (ph.Rotation.from_rotvec((0, 0, about)) * lift).as_quat()


@kind
def upright(dice, draft):
    """A heavy body that stands upright or hangs, at rest or almost: exactly so, or as far as float64 has it."""
    arm = np.eye(3)[dice.whole(0, 2)] if dice.chance(0.7) else dice.direction()
    draft.attitude = turn_up(arm * dice.pick((1.0, 1.0, -1.0)), dice.pick((0.0, dice.uniform(-np.pi, np.pi))))
    if dice.chance(0.3):
        lean = ph.Rotation.from_rotvec(dice.decade(-16, -8) * dice.direction())
        draft.attitude = (lean * ph.Rotation.from_quat(draft.attitude)).as_quat()
    slow = dice.pick((dice.direction(), arm, np.eye(3)[dice.whole(0, 2)]))
    draft.omega = draft.pace * dice.decade(-15, -3) * slow * dice.pick((0.0, 1.0, 1.0, 1.0))
    if dice.chance(0.2):
        draft.axes = ph.Rotation.from_rotvec(dice.decade(-6, 0.4) * dice.direction())
    draft.turns, draft.want = dice.decade(-1, 0.3), dice.pick(WANTS)
    draft.grid = dice.pick((-1.0, 1.0)) * draft.grid
    draft.add(ph.torques.Gravity(draft.push * dice.decade(-1, 1), dice.decade(-1, 1) * arm))


@kind
def omega_only(dice, draft):
    """The rates alone, under torques that depend on the attitude; slow at the start, and often a turn about an axis."""
    up = np.eye(3)[dice.whole(0, 2)]
    draft.attitude = dice.pick((dice.attitude(), turn_up(up, dice.uniform(-np.pi, np.pi)),
                                np.roll((0.5 ** 0.5, 0, 0.5 ** 0.5, 0), dice.whole(0, 3))))
    draft.omega = draft.omega * dice.decade(-12, 0)
    draft.turns, draft.want = dice.decade(-0.5, 0.7), ("omega",)
    draft.grid = dice.pick((-1.0, 1.0)) * draft.grid
    along = dice.pick((dice.direction(), up))
    dice.pick((lambda: draft.add(ph.torques.Gravity(draft.push * dice.decade(-1, 0.5), along)),
               lambda: draft.add(ph.torques.Constant(draft.push * dice.decade(-2, 0) * along, "space"))))()


@kind
def needle_heavy(dice, draft):
    """A needle under gravity: its spin about its own axis swings to and fro, fast. Mostly backwards."""
    thin = dice.decade(-8, -1)
    draft.moments = np.array([1.0, 1 - dice.pick((0.0, dice.uniform(0, 1))) * thin, thin])[dice.order()]
    draft.add(ph.torques.Gravity(draft.push * dice.decade(-2, 0), dice.direction()))
    draft.turns = min(draft.turns, 300 * np.sqrt(thin) + 0.5)
    draft.grid = dice.pick((-1.0, -1.0, 1.0)) * draft.grid
    if dice.chance(0.5):
        draft.grid = draft.grid[-1:]


@kind
def next_to_edges(dice, draft):
    """Samples at ends of windows of torques, and one unit in the last place from all ends, on either side."""
    dice.pick((windows_one, windows_several, windows_touching, rotors_windows))(dice, draft)
    draft.late = dice.pick((0.0, dice.sign() * dice.decade(-1, 3)))
    draft.near_edges = True


@kind
def clusters(dice, draft):
    """Groups of times that are a few units in the last place apart, and two times elsewhere."""
    dice.pick(LASTING)(dice, draft)
    groups = [begin * (1 + 2.0 ** -dice.whole(40, 52) * np.arange(dice.whole(2, 6))) for begin in dice.breaks(3, 0.05)]
    draft.grid = np.concatenate([*groups, dice.uniform(0, 1, 2)])


@kind
def two_to_four(dice, draft):
    """Two to four torques at once, some of them within windows, with rotors or without."""
    for make in dice.rng.permutation(np.array(LASTING, dtype=object))[:dice.whole(2, 4)]:
        make(dice, draft)
        if dice.chance(0.3):
            torque, _ = draft.torques.pop()
            draft.add(torque, dice.breaks(2 * dice.whole(1, 2), -0.1, 1.1).reshape(-1, 2))
    if dice.chance(0.3):
        rotors(dice, draft)
