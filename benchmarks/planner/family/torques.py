"""Kinds by the torques and rotors that act. Each adds to a draft what makes it that kind, and may turn its start."""

import numpy as np

import polhode as ph

from .custom import Brake, Drag, Magnet, Wheel
from .kinds import make_table

TORQUES, kind = make_table()


def add_weight(dice, draft, ratio, arm=None):
    """Gravity of `ratio` pushes; a heavy body's pace is that of its swings."""
    length = dice.decade(-1, 0.5)
    arm = length * (dice.direction() if arm is None else np.asarray(arm))
    draft.add(ph.torques.Gravity(draft.push * ratio / length, arm))
    draft.pace *= max(1.0, np.sqrt(ratio))


@kind
def free(dice, draft):
    pass


@kind
def heavy_slow(dice, draft):
    add_weight(dice, draft, dice.decade(0.5, 2.5))


@kind
def heavy_fast(dice, draft):
    add_weight(dice, draft, dice.decade(-4, -1))


@kind
def heavy_asleep(dice, draft):
    """A top that spins next to the pole, faster or slower than what keeps it up."""
    a, c = dice.uniform(0.3, 1), dice.uniform(0.1, 0.55)
    # Within the triangle inequality.
    unlike = min(dice.pick((0.0, dice.decade(-6, -0.7))), 0.999 * c / a, 0.999 * (2 - c / a))
    draft.moments = np.array([a, a * (1 - unlike), c])
    draft.attitude = dice.near_vertical(dice.decade(-9, -1))
    draft.omega = draft.pace * (np.array([0, 0, 1.0]) + dice.decade(-9, -2) * dice.direction())
    off = dice.pick((0.0, dice.decade(-6, -2))) * dice.direction()
    add_weight(dice, draft, dice.decade(-1, 0.5) * c * c / (4 * a * draft.moments.max()), np.array([0, 0, 1.0]) + off)


@kind
def heavy_chaotic(dice, draft):
    """A slow start next to the upright saddle."""
    arm = dice.direction()
    axis = np.cross(arm, (0, 0, 1.0))
    sine = np.linalg.norm(axis)
    up = ph.Rotation.from_rotvec(axis / sine * np.arctan2(sine, arm[2]))
    draft.attitude = (ph.Rotation.from_rotvec(dice.decade(-3, 0) * dice.direction()) * up).as_quat()
    draft.omega = draft.omega * dice.decade(-1.5, 0)
    draft.turns = min(draft.turns, 8.0)
    add_weight(dice, draft, dice.decade(-0.3, 0.7), arm)


@kind
def gradient(dice, draft):
    draft.add(ph.torques.GravityGradient(draft.pace * dice.decade(-3, -0.2), dice.uniform(-3, 3)))


@kind
def gradient_two(dice, draft):
    for _ in range(2):
        gradient(dice, draft)


@kind
def gradient_resonance(dice, draft):
    """A spin about the orbit's normal at a multiple of half the orbit's rate, or close to it."""
    ratio = dice.pick((0.5, 1.0, 1.5, 2.0)) * (1 + dice.pick((0.0, dice.decade(-8, -2))))
    draft.attitude = dice.near_vertical(dice.decade(-6, -0.7))
    draft.omega = draft.pace * ratio * np.array([0, 0, 1.0])
    draft.add(ph.torques.GravityGradient(draft.pace, dice.uniform(-3, 3)))


@kind
def constant_body(dice, draft):
    draft.add(ph.torques.Constant(draft.push * dice.decade(-4, 0) * dice.direction()))


@kind
def constant_space(dice, draft):
    draft.add(ph.torques.Constant(draft.push * dice.decade(-4, 0) * dice.direction(), "space"))


@kind
def damping_soft(dice, draft):
    draft.add(ph.torques.Damping(draft.moments * draft.pace * dice.decade(-4, -0.5, 3)))


@kind
def damping_stiff(dice, draft):
    """All axes decay fast; often something else keeps the body turning."""
    draft.turns = min(draft.turns, 3.0)
    draft.add(ph.torques.Damping(draft.moments * draft.pace * dice.decade(0.5, 3, 3)))
    if dice.chance(0.6):
        dice.pick((constant_body, constant_space, heavy_slow, gradient))(dice, draft)


