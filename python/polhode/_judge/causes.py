"""What may be wrong with a motion: each cause is a change of the steps, or of what is shown, by few numbers.

A cause has a `push`, by how much it moves the end of each step, and a `show`, by how much the samples differ from the
states. Both are six numbers a sample, in the exact model of the cause; its pattern at first order is their derivative.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any

import numpy as np

from .._core import InertiaTensor, InvalidInput
from . import methods
from .law import Law, extrapolated
from .shooting import Track
from .states import Array, State, angle_vector, conjugate, difference, exponential, multiply, to_body

SPACINGS = (2, 3, 4, 5, 8, 10, 20)


class Scope:
    """The states of a track with what causes are computed from, each once."""

    def __init__(self, track: Track, law: Law | None = None) -> None:
        self.track, self.law = track, law or track.law
        self.t, self.dt = track.steps
        self.starts = track.starts
        self.middle = 0.5 * (track.data.t[0] + track.data.t[-1])
        self.spread = float(track.data.t[-1] - track.data.t[0])
        self.grid = (len(track.index), track.length)
        self.known: dict[Any, Array] = {}  # what several causes share

    @cached_property
    def end(self) -> State:
        """The exact ends of all steps."""
        return self.law.flow(self.t, self.dt, self.starts)

    @cached_property
    def rough(self) -> State:
        """The same by extrapolation, for differences."""
        return extrapolated(self.law.field, self.t, self.dt, self.starts, self.levels)

    @cached_property
    def levels(self) -> int:
        """As many as long steps need for all digits."""
        reach = float(np.max(np.linalg.norm(self.starts[0], axis=1) * np.abs(self.dt), initial=0.0))
        return (4 if reach < 0.15 else 5 if reach < 0.35 else 6) if self.law.free else 4

    def by_field(self, extra: Callable[[Array, Array, Array], Array]) -> Array:
        """Return what one more torque makes of the steps."""
        law = dataclasses.replace(self.law, extra=extra)
        return difference(self.rough, extrapolated(law.field, self.t, self.dt, self.starts, self.levels))

    def rates(self, steps: int) -> list[Array]:
        """Return the exact rates at both ends of all steps, and at the ends of equal parts within."""
        inside = self.shared(steps, lambda: np.array(self.law.rates_inside(self.t, self.dt, self.starts, steps)))
        return [self.starts[0], *inside, self.end[0]]

    def shared(self, key: Any, make: Callable[[], Array]) -> Array:
        """Return what `make` gave first for this key."""
        if key not in self.known:
            self.known[key] = make()
        return self.known[key]

    def samples(self) -> tuple[Array, State]:
        """The times and states of all samples, flat."""
        return self.track.data.t[self.track.index].ravel(), self.track.states

    def shaped(self, rows: Array) -> Array:
        return rows.reshape(*self.grid, 6)


Push = Callable[[Scope, Array], Array]


@dataclasses.dataclass(frozen=True, eq=False)
class Cause:
    """A cause with `count` numbers; `scale` is the step of differences. Integrators have an order and substeps.

    `name` is one of the fixed strings of the codes. A `method` has `push` for its number of substeps, not for a size.
    """

    name: str
    variant: str
    count: int
    scale: float
    push: Push | None = None
    show: Push | None = None
    order: int = 0
    substeps: int = 0
    sample: int = -1

    @property
    def key(self) -> str:
        return f"{self.name} ({self.variant})" if self.variant else self.name


def pattern(cause: Cause, scope: Scope) -> tuple[Array, Array]:
    """Return the derivatives of push (S, M-1, 6, count) and show (S, M, 6, count) by the cause's numbers, at 0."""
    zero = np.zeros(cause.count)
    return slopes(cause, scope, zero)


def slopes(cause: Cause, scope: Scope, at: Array) -> tuple[Array, Array]:
    """Return the derivatives of push and show by the cause's numbers, at some values of them."""
    segments, length = scope.grid
    push = np.zeros((segments, length - 1, 6, cause.count))
    show = np.zeros((segments, length, 6, cause.count))
    if cause.substeps and cause.push:  # proportional, with the substeps given
        push[..., 0] = cause.push(scope, np.array([cause.substeps])).reshape(segments, length - 1, 6)
        return push, show
    for part, function in ((push, cause.push), (show, cause.show)):
        if function is None:
            continue
        here = function(scope, at) if np.any(at) else 0.0
        for k in range(cause.count):
            step = np.zeros(cause.count)
            step[k] = cause.scale
            part[..., k] = ((function(scope, at + step) - here) / cause.scale).reshape(part.shape[:-1])
    return push, show


def _inertia(matrix: Array) -> tuple[Array, Array]:
    principal = InertiaTensor(matrix, physical=False)
    return principal.moments, principal.axes


