"""The result of `solve`: attitude and angular velocity, their error, and the invariants."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from .. import _core, _export, _wings
from .._attitude.rotation import Rotation
from .._scene.scene import Scene
from .._scene.wanted import MotionAt, MotionOm, Wanted
from .event_hit import EventHit
from .plan import Plan
from .record import describe, describe_columns, describe_drift, list_samples, record, same_record
from .ticks import Ticks

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .._sensitivity.sensitivity import Sensitivity
    from .._wings import Film

Floats = npt.NDArray[np.float64]


# How each part of the core's answer is converted.
_PARTS: dict[str, Callable[[Any], Any]] = {
    **dict.fromkeys(("t", "omega", "attitude", "status", "stats", "error", "error_kind", "asked", "omega_lower",
                     "omega_upper", "attitude_lower", "attitude_upper", "states_lower", "states_upper", "proved_span",
                     "states"), lambda part: part),
    "ticks": lambda part: tuple(Ticks(**one) for one in part),
    "plan": lambda part: part, "events": lambda part: tuple(EventHit(**hit) for hit in part),
}


class Motion(Wanted[MotionOm, MotionAt]):
    """The attitude and the angular velocity of a body at the sample times, in the order of the times.

    Motions are equal if all that a file keeps of them is equal, but for the seconds that they took.

    Attributes
    ----------
    scene : Scene
    options : dict
        The keywords of `solve`, except `plan`, `dense`, `events` and `progress`: ``solve(motion.scene,
        **motion.options)`` repeats the motion.
    t : ndarray, shape (n,)
        The times that were reached [s].
    omega : ndarray, shape (n, 3), or None
        Angular velocity in body axes [rad/s]; None if `want` leaves it out.
    attitude : ndarray, shape (n, 4), or None
        Unit quaternions (x, y, z, w), body to space; None if `want` leaves it out.
    states : dict of ndarray, shape (n,) or (n, k)
        The states of the scene's formulas by name; empty without any.
    status : {"finished", "event", "max_steps", "stopped", "failed", "sliding"}
    message : str
    stats : dict
        What the solution cost: "steps", "rejected" (steps), "derivatives", "events" (calls), "runs" (two or more if the
        error was certified), and "seconds" (wall time in the compiled core). Counts are sums over all runs.
    events : tuple of EventHit
        All zeros of the events, in the order of the integration.
    ticks : tuple of Ticks
        Of each controller: t (n,), measurement and states (dicts of what is measured and kept), command (n, k).
    plan : Plan
    error : float
        The error of all samples, as `accuracy` is defined in `solve`; NaN if not estimated. Errors of the times of
        events are not in it.
    error_kind : {"bounded", "proved", "expected", "estimated", "limit", "not estimated"}
        "bounded": a certificate, or the rounding of a closed form, bounds the error. "proved": the error is a theorem.
        "expected": no certificate was requested. "estimated": a torque of your own jumps within steps, so a coarser run
        estimates the error without bounding it. "limit": the error exceeds the accuracy, because float64 allows no
        smaller one, or because a proof reaches no farther than `proved_span`.
    asked : float
        The requested accuracy, or the requested relative tolerance.
    omega_lower, omega_upper : ndarray, shape (n, 3), or None
        Of a proof: the exact angular velocity of exactly the scene's numbers lies between them [rad/s]. They are
        infinite beyond the reach of the proof.
    attitude_lower, attitude_upper : ndarray, shape (n, 4), or None
        Of a proof: the same for the unit quaternion, of the sign of `attitude`.
    states_lower, states_upper : dict of ndarray, or None
        Of a proof: the same for `states`, by name.
    proved_span : tuple of float, or None
        Of a proof: the times between which every sample has the accuracy [s].
    sensitivity : Sensitivity, or None
        The derivatives of the motion at the scene's times, where `solve` computed them. See docs/sensitivity.md.
    """

    t: Floats
    omega: MotionOm
    attitude: MotionAt
    states: dict[str, Floats]
    status: str
    stats: dict[str, Any]
    plan: Plan
    error: float
    error_kind: str
    asked: float
    omega_lower: Floats | None
    omega_upper: Floats | None
    attitude_lower: Floats | None
    attitude_upper: Floats | None
    states_lower: dict[str, Floats] | None
    states_upper: dict[str, Floats] | None
    proved_span: tuple[float, float] | None
    events: tuple[EventHit, ...]
    ticks: tuple[Ticks, ...]
    sensitivity: Sensitivity = None   # type: ignore[assignment]   # of solve(sensitivity=)

    def __init__(self, scene: Scene[MotionOm, MotionAt], answer: _core.Answer, wishes: dict[str, Any] | None = None,
                 options: dict[str, Any] | None = None) -> None:
        self.scene = scene
        self.options = options or {}
        self._answer: _core.Answer | None = answer
        self._options = wishes or {}   # of the plan

    def __getattr__(self, name: str) -> Any:
        # Each part is copied from the compiled core at first use.
        if name not in _PARTS or self.__dict__.get("_answer") is None:
            raise AttributeError(f"'Motion' object has no attribute {name!r}")
        answer: _core.Answer = self.__dict__["_answer"]
        part = getattr(answer, name)
        value = self.__dict__[name] = (Plan(self.scene, part, self._options, answer.planned) if name == "plan"
                                       else _PARTS[name](part))
        return value

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *_PARTS})

    def _need(self, *names: str) -> None:
        for name in names:
            if getattr(self, name) is None:
                raise _core.InvalidInput(f"motion: must have {name}; solve a scene whose want includes it")

    @property
    def rotation(self) -> Rotation:
        """The attitudes as a Rotation of n."""
        self._need("attitude")
        return Rotation.from_quat(self.attitude)

    @property
    def omega_scale(self) -> float:
        """The largest rate of the start and the samples [rad/s], by which errors of omega are divided."""
        start = math.hypot(*self.scene.omega)
        if self.omega is None or not self.omega.size:
            return start
        largest = float(np.abs(self.omega).max()) or 1.0   # their squares may leave the range of float64
        return max(start, largest * float(np.linalg.norm(self.omega / largest, axis=1).max()))

    def _state_rows(self) -> Floats:
        """The states of formulas and rotors at the samples, shape (n, numbers of all of them)."""
        parts = [np.reshape(self.states[name], (len(self.t), -1)) for name in self.scene.states]
        return np.concatenate(parts, axis=1) if parts else np.empty((len(self.t), 0))

    @property
    def energy(self) -> Floats:
        """Kinetic plus potential energy at the samples, shape (n,) [J].

        It includes the energy of rotors with a motor or friction, and leaves out that inside other rotors.
        """
        self._need("omega", *(["attitude"] if any(t.traits["has_potential"] for t in self.scene.torques) else []))
        assert self.omega is not None
        return _core.energy(self.scene, self.t, self.omega, self.attitude, self._state_rows())

    @property
    def angular_momentum(self) -> Floats:
        """Angular momentum of body and rotors in space axes at the samples, shape (n, 3) [kg m^2/s]."""
        self._need("omega", "attitude")
        assert self.omega is not None and self.attitude is not None
        return _core.angular_momentum(self.scene, self.t, self.omega, self.attitude, self._state_rows())

    @property
    def rotor_speed(self) -> Floats:
        """The speeds of the scene's rotors relative to the body at the samples, shape (n, rotors) [rad/s].

        A free rotor's speed changes with the body's rates. The speed of a held rotor is constant, and 0 outside its
        windows. A rotor without an inertia has NaN.
        """
        self._need("omega")
        assert self.omega is not None
        return _core.rotor_speed(self.scene, self.t, self.omega, self._state_rows())

    @property
    def damper_rates(self) -> Floats:
        """The rates of the scene's damper relative to the body at the samples, shape (n, 3), body axes [rad/s].

        The shape is (n, 0) for a scene without one.
        """
        self._need("omega")
        assert self.omega is not None
        return _core.damper_rates(self.scene, self.omega, self._state_rows())

    @property
    def drift(self) -> dict[str, float]:
        """The largest relative change of each invariant over the samples.

        The keys are "energy", "angular_momentum" (free bodies, with their rotors), "vertical_momentum" (under
        gravity), "jacobi" (gravity gradient: energy less mean motion times L_z), and "energy_rise" (the largest
        rise of the energy of a free body with a damper, or whose rotors have friction and no motor). Quantities that
        the scene does not conserve are left out, and those that need a state that was not requested.
        """
        kept = self.__dict__.get("_drift")
        if kept is None:
            kept = self.__dict__["_drift"] = dict(_core.drift(self.scene, self.t, self.omega, self.attitude,
                                                                 self._state_rows()))
        return kept

    @property
    def success(self) -> bool:
        """True if the run reached its end with the requested accuracy, and every sample is finite.

        If the error is not estimated (``rtol`` or a fixed step), the drift of each invariant is compared with the
        requested tolerance instead.
        """
        if self.status not in ("finished", "event"):
            return False
        if not all(np.isfinite(part).all() for part in (self.omega, self.attitude) if part is not None):
            return False
        return not describe_drift(self) if math.isnan(self.error) else self.error <= self.asked

    @property
    def message(self) -> str:
        """How the run ended and what is known of the error, and of those columns that miss the accuracy."""
        kept: str | None = self.__dict__.get("_message")
        if kept is None:
            assert self._answer is not None
            drifted = describe_drift(self) if self.status in ("finished", "event") and math.isnan(self.error) else ""
            notes = [note for note in (self._answer.message, drifted, describe_columns(self)) if note]
            kept = self.__dict__["_message"] = "; ".join(notes)
        return kept

    def __call__(self, t: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return omega (..., 3) and attitude (..., 4) at any times within the span, from dense output.

        Raises
        ------
        InvalidInput
            Without ``dense=True`` in `solve`, or for a time outside the span that was reached.
        """
        if self._answer is None or not self._answer.has_dense:
            raise _core.InvalidInput("motion(t): must be solved with dense=True")
        omega, attitude = self._answer(t)
        return omega, attitude

    def states_at(self, t: npt.ArrayLike) -> dict[str, Floats]:
        """Return the states of the scene's formulas at any times (n,) within the span, from dense output.

        Raises
        ------
        InvalidInput
            Without ``dense=True`` in `solve`, or for a time outside the span that was reached.
        """
        if self._answer is None or not self._answer.has_dense:
            raise _core.InvalidInput("motion.states_at(t): must be solved with dense=True")
        found: dict[str, Floats] = self._answer.states_at(np.atleast_1d(np.asarray(t, dtype=float)))
        return found

    def plot(self, *parts: str, ax: Axes | None = None, marks: npt.ArrayLike | int | None = None,
             dark: bool = False) -> Figure:
        """Draw the motion.

        Parameters
        ----------
        *parts : str
            The parts to draw; six or four that suit the scene if none is given. "polhode" (Poinsot's ellipsoid),
            "herpolhode", "momentum" (the sphere of the angular momentum in body axes), "axis" (path of body z in
            space), "rates", "attitude", "angles" (z-x-z), "energy", "invariants" (their drift), "commands". If the
            samples are too far apart for a line, curves use dense output, or a second solution of the scene.
        ax : matplotlib Axes, optional
            Where to draw a single part.
        marks : array_like or int, optional
            Times [s] that get a mark on every curve, or how many of them.
        dark : bool
            Draw on a dark background.

        Returns
        -------
        matplotlib.figure.Figure
            A notebook shows it; ``.savefig(path)`` writes it.

        Raises
        ------
        InvalidInput
            For an unknown part, for one whose omega or attitude was not requested, and without matplotlib.
        """
        from .._plot.motion import plot

        return plot(self, *parts, ax=ax, marks=marks, dark=dark)

    def to_pandas(self) -> Any:
        """Return the samples as a pandas.DataFrame with the columns t, omega_x to omega_z, attitude_x to attitude_w."""
        return _export.to_pandas({"t": self.t}, list_samples(self))

    def to_xarray(self) -> Any:
        """Return the samples as an xarray.Dataset with units; ticks of controller i have the dimension ticks_i."""
        made = _export.to_xarray(("time",), {"time": self.t}, list_samples(self), describe(self))
        return _export.add_ticks(made, [(one.t, one._arrays()) for one in self.ticks])

    def save(self, path: str | os.PathLike[str], *, accuracy: float | None = None, epoch: str | None = None,
             **options: Any) -> None:
        """Write the motion with all that repeats it, for `polhode.load`, or its attitudes for other programs.

        Parameters
        ----------
        path : path
            A .npz file or a .zarr folder has the whole motion. Files of attitudes for other programs are .aem (CCSDS),
            .a (STK) and .bc (SPICE). Their knots are chosen so that the reader's interpolation keeps `accuracy`.
        accuracy : float, optional
            For files of attitudes: the largest angle between the file, as its reader interpolates it, and the true
            motion [rad].
        epoch : str, optional
            For files of attitudes: the instant of t = 0, such as "2026-03-01T06:00:00".
        **options
            For files of attitudes: `frame` ("EME2000"), `name` ("BODY"), `time_system` ("UTC"), `method` ("lagrange" or
            "linear") and the odd `degree` (7). See docs/exchange.md.

        Raises
        ------
        InvalidInput
            For another suffix, and for a motion whose attitudes cannot be bounded between knots.

        Notes
        -----
        Of a `Custom` torque the name is stored. The loaded motion has its samples, but its scene cannot be solved again
        before ``scene.replace(torques=...)``.
        """
        found = _export.check_path(path, _wings.list_suffixes())
        if module := _wings.find_suffix(found.suffix):
            _wings.load(module).save(self, found, accuracy=accuracy, epoch=epoch, **options)
            return
        if accuracy is not None or epoch is not None or options:
            first = next(iter({"accuracy": accuracy, "epoch": epoch, **options}))
            raise _core.InvalidInput(f"{first}: belongs to files of attitudes: {', '.join(_wings.list_suffixes())}")
        _export.save(found, *record(self))

    def animate(self, *, body: Any = "box", axis: npt.ArrayLike | None = None, title: str | None = None) -> Film:
        """Make a film of the motion: the body turns, beside the polhode on the ellipsoid of its energy.

        Parameters
        ----------
        body : {"box", "ellipsoid"}, path, (vertices, faces) or a mesh object
            What turns: a uniform box or ellipsoid with the inertia of the scene, or a mesh in body axes.
        axis : array_like, shape (3,), optional
            The body axis whose path in space is drawn. By default the arm of gravity, or the principal axis nearest to
            omega at the start.
        title : str, optional
            By default the name of the scene.

        Returns
        -------
        Film
            A notebook plays it; ``.save(path)`` writes .html, .gif or .mp4.

        Raises
        ------
        InvalidInput
            Without attitudes, for a mesh that cannot be read, and for one of more than 60 000 triangles.
        """
        from .._plot.motion import animate

        return animate(self, body, axis, title)

    def __len__(self) -> int:
        return int(self.t.size)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Motion):
            return NotImplemented
        return self is other or same_record(record(self), record(other))

    def __hash__(self) -> int:
        return hash((self.status, self.t.tobytes()))

    def __repr__(self) -> str:
        drift = ", ".join(f"{name} {value:.1e}" for name, value in self.drift.items())
        cost = f"{self.stats['steps']} steps, " if self.stats["steps"] else ""
        known = "" if math.isnan(self.error) else f"; error {self.error:.1e} ({self.error_kind})"
        return (f"Motion({self.scene.name or 'unnamed'}: {self.t.size} samples by {self.plan.method}, "
                f"{cost}{self.status}{known}{'; drift: ' + drift if drift else ''})")

    def _repr_html_(self) -> str:
        from .._plot.html import of_motion

        return of_motion(self)

    def __getstate__(self) -> dict[str, Any]:
        for name in (*_PARTS, "message"):
            getattr(self, name)
        return {**self.__dict__, "_answer": None}   # dense output is not pickled
