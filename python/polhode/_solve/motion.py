"""The answer of a solve: attitude and rates, and the invariants that prove them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.rotation import Rotation
from .._scene.scene import Scene
from .plan import Plan

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = npt.NDArray[np.float64]


class EventHit(NamedTuple):
    """One zero of an event's function."""

    event: int
    t: float
    omega: Floats
    attitude: Floats


# How each part of the core's answer is shown.
_PARTS: dict[str, Callable[[Any], Any]] = {
    **dict.fromkeys(("t", "omega", "attitude", "status", "stats", "error", "error_kind", "asked"), lambda part: part),
    "plan": lambda part: part, "events": lambda part: tuple(EventHit(*hit) for hit in part),
}


class Motion:
    """Where the body points and how fast it spins, at the times asked for, in the order asked for.

    Attributes
    ----------
    scene : Scene
    t : ndarray, shape (n,)
        The times that were reached [s].
    omega : ndarray, shape (n, 3), or None
        Angular velocity in body axes [rad/s]; None when not wanted.
    attitude : ndarray, shape (n, 4), or None
        Unit quaternions (x, y, z, w), body to space; None when not wanted.
    status : {"finished", "event", "max_steps", "stopped", "failed"}
    message : str
    stats : dict
        steps, rejected, derivatives, events, runs, seconds: what it cost; seconds are wall time in the compiled core.
    events : tuple of EventHit
        Every zero that was found, in the order of the integration.
    plan : Plan
    error : float
        Of all samples, as the accuracy is meant; NaN where it is not estimated.
    error_kind : {"bounded", "expected", "limit", "not estimated"}
        "bounded": by the rounding of a closed form, or by a certificate; "expected": no certificate was made; "limit":
        more than was asked, since float64 allows no less.
    asked : float
        The accuracy, or the relative tolerance, that was asked for.
    """

    t: Floats
    omega: Floats | None
    attitude: Floats | None
    status: str
    stats: dict[str, Any]
    plan: Plan
    error: float
    error_kind: str
    asked: float
    events: tuple[EventHit, ...]

    def __init__(self, scene: Scene, answer: _core.Answer, wishes: dict[str, Any] | None = None) -> None:
        self.scene = scene
        self._answer: _core.Answer | None = answer
        self._options = wishes or {}

    def __getattr__(self, name: str) -> Any:
        # Each part crosses from the compiled core when it is first asked for.
        if name not in _PARTS or self.__dict__.get("_answer") is None:
            raise AttributeError(f"'Motion' object has no attribute {name!r}")
        part = getattr(self._answer, name)
        value = self.__dict__[name] = Plan(self.scene, part, self._options) if name == "plan" else _PARTS[name](part)
        return value

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *_PARTS})

    def _need(self, *names: str) -> None:
        for name in names:
            if getattr(self, name) is None:
                raise _core.InvalidInput(f"motion: this needs the {name}: solve a scene whose want holds it")

    @property
    def rotation(self) -> Rotation:
        """The attitudes as a Rotation of n."""
        self._need("attitude")
        return Rotation.from_quat(self.attitude)

    @property
    def energy(self) -> Floats:
        """Kinetic plus potential energy at the samples, shape (n,) [J]."""
        self._need("omega", *(["attitude"] if any(t.traits["has_potential"] for t in self.scene.torques) else []))
        assert self.omega is not None
        return _core.energy(self.scene, self.t, self.omega, self.attitude)

    @property
    def angular_momentum(self) -> Floats:
        """Angular momentum in space axes at the samples, shape (n, 3) [kg m^2/s]."""
        self._need("omega", "attitude")
        assert self.omega is not None and self.attitude is not None
        return _core.angular_momentum(self.scene, self.omega, self.attitude)

    @property
    def drift(self) -> dict[str, float]:
        """How far each invariant that should hold moved over the samples, relative.

        "energy", "angular_momentum" (free bodies), "vertical_momentum" (under gravity), "jacobi" (gravity gradient:
        energy less mean motion times L_z). What does not hold, or cannot be seen in what was wanted, is not there.
        """
        kept = self.__dict__.get("_drift")
        if kept is None:
            kept = self.__dict__["_drift"] = dict(_core.drift(self.scene, self.t, self.omega, self.attitude))
        return kept

    def _moved(self) -> str:
        moved = {name: value for name, value in self.drift.items() if not value <= self.asked}
        if not moved:
            return ""
        name = max(moved, key=lambda key: moved[key])
        return f"{name} moved by {moved[name]:.2g} (relative), more than the {self.asked:.2g} asked"

    @property
    def success(self) -> bool:
        """Whether the end was reached and the accuracy with it.

        Where the error is not estimated (``rtol`` alone, or a fixed step): whether no invariant that should hold moved
        by more than was asked.
        """
        if self.status not in ("finished", "event"):
            return False
        return not self._moved() if math.isnan(self.error) else self.error <= self.asked

    @property
    def message(self) -> str:
        """What happened, in a sentence."""
        kept: str | None = self.__dict__.get("_message")
        if kept is None:
            assert self._answer is not None
            moved = self._moved() if self.status in ("finished", "event") and math.isnan(self.error) else ""
            kept = self.__dict__["_message"] = self._answer.message + (f"; {moved}" if moved else "")
        return kept

    def __call__(self, t: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return omega (..., 3) and attitude (..., 4) at any times within the span, from the continuous extension.

        Raises
        ------
        InvalidInput
            Without ``dense=True`` in `solve`, or for a time outside the span that was reached.
        """
        if self._answer is None or not self._answer.has_dense:
            raise _core.InvalidInput("motion(t): must be solved with dense=True, which keeps the continuous extension")
        omega, attitude = self._answer(t)
        return omega, attitude

    def plot(self, *parts: str) -> Figure:
        """Draw the motion: polhode, herpolhode or the path of the axis, z-x-z angles, and what should not have moved.

        Parameters
        ----------
        *parts : {"polhode", "herpolhode", "axis", "angles", "invariants"}
            What is drawn; without any, what suits the scene. Where the samples are too far apart for a line, curves
            come from the continuous extension, or from solving the scene again.

        Returns
        -------
        matplotlib.figure.Figure
            Shown by notebooks; ``.savefig(path)`` writes it.

        Raises
        ------
        InvalidInput
            For another part, for one whose omega or attitude was not wanted, and without matplotlib.
        """
        from .._plot.motion import plot

        return plot(self, *parts)

    def __len__(self) -> int:
        return int(self.t.size)

    def __repr__(self) -> str:
        drift = ", ".join(f"{name} {value:.1e}" for name, value in self.drift.items())
        cost = f"{self.stats['steps']} steps, " if self.stats["steps"] else ""
        known = "" if math.isnan(self.error) else f"; error {self.error:.1e} ({self.error_kind})"
        return (f"Motion({self.scene.name or 'unnamed'}: {self.t.size} samples by {self.plan.method}, "
                f"{cost}{self.status}{known}{'; drift: ' + drift if drift else ''})")

    def __getstate__(self) -> dict[str, Any]:
        for name in (*_PARTS, "message"):
            getattr(self, name)
        return {**self.__dict__, "_answer": None}   # the continuous extension stays behind: solve again for it
