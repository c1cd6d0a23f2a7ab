"""Kinds by what is asked for, and when."""

import numpy as np

from .kinds import make_table

TIMES, kind = make_table()


@kind
def one_to_three(dice, draft):
    draft.grid = dice.uniform(0, 1, dice.whole(1, 3))


@kind
def close(dice, draft):
    """Times that are close together, at the end of the span or at its start."""
    step = dice.decade(-9, -4)
    draft.grid = dice.pick((0.0, dice.uniform(0.3, 1))) + step * np.arange(1, dice.whole(2, 12))


@kind
def gaps(dice, draft):
    """A few dense groups with nothing between them."""
    groups = [begin + dice.decade(-3, -1.5) * np.linspace(0, 1, dice.whole(2, 12)) for begin in dice.breaks(3)]
    draft.grid = np.concatenate(groups)


@kind
def long(dice, draft):
    draft.turns = dice.decade(1.5, 2.5)


@kind
def late(dice, draft):
    """A start far from 0, on either side."""
    draft.late = dice.sign() * dice.decade(1, 6)


@kind
def backward(dice, draft):
    """Times before the start, alone or beside later ones, in any order."""
    draft.grid = dice.pick((-draft.grid, draft.grid - dice.uniform(0, 1)))
    if dice.chance(0.3):
        draft.grid = dice.rng.permutation(draft.grid)


@kind
def omega_alone(dice, draft):
    draft.want = ("omega",)


@kind
def attitude_alone(dice, draft):
    draft.want = ("attitude",)