@kind
def damping_one_axis(dice, draft):
    draft.turns = min(draft.turns, 5.0)
    rates = dice.pick((0.0, 1.0)) * dice.decade(-4, -1, 3)
    rates[dice.whole(0, 2)] = dice.decade(0, 3)
    draft.add(ph.torques.Damping(draft.moments * draft.pace * rates))


@kind
def damping_negative(dice, draft):
    """Some axes gain: by a factor of e^4 at most."""
    rates = dice.uniform(0.1, 4, 3) * np.array([-1.0, dice.sign(), dice.sign()])[dice.order()]
    draft.add(ph.torques.Damping(draft.moments / draft.span * rates))


@kind
def damping_skew(dice, draft):
    """A matrix that is not symmetric."""
    root = dice.rng.normal(size=(3, 3))
    twist = np.cross(np.eye(3), dice.direction())
    matrix = root @ root.T / 3 * dice.decade(-3, 0) + twist * dice.decade(-2, 0.7)
    draft.add(ph.torques.Damping(draft.moments.min() * draft.pace * matrix))


@kind
def damping_singular(dice, draft):
    """A matrix of rank 1 or 2."""
    columns = dice.rng.normal(size=(3, dice.whole(1, 2)))
    draft.add(ph.torques.Damping(draft.moments.min() * draft.pace * dice.decade(-3, 0.5) * columns @ columns.T))


LASTING = (heavy_slow, heavy_fast, gradient, constant_body, constant_space, damping_soft, damping_skew)


@kind
def several(dice, draft):
    for make in dice.rng.permutation(np.array(LASTING, dtype=object))[:dice.whole(2, 3)]:
        make(dice, draft)


@kind
def tiny_torque(dice, draft):
    dice.pick((constant_body, constant_space, heavy_fast, gradient, damping_soft))(dice, draft)
    small = dice.decade(-14, -4)
    torque, _ = draft.torques.pop()
    match torque:
        case ph.torques.Constant():
            torque = ph.torques.Constant(small * np.asarray(torque.torque), torque.frame)
        case ph.torques.Gravity():
            torque = ph.torques.Gravity(small * torque.weight, torque.arm)
        case ph.torques.GravityGradient():
            torque = ph.torques.GravityGradient(np.sqrt(small) * torque.mean_motion, torque.phase)
        case ph.torques.Damping():
            torque = ph.torques.Damping(small * np.asarray(torque.matrix))
    draft.add(torque)


def add_during(dice, draft, windows):
    """One lasting torque that acts within windows, in spans."""
    dice.pick(LASTING)(dice, draft)
    torque, _ = draft.torques.pop()
    draft.add(torque, windows)


@kind
def windows_one(dice, draft):
    """One torque, one window, which may begin before the start or end after the last time."""
    add_during(dice, draft, [dice.breaks(2, -0.2, 1.2)])


@kind
def windows_several(dice, draft):
    """One to three torques, one to three windows each, beside a lasting torque or none."""
    for _ in range(dice.whole(1, 3)):
        add_during(dice, draft, dice.breaks(2 * dice.whole(1, 3), -0.1, 1.1).reshape(-1, 2))
    if dice.chance(0.3):
        dice.pick(LASTING)(dice, draft)


@kind
def windows_many(dice, draft):
    add_during(dice, draft, dice.breaks(2 * dice.whole(8, 40)).reshape(-1, 2))


@kind
def windows_touching(dice, draft):
    """Two or three torques that take turns."""
    ends = dice.breaks(dice.whole(3, 7))
    count = dice.whole(2, 3)
    for first in range(count):
        windows = [(a, b) for i, (a, b) in enumerate(zip(ends, ends[1:], strict=False)) if i % count == first]
        if windows:
            add_during(dice, draft, windows)


