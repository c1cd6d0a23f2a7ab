"""Kinds by the body, its start and its units. Each changes a draft before a torque is added."""

import numpy as np

import polhode as ph

from .kinds import make_table

STARTS, kind = make_table()


@kind
def separatrix(dice, draft):
    """A spin about the middle axis, almost; or a start on the separatrix itself, as far as float64 has it."""
    a, b, c = order = np.argsort(draft.moments)
    low, middle, high = draft.moments[order]
    omega = np.zeros(3)
    if dice.chance(0.6):
        omega[b] = 1.0
        omega += dice.decade(-10, -2) * dice.direction()
    else:
        angle, off = dice.uniform(-3, 3), dice.pick((0.0, dice.decade(-15, -3)))
        omega[b] = np.cos(angle)
        omega[a] = np.sin(angle) * np.sqrt(high * (high - middle))
        omega[c] = np.sin(angle) * np.sqrt(low * (middle - low)) * (1 + off) * dice.sign()
    draft.omega = draft.pace * omega / np.linalg.norm(omega)


@kind
def steady(dice, draft):
    """A spin about a principal axis of the least or the largest moment, or next to it."""
    omega = np.zeros(3)
    omega[dice.pick((np.argmin, np.argmax))(draft.moments)] = dice.sign()
    draft.omega = draft.pace * (omega + dice.pick((0.0, dice.decade(-12, -2))) * dice.direction())


@kind
def needle(dice, draft):
    thin = dice.decade(-8, -2)
    draft.moments = np.array([1.0, 1 - dice.pick((0.0, dice.uniform(0, 1))) * thin, thin])[dice.order()]


@kind
def disc(dice, draft):
    """A flat body: its largest moment is almost the sum of the others."""
    a, b = 1.0, dice.pick((1.0, dice.uniform(0.2, 1)))
    draft.moments = np.array([a, b, (a + b) * (1 - dice.decade(-12, -2))])[dice.order()]


@kind
def symmetric(dice, draft):
    """Two equal moments or three, or almost equal ones."""
    a, c = dice.uniform(0.3, 1), dice.uniform(0.2, 0.55)
    nearly = 1 - dice.pick((0.0, dice.decade(-15, -3)))
    draft.moments = np.array([a, a * nearly, dice.pick((c, a / nearly))])[dice.order()]


@kind
def turned(dice, draft):
    """A full tensor: the body's axes are not the principal ones."""
    draft.axes = ph.Rotation.from_rotvec(dice.decade(-6, 0.4) * dice.direction())


@kind
def scales(dice, draft):
    """Units of inertia and time from 1e-9 to 1e9."""
    draft.inertia_unit, draft.time_unit = dice.decade(-9, 9, 2)


@kind
def rest(dice, draft):
    """A body at rest, or almost."""
    draft.omega = draft.omega * dice.pick((0.0, dice.decade(-12, -3)))
