"""Knots whose interpolation keeps an angle: even ones, or uneven ones where these are a third fewer.

An interpolation of degree d errs by h^(d + 1) times a derivative of the attitude. The error is measured between the
knots, and the spacing follows from it. So no derivative is needed.
"""

from __future__ import annotations

import contextlib
import dataclasses
import math
from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from .._core import InvalidInput
from . import interpolate
from .interpolate import Floats

Whole = npt.NDArray[np.int64]
Truth = Callable[[Whole], Floats]   # attitudes at microseconds after the epoch, ascending

MICRO = 1_000_000                  # a reader may keep no more of a time
MOST = 3_000_000                   # knots of a segment; a file of 300 MB
INSIDE = (0.25, 0.5, 0.75)         # where an interval is measured, and
ENDS = (0.08, 0.15, 0.25, 0.36, 0.5, 0.64, 0.75, 0.85, 0.92)   # where those next to the ends of a segment are
BETWEEN = 1.15                     # the largest error between those points over the largest at them
AIM = 0.8                          # of the goal, so that one more round is seldom needed
ROUNDS = 14


@dataclasses.dataclass(frozen=True)
class Reader:
    """How a file is interpolated, and the largest angle that is allowed [rad]; names as in `AttitudeEphemeris`."""

    method: str
    degree: int
    goal: float
    cut: bool = False

    def errors(self, t: Floats, rows: Floats, at: Floats, expected: Floats) -> Floats:
        """Return the angles between what a reader finds and the attitudes that are expected [rad]."""
        found = [interpolate.lagrange(t, rows, at, self.degree, self.cut)]
        if self.method == "linear":   # readers differ
            found.append(interpolate.slerp(t, rows, at))
        return np.asarray(np.max([interpolate.angle_between(each, expected) for each in found], axis=0))


def place(begin: int, end: int, rate: float, truth: Truth, reader: Reader) -> tuple[Whole, Floats, float]:
    """Return the knots of a segment, the attitudes there, and the largest angle of their interpolation [rad].

    Parameters
    ----------
    begin, end : int
        The ends of the segment [microseconds].
    rate : float
        The largest rate [rad/s].
    truth : callable
    reader : Reader

    Raises
    ------
    InvalidInput
        Where more than `MOST` knots are needed, or two in a microsecond.
    """
    start = _even(begin, end, max(interpolate.reaches((end - begin) / MICRO, rate), reader.degree))
    even = _search(truth, dataclasses.replace(reader, cut=False), start, _respace)
    share = _share(even[3], reader)
    if reader.cut and reader.degree > 1:   # a lower degree at the ends allows no even knots
        return _search(truth, reader, _spread(even[0], share, reader), _redistribute)[:3]
    if share.sum() < 2 / 3 * len(even[0]):
        with contextlib.suppress(InvalidInput):
            uneven = _search(truth, reader, _spread(even[0], share, reader), _redistribute)
            if len(uneven[0]) < 2 / 3 * len(even[0]):
                return uneven[:3]
    return even[:3]


Found = tuple[Whole, Floats, float, Floats]   # knots, attitudes, the largest angle, and that of each interval


def _even(begin: int, end: int, intervals: int) -> Whole:
    """Return knots at equal distances, on whole microseconds."""
    count = min(intervals, end - begin)
    steps = np.rint(np.linspace(0.0, float(end - begin), count + 1)).astype(np.int64)
    return np.unique(begin + steps)


def _search(truth: Truth, reader: Reader, knots: Whole, respace: Callable[[Whole, Floats, Reader], Whole]) -> Found:
    best: Found | None = None
    for _ in range(ROUNDS):
        rows, errors = measure(knots, truth, reader)
        worst = float(errors.max())
        if worst <= reader.goal and (best is None or len(knots) < len(best[0])):
            best = knots, rows, worst, errors
        if worst <= reader.goal and (worst >= reader.goal / 2 or len(knots) <= reader.degree + 1):
            break
        wanted = respace(knots, errors, reader)
        if best is not None and len(wanted) >= 0.97 * len(best[0]):
            break
        if len(wanted) > MOST or np.array_equal(wanted, knots):
            break
        knots = wanted
    if best is None:
        raise InvalidInput(f"accuracy: needs more than {MOST} knots, or two of them within a microsecond, between "
                           f"{int(knots[0]) / MICRO!r} and {int(knots[-1]) / MICRO!r} s")
    return best


def _respace(knots: Whole, errors: Floats, reader: Reader) -> Whole:
    """Return even knots whose largest error is a little below the goal."""
    factor = (float(errors.max()) / (AIM * reader.goal)) ** (1 / (reader.degree + 1))
    intervals = max(reader.degree, math.ceil((len(knots) - 1) * min(max(factor, 0.1), 4.0)))
    if errors.max() > reader.goal:
        intervals = max(intervals, len(knots))   # at least one more
    return _even(int(knots[0]), int(knots[-1]), intervals)


def _redistribute(knots: Whole, errors: Floats, reader: Reader) -> Whole:
    """Return knots so that the errors of their intervals are alike, and a little below the goal."""
    return _spread(knots, _share(errors, reader), reader)


def _share(errors: Floats, reader: Reader) -> Floats:
    """Return how many intervals each interval should become, as the largest of those next to it."""
    share = (np.maximum(errors, 1e-16) / (AIM * reader.goal)) ** (1 / (reader.degree + 1))
    half = (reader.degree + 1) // 2
    near = np.pad(share, half, mode="edge")
    smooth = np.lib.stride_tricks.sliding_window_view(near, 2 * half + 1).max(axis=1)
    return np.asarray(np.minimum(smooth, 4.0))


def _spread(knots: Whole, share: Floats, reader: Reader) -> Whole:
    """Return knots at equal shares."""
    total = np.concatenate([[0.0], np.cumsum(share)])
    intervals = max(reader.degree, math.ceil(total[-1]))
    at = np.interp(np.linspace(0.0, total[-1], intervals + 1), total, (knots - knots[0]).astype(float))
    return np.unique(knots[0] + np.rint(at).astype(np.int64))


def measure(knots: Whole, truth: Truth, reader: Reader) -> tuple[Floats, Floats]:
    """Return the attitudes at the knots, and the largest angle within each interval [rad], shape (n - 1,)."""
    widths = np.diff(knots)
    near = min(reader.degree, len(widths))
    ends = np.unique([*range(near), *range(len(widths) - near, len(widths))])
    interval = np.concatenate([np.arange(len(widths))] * len(INSIDE) + [ends] * len(ENDS))
    shares = np.repeat([*INSIDE, *ENDS], [len(widths)] * len(INSIDE) + [len(ends)] * len(ENDS))
    checks = knots[interval] + np.rint(shares * widths[interval]).astype(np.int64)
    both, back = np.unique(np.concatenate([knots, checks]), return_inverse=True)
    exact = truth(both)[back]
    rows = np.round(interpolate.make_continuous(exact[:len(knots)]), 16)   # the digits of a file
    found = reader.errors((knots - knots[0]) / MICRO, rows, (checks - knots[0]) / MICRO, exact[len(knots):])
    errors = np.zeros(len(widths))
    np.maximum.at(errors, interval, found)
    return rows, errors * BETWEEN
