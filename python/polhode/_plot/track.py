"""What pictures of a motion are drawn from: its samples, and a curve through them that is fine enough for a line."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from .. import torques
from .._batch.broadcast import to_rows
from .._core import InvalidInput, angular_momentum, drift, energy
from .._scene.scene import Scene
from .._solve.motion import Floats, Motion
from .._solve.solve import solve
from .._solve.ticks import Ticks

TURNS = 40        # a curve longer than this many turns is drawn up to there, or it covers itself
FINE = 0.05       # radians of rotation between two points of a curve
MOST = 20_000     # points of a curve
NONE = np.empty((0, 0))


class Curve(NamedTuple):
    """The motion, finely enough to be drawn as a line."""

    t: Floats
    omega: Floats
    attitude: Floats | None
    whole: bool   # whether it is the whole motion
    states: Floats = NONE   # of formulas and rotors, shape (n, numbers of all of them)


class Track(NamedTuple):
    """The samples of a motion, its curve, and where they come from in a few words."""

    scene: Scene
    t: Floats
    omega: Floats
    attitude: Floats | None
    drift: dict[str, float]
    curve: Curve
    source: str
    states: Floats = NONE   # of formulas and rotors
    ticks: tuple[Ticks, ...] = ()   # of controllers

    @property
    def angular_momentum(self) -> Floats:
        """That of body and rotors in space axes at the samples, shape (n, 3) [kg m^2/s]."""
        assert self.attitude is not None
        return np.asarray(angular_momentum(self.scene, self.t, self.omega, self.attitude, self.states))


def to_times(value: Any, name: str) -> Floats:
    """Return times given as one number or an array of them, shape (n,)."""
    times = np.atleast_1d(to_rows(value, name, None))
    if times.ndim != 1 or times.size == 0 or not np.isfinite(times).all():
        raise InvalidInput(f"{name}: must be finite times in one dimension, one at least; got shape {times.shape}")
    return times


def count_points(rate: float, span: float) -> int:
    """Return how many points a line over a span needs."""
    return min(MOST, int(rate * span / FINE) + 2)


def find_curve(motion: Motion[Any, Any]) -> Curve:
    """Return the motion itself where its samples are close enough for a line, else the start of it, solved again."""
    motion._need("omega")
    assert motion.omega is not None
    order = np.argsort(motion.t, kind="stable")
    t, omega, states = motion.t[order], motion.omega[order], motion._state_rows()[order]
    attitude = None if motion.attitude is None else motion.attitude[order]
    rate = float(np.linalg.norm(omega, axis=1).max())
    span = float(t[-1] - t[0])
    if t.size < 2 or rate * span == 0:
        return Curve(t, omega, attitude, True, states)
    drawn = min(span, TURNS * 2 * math.pi / rate)
    gaps = np.diff(t)
    if rate * gaps.max() <= 2 * FINE:
        kept = t <= t[0] + drawn
        return Curve(t[kept], omega[kept], None if attitude is None else attitude[kept], bool(kept.all()),
                     states[kept])
    times = np.linspace(t[0], t[0] + drawn, count_points(rate, drawn))
    if motion._answer is not None and motion._answer.has_dense:
        found = motion.states_at(times)
        rows = [np.reshape(found[name], (times.size, -1)) for name in motion.scene.states]
        return Curve(times, *motion(times), drawn == span, np.concatenate(rows, axis=1) if rows else NONE)
    if motion.status not in ("finished", "event"):
        return Curve(t, omega, attitude, True, states)   # nothing is known beyond what there is
    again = solve(motion.scene.replace(times=times), accuracy=1e-6, body=motion.options.get("body", 0))
    if again.status != "finished" or again.omega is None:
        return Curve(t, omega, attitude, True, states)
    return Curve(times, again.omega, again.attitude, drawn == span, again._state_rows())


def of_motion(motion: Motion[Any, Any]) -> Track:
    """Return what is drawn of a result of `solve`."""
    motion._need("omega")
    if len(motion) == 0:
        raise InvalidInput("plot: the motion holds no samples")
    assert motion.omega is not None
    return Track(motion.scene, motion.t, motion.omega, motion.attitude, motion.drift, find_curve(motion),
                 f"{len(motion)} samples by {motion.plan.method}", motion._state_rows(),
                 motion.ticks)


def of_closed_form(form: Any, scene: Scene, t: Floats) -> Track:
    """Return what is drawn of a closed form at these times."""
    omega, attitude = form.at(t)
    begin, end = float(t.min()), float(t.max())
    rate, span = float(np.linalg.norm(omega, axis=1).max()), end - begin
    drawn = min(span, TURNS * 2 * math.pi / rate) if rate > 0 else span
    times = np.linspace(begin, begin + drawn, max(2, count_points(rate, drawn)))
    fine = form.at(times)
    return Track(scene, t, omega, attitude, dict(drift(scene, t, omega, attitude)),
                 Curve(times, fine[0], fine[1], drawn == span), f"closed form, {form.kind.replace('_', ' ')}"
                 if hasattr(form, "kind") else "closed form")


def compute_momentum(scene: Scene, t: Floats, omega: Floats, states: Floats = NONE) -> Floats:
    """Return the momentum of body and rotors in body axes."""
    identity = np.tile([0.0, 0.0, 0.0, 1.0], (len(t), 1))
    return np.asarray(angular_momentum(scene, np.ascontiguousarray(t), np.ascontiguousarray(omega), identity,
                                       np.ascontiguousarray(states)))


def compute_kinetic(track: Track | Motion) -> Floats:
    """Return the kinetic energy without that inside rotors at the samples [J]."""
    assert track.omega is not None
    return np.asarray(0.5 * np.sum(track.omega * (track.omega @ track.scene.carrier_inertia.matrix), axis=1))


def find_moves(track: Track | Motion) -> dict[str, Floats]:
    """How far energy and momentum are from their start, relative, of those that `drift` says should hold."""
    assert track.omega is not None
    scene, found = track.scene, {}
    kinetic = compute_kinetic(track)
    if "energy" in track.drift:
        total = np.asarray(energy(scene, track.t, track.omega, track.attitude))
        size = max(float(kinetic.max()), float(np.abs(total).max()))
        found["energy"] = np.abs(total - total[0]) / size if size > 0 else total
    if track.attitude is not None and {"angular_momentum", "vertical_momentum"} & set(track.drift):
        momentum = np.asarray(track.angular_momentum)
        size = float(np.linalg.norm(momentum, axis=1).max())
        change = momentum - momentum[0]
        away = np.linalg.norm(change, axis=1) if "angular_momentum" in track.drift else np.abs(change[:, 2])
        name = "angular momentum" if "angular_momentum" in track.drift else "vertical angular momentum"
        found[name] = away / size if size > 0 else away
    if "jacobi" in track.drift:
        (torque,) = (t for t in scene.torques if isinstance(t, torques.GravityGradient))
        total = np.asarray(energy(scene, track.t, track.omega, track.attitude))
        jacobi = total - torque.mean_motion * np.asarray(track.angular_momentum)[:, 2]
        size = max(float(kinetic.max()), float(np.abs(jacobi).max()))
        found["Jacobi's integral"] = np.abs(jacobi - jacobi[0]) / size
    return found
