"""A motion as an `AttitudeEphemeris` whose interpolation keeps an angle."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import solve
from .._core import InvalidInput
from . import interpolate, knots, times
from .ephemeris import AttitudeEphemeris
from .interpolate import Floats
from .knots import MICRO, Whole

if TYPE_CHECKING:
    from .. import Motion

SHARE = 0.05          # of the angle that the solution may err by
LEAST = 1e-12         # rad; digits of a file and a closed form allow no less
LONGEST = 9e9         # s; float64 has every microsecond of it


def make(motion: Motion, *, accuracy: float | None, epoch: str | None, frame: str = "EME2000", name: str = "BODY",
         time_system: str = "UTC", method: str | None = None, degree: int = 7,
         cut: bool = False) -> AttitudeEphemeris:
    """Return a motion at knots, so that a reader's interpolation errs by at most `accuracy` [rad].

    `cut` is that of `AttitudeEphemeris`; the other keywords are those of `Motion.save`.

    Raises
    ------
    InvalidInput
        For a motion that cannot be solved again, or whose error is not bounded; and for bad values.
    """
    goal, start = _check_accuracy(accuracy), times.parse_epoch(epoch)
    text = {"frame": frame, "name": name, "time_system": time_system}
    for key, value in text.items():
        if not isinstance(value, str) or not value.strip() or not value.isprintable() or not value.isascii():
            raise InvalidInput(f"{key}: must be a word of ASCII characters, got {value!r}")
    method = "lagrange" if method is None else method
    if method not in interpolate.METHODS:
        raise InvalidInput(f"method: must be one of {', '.join(interpolate.METHODS)}, got {method!r}")
    if isinstance(degree, bool) or not isinstance(degree, int) or degree % 2 == 0 or not 1 <= degree <= 15:
        raise InvalidInput(f"degree: must be an odd number from 1 to 15, got {degree!r}")
    degree = 1 if method == "linear" else degree
    _check_motion(motion)
    truth, reader = _Truth(motion, goal), knots.Reader(method, degree, goal * (1 - 2 * SHARE), cut)
    parts: list[tuple[Whole, Floats]] = []
    worst = 0.0
    for begin, end in _segments(motion):
        at, rows, error = knots.place(begin, end, motion.omega_scale, truth, reader)
        parts.append((at, rows))
        worst = max(worst, error)
    ends = np.cumsum([0, *(len(at) for at, _ in parts)]).tolist()
    times.add(start, int(parts[-1][0][-1]))
    return AttitudeEphemeris(np.concatenate([at for at, _ in parts]) / MICRO, np.concatenate([q for _, q in parts]),
                             min(goal, worst + truth.error), start, time_system.strip(), frame.strip(), name.strip(),
                             method, degree, cut, tuple(zip(ends[:-1], ends[1:], strict=True)))


def _check_accuracy(accuracy: object) -> float:
    if isinstance(accuracy, bool) or not isinstance(accuracy, (int, float)) or not LEAST <= accuracy <= 0.1:
        raise InvalidInput(f"accuracy: must be given for this kind of file, an angle from {LEAST} to 0.1 rad, "
                           f"got {accuracy!r}")
    return float(accuracy)


def _check_motion(motion: Motion) -> None:
    scene = motion.scene
    if scene.controllers:
        raise InvalidInput("motion.save: files of attitudes take no scene with controllers: commands jump at ticks")
    if len(motion.t) < 2 or abs(motion.t[-1] - motion.t[0]) < 1e-3:
        raise InvalidInput("motion.save: files of attitudes need a motion of at least two times, a millisecond apart")
    if max(abs(motion.t[0]), abs(motion.t[-1])) > LONGEST:
        raise InvalidInput(f"motion.save: files of attitudes keep microseconds: times must be within {LONGEST:g} s, "
                           f"got {motion.t[-1]!r}")


def _segments(motion: Motion) -> list[tuple[int, int]]:
    """Return the spans between the times at which torques begin or end [microseconds].

    Where two spans meet, both have the microsecond before the edge. What acts in the rest of it is measured too.
    """
    first, last = float(motion.t.min()), float(motion.t.max())
    inner = {piece.begin for piece in motion.plan.pieces} | {piece.end for piece in motion.plan.pieces}
    ends = [math.ceil(round(first * MICRO, 3)),
            *(math.floor(round(edge * MICRO, 3)) for edge in sorted(inner) if first < edge < last),
            math.floor(round(last * MICRO, 3))]
    return [(begin, end) for begin, end in zip(ends[:-1], ends[1:], strict=True) if end > begin]


class _Truth:
    """The attitudes of a motion at any microseconds, and the largest error of them so far."""

    def __init__(self, motion: Motion, goal: float) -> None:
        self.scene = motion.scene
        self.options: dict[str, Any] = {"accuracy": SHARE * goal}
        self.most = SHARE * goal
        self.error = 0.0

    def __call__(self, at: Whole) -> Floats:
        found = solve(self.scene.replace(times=at / MICRO, want=("attitude",)), **self.options)
        if not found.success or len(found.t) < len(at):
            raise InvalidInput(f"motion.save: the motion cannot be solved again at the knots: {found.message}")
        if found.error_kind not in ("bounded", "proved", "limit") or not found.error <= 2 * self.most:
            raise InvalidInput(f"accuracy: must be at least {found.error / self.most * SHARE:.1e} rad for this motion, "
                               f"whose error is {found.error:.1e} ({found.error_kind})")
        self.error = max(self.error, found.error)
        assert found.attitude is not None
        return found.attitude