@kind
def windows_far(dice, draft):
    """Short firings at both ends of a long coast."""
    draft.turns = dice.decade(1.5, 2.8)
    short = dice.uniform(0.2, 2, 2) / draft.turns
    add_during(dice, draft, [(0, short[0]), (1 - short[1], 1)])


@kind
def custom(dice, draft):
    """One or two functions of the user's own, alone or beside a torque of the library."""
    moment, pace = draft.moments.max(), draft.pace
    functions = [Brake(moment * pace * dice.decade(-3, 0.3)),
                 Wheel(tuple(moment * pace * dice.decade(-2, 0.5) * dice.direction())),
                 Drag(moment / pace * dice.decade(-3, -0.3)),
                 Magnet(tuple(draft.push * dice.decade(-3, 0) * dice.direction()), dice.uniform(0, 1),
                        dice.uniform(-1, 1), pace * dice.decade(-2, 0))]
    for i in dice.rng.permutation(len(functions))[:dice.whole(1, 2)]:
        draft.add(ph.torques.Custom(functions[i]))
    if dice.chance(0.4):
        dice.pick((constant_body, gradient, damping_soft))(dice, draft)
    draft.turns = min(draft.turns, 6.0)


@kind
def angular_damping(dice, draft):
    """Damping proportional to the angular momentum; some of it drives the body."""
    draft.add(ph.torques.AngularDamping(dice.decade(-3, 1) / draft.span * dice.pick((1.0, 1.0, -0.3))))


@kind
def pendulum(dice, draft):
    """A heavy body that swings about a horizontal principal axis, with less or more energy than the upright rest."""
    axis, up, arm = np.eye(3)[dice.order()]
    turn = ph.Rotation.from_matrix(np.array([axis, np.cross(up, axis), up]))   # body `up` is vertical
    draft.attitude = (turn * ph.Rotation.from_rotvec(dice.uniform(-np.pi, np.pi) * axis)).as_quat()
    ratio = dice.decade(-2, 1)
    draft.omega = draft.pace * axis * dice.pick((0.0, 1.0, dice.decade(-6, 0)))
    angle = dice.uniform(-np.pi, np.pi)
    add_weight(dice, draft, ratio, np.cos(angle) * up + np.sin(angle) * arm)


@kind
def rotors(dice, draft):
    """One to three rotors at constant relative speeds."""
    for _ in range(dice.whole(1, 3)):
        draft.add_rotor(dice.direction(), momentum=draft.moments.max() * draft.pace * dice.decade(-2, 1))


@kind
def rotors_free(dice, draft):
    """One or two rotors that are free on their bearings."""
    for _ in range(dice.whole(1, 2)):
        draft.add_rotor(dice.pick((dice.direction(), np.eye(3)[dice.whole(0, 2)])), free=True,
                        inertia=draft.moments.min() * dice.decade(-3, -0.7),
                        speed=draft.pace * dice.decade(-1, 2) * dice.sign())


@kind
def rotors_driven(dice, draft):
    """Rotors, and a torque of the library."""
    rotors(dice, draft)
    dice.pick(LASTING)(dice, draft)


@kind
def rotors_windows(dice, draft):
    """Rotors that start and stop; sometimes one that always rotates, or a torque."""
    for _ in range(dice.whole(1, 2)):
        draft.add_rotor(dice.direction(), dice.breaks(2 * dice.whole(1, 4), -0.1, 1.1).reshape(-1, 2),
                        momentum=draft.moments.max() * draft.pace * dice.decade(-2, 0.5))
    if dice.chance(0.3):
        rotors(dice, draft)
    if dice.chance(0.3):
        dice.pick(LASTING)(dice, draft)


@kind
def rotor_critical(dice, draft):
    """A spin about a principal axis with a rotor that makes it almost as stable as unstable (Hughes 1986, ch. 6)."""
    i, j, _ = dice.order()
    axis = np.eye(3)[i]
    draft.omega = draft.pace * (axis + dice.pick((0.0, dice.decade(-12, -2))) * dice.direction())
    critical = (draft.moments[j] - draft.moments[i]) * draft.pace
    draft.add_rotor(axis, momentum=critical * (1 + dice.sign() * dice.decade(-12, -1)))