def changed_tensor(matrix: Array, logs: Array, tilt: Array) -> Array:
    """Return a tensor with moments times e^logs (ascending) and principal axes rotated by a vector in the body."""
    moments, axes = _inertia(matrix)
    if np.any(tilt):
        axes = to_matrix(exponential(tilt)) @ axes
    changed = (axes * (moments * np.exp(logs))) @ axes.T
    return 0.5 * (changed + changed.T)


def to_matrix(quaternion: Array) -> Array:
    """Return the matrix of one quaternion."""
    return to_body(conjugate(quaternion), np.eye(3)).T


def _tensor_push(scope: Scope, c: Array, logs: slice, tilt: slice) -> Array:
    size, angle = np.zeros(3), np.zeros(3)
    size[: len(c[logs])], angle[: len(c[tilt])] = c[logs], c[tilt]
    if np.max(np.abs(size)) > 20:
        return np.full((len(scope.t), 6), np.nan)
    return scope.shared((*size, *angle), lambda: _of_tensor(scope, changed_tensor(scope.law.matrix, size, angle)))


def _of_tensor(scope: Scope, matrix: Array) -> Array:
    try:
        law = dataclasses.replace(scope.law, matrix=matrix)
        return difference(scope.end, law.flow(scope.t, scope.dt, scope.starts))
    except InvalidInput:  # no such body
        return np.full((len(scope.t), 6), np.nan)


def _method(name: str) -> Push:
    def push(scope: Scope, count: Array) -> Array:
        try:
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                done = methods.run(name, scope.law, scope.t, scope.dt, scope.starts, int(count[0]))
        except (InvalidInput, np.linalg.LinAlgError):  # steps that are much too long
            return np.full((len(scope.t), 6), np.nan)
        if not all(np.all(np.isfinite(part)) for part in done):
            return np.full((len(scope.t), 6), np.nan)
        return difference(scope.end, done)

    return push


def _attitude_method(place: float) -> Push:
    def push(scope: Scope, count: Array) -> Array:
        rotated = methods.rotate_by_rates(place, scope.rates(int(count[0])), scope.dt, scope.starts[1])
        return difference(scope.end, (scope.end[0], rotated))

    return push


def _scaled_rates(scope: Scope, c: Array) -> Array:
    """The attitude follows the rates times a factor; by the mean of the exact turn."""
    own = angle_vector(multiply(conjugate(scope.starts[1]), scope.end[1]))
    rotated = multiply(scope.starts[1], exponential(own * (1 + c[0])))
    return difference(scope.end, (scope.end[0], rotated))


def _lag(scope: Scope, c: Array) -> Array:
    t, state = scope.samples()
    out = np.zeros((len(t), 6))
    out[:, :3] = scope.law.flow(t, np.full(len(t), c[0]), state)[0] - state[0]
    return scope.shaped(out)


def _shown_rates(make: Callable[[Array, State, Array], Array]) -> Push:
    def show(scope: Scope, c: Array) -> Array:
        t, state = scope.samples()
        out = np.zeros((len(t), 6))
        out[:, :3] = make(t, state, c)
        return scope.shaped(out)

    return show


def _drifting_attitude(scope: Scope, c: Array) -> Array:
    t, (_, attitude) = scope.samples()
    out = np.zeros((len(t), 6))
    out[:, 3:] = to_body(attitude, (t - scope.middle)[:, None] * c)
    return scope.shaped(out)


def _interpolated(spacing: int) -> Push:
    def show(scope: Scope, c: Array) -> Array:
        track = scope.track
        segments, length = scope.grid
        first = track.index - track.index % spacing
        t, last = track.data.t, first + spacing
        out = np.zeros((segments, length, 6))
        row = np.arange(segments)[:, None]
        left, right = first - track.index[:, :1], last - track.index[:, :1]
        inside = (left >= 0) & (right < length)
        left, right = np.where(inside, left, 0), np.where(inside, right, 0)
        a, b = track.attitude[row, left], track.attitude[row, right]
        span = t[np.where(inside, last, 0)] - t[np.where(inside, first, 0)]
        part = np.where(inside, t[track.index] - t[np.where(inside, first, 0)], 0.0) / np.where(inside, span, 1.0)
        between = angle_vector(multiply(conjugate(a), b).reshape(-1, 4)).reshape(*part.shape, 3)
        made = multiply(a, exponential((part[..., None] * between).reshape(-1, 3)).reshape(*part.shape, 4))
        angles = angle_vector(multiply(conjugate(track.attitude), made).reshape(-1, 4)).reshape(*part.shape, 3)
        out[..., 3:] = np.where(inside[..., None], c[0] * angles, 0.0)
        return out

    return show


def outlier(sample: int) -> Cause:
    """One sample that is off, by any six numbers."""

    def show(scope: Scope, c: Array) -> Array:
        out = np.zeros((*scope.grid, 6))
        out[scope.track.index == sample] = c
        return out

    return Cause("outlier", "", 6, 1.0, show=show, sample=sample)


def catalogue(track: Track, known: bool = True) -> Iterator[Cause]:
    """Give all causes that the measured channels can show. Without a known inertia, those of the law are left out."""
    data, law = track.data, track.law
    span, rate = float(data.t[-1] - data.t[0]), data.scale
    moment = float(np.trace(law.matrix)) / 3
    both = data.has_omega and data.has_attitude
    torque = moment * rate / span
    if known:
        moments = _inertia(law.matrix)[0]
        if law.free and moments[2] - moments[0] > 1e-12 * moments[2] or not law.free:
            logs, tilts = slice(0, 2 if law.free else 3), slice(2 if law.free else 3, None)
            yield Cause(
                "inertia", "moments", 2 if law.free else 3, 1e-5, lambda s, c: _tensor_push(s, c, logs, slice(9, None))
            )
            yield Cause("inertia", "axes", 3, 1e-5, lambda s, c: _tensor_push(s, c, slice(9, None), slice(0, 3)))
            yield Cause(
                "inertia", "moments and axes", 5 if law.free else 6, 1e-5, lambda s, c: _tensor_push(s, c, logs, tilts)
            )
    yield Cause(
        "damping",
        "of the angular momentum",
        1,
        1e-4 / span,
        lambda s, c: s.by_field(lambda t, w, q: -c[0] * w @ s.law.matrix),
    )
    yield Cause("damping", "of the rates", 1, 1e-4 / span, lambda s, c: s.by_field(lambda t, w, q: -c[0] * moment * w))
    yield Cause(
        "torque", "in body axes", 3, 1e-4 * torque, lambda s, c: s.by_field(lambda t, w, q: np.tile(c, (len(w), 1)))
    )
    if data.has_attitude:
        yield Cause(
            "torque",
            "in space axes",
            3,
            1e-4 * torque,
            lambda s, c: s.by_field(
                lambda t, w, q: to_body(q / np.linalg.norm(q, axis=1, keepdims=True), np.tile(c, (len(w), 1)))
            ),
        )
    for name, (_, order) in methods.STEPS.items():
        yield Cause("integrator", name, 1, 1.0, _method(name), order=order, substeps=8 if order == 1 else 2)
    if both:
        for name, (place, order) in methods.ATTITUDES.items():
            yield Cause(
                "kinematics", name, 1, 1.0, _attitude_method(place), order=order, substeps=8 if order == 1 else 2
            )
        yield Cause("kinematics", "factor on the rates", 1, 1e-4, _scaled_rates)
    yield Cause("clock", "", 1, 1e-5, lambda s, c: difference(s.end, s.law.flow(s.t, s.dt * (1 + c[0]), s.starts)))
    if both:
        yield Cause("lag", "", 1, 1e-4 * float(np.median(np.diff(data.t))), show=_lag)
        yield Cause("turning frame", "of the attitude", 3, 1e-4 / span, show=_drifting_attitude)
        yield Cause(
            "misaligned",
            "",
            3,
            1e-5,
            show=_shown_rates(lambda t, s, c: to_body(np.tile(exponential(c), (len(t), 1)), s[0]) - s[0]),
        )
        yield Cause(
            "turning frame",
            "of the rates",
            3,
            1e-4 / span,
            show=_shown_rates(lambda t, s, c: to_body(s[1], np.tile(c, (len(t), 1)))),
        )
    if data.has_omega:
        yield Cause("bias", "", 3, 1e-4 * rate, show=_shown_rates(lambda t, s, c: np.tile(c, (len(t), 1))))
        yield Cause("units of rates", "factor", 1, 1e-5, show=_shown_rates(lambda t, s, c: c[0] * s[0]))
    if data.has_attitude:
        for spacing in SPACINGS:
            if 2 * spacing < track.length:
                yield Cause("interpolated", f"{spacing}", 1, 1.0, show=_interpolated(spacing), substeps=0)
    if (sample := standing_out(track)) is not None:
        yield outlier(sample)


def standing_out(track: Track) -> int | None:
    """Return the sample that differs most from the mean of both neighbours, relative to the others."""
    rest = track.deviation()
    if len(rest) < 8:
        return None
    angles = np.linalg.norm(rest, axis=1)
    bend = np.full(len(rest), 0.0)
    bend[1:-1] = np.linalg.norm(rest[1:-1] - 0.5 * (rest[2:] + rest[:-2]), axis=1)
    bend[0] = np.linalg.norm(rest[0] - 2 * rest[1] + rest[2])
    bend[-1] = np.linalg.norm(rest[-1] - 2 * rest[-2] + rest[-3])
    return int(np.argmax(bend)) if np.any(angles > 0) else None
