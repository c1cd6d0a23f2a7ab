"""The answer of a solve: attitude and rates, and the invariants that prove them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core

if TYPE_CHECKING:
    from .attitude import Rotation
    from .scene import Scene

Floats = npt.NDArray[np.float64]


class Plan(NamedTuple):
    """Which model and method were taken, and what was carried along."""

    model: str
    method: str
    state: str


class EventHit(NamedTuple):
    """One zero of an event's function."""

    event: int
    t: float
    omega: Floats
    attitude: Floats


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
        steps, rejected, derivatives, events, seconds: what it cost; seconds are wall time inside the compiled core.
    events : tuple of EventHit
        Every zero that was found, in the order of the integration.
    plan : Plan
    error : float
        Of all samples, NaN while it is not estimated; `error_kind` says how it is known.
    asked : float
        The accuracy, or the relative tolerance, that was asked for.
    """

    def __init__(self, scene: Scene, result: dict[str, Any]) -> None:
        self.scene = scene
        self.t: Floats = result["t"]
        self.omega: Floats | None = result["omega"]
        self.attitude: Floats | None = result["attitude"]
        self.status: str = result["status"]
        self.stats: dict[str, Any] = result["stats"]
        self.plan = Plan(*result["plan"])
        self.error: float = result["error"]
        self.error_kind: str = result["error_kind"]
        self.asked: float = result["asked"]
        self.events = tuple(EventHit(*hit) for hit in result["events"])
        self._message: str = result["message"]
        self._dense = result["dense"]
        self._drift: dict[str, float] | None = None

    def _need(self, *names: str) -> None:
        for name in names:
            if getattr(self, name) is None:
                raise _core.InvalidInput(f"motion: this needs the {name}: solve a scene whose want holds it")

    @property
    def rotation(self) -> Rotation:
        """The attitudes as a Rotation of n."""
        from .attitude import Rotation

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
        if self._drift is None:
            self._drift = dict(_core.drift(self.scene, self.t, self.omega, self.attitude))
        return self._drift

    def _moved(self) -> str:
        moved = {name: value for name, value in self.drift.items() if not value <= self.asked}
        if not moved:
            return ""
        name = max(moved, key=lambda key: moved[key])
        return f"{name} moved by {moved[name]:.2g} (relative), more than the {self.asked:.2g} asked"

    @property
    def success(self) -> bool:
        """False when the end was not reached, or an invariant that should hold moved by more than was asked."""
        return self.status in ("finished", "event") and not self._moved()

    @property
    def message(self) -> str:
        """What happened, in a sentence."""
        moved = self._moved() if self.status in ("finished", "event") else ""
        return f"{self._message}; {moved}" if moved else self._message

    def __call__(self, t: npt.ArrayLike) -> tuple[Floats, Floats]:
        """Return omega (..., 3) and attitude (..., 4) at any times within the span, from the continuous extension.

        Raises
        ------
        InvalidInput
            Without ``dense=True`` in `solve`, or for a time outside the span that was reached.
        """
        if self._dense is None:
            raise _core.InvalidInput("motion(t): must be solved with dense=True, which keeps the continuous extension")
        omega, attitude = self._dense(t)
        return omega, attitude

    def __len__(self) -> int:
        return int(self.t.size)

    def __repr__(self) -> str:
        drift = ", ".join(f"{name} {value:.1e}" for name, value in self.drift.items())
        return (f"Motion({self.scene.name or 'unnamed'}: {self.t.size} samples by {self.plan.method}, "
                f"{self.stats['steps']} steps, {self.status}{'; drift: ' + drift if drift else ''})")

    def __getstate__(self) -> dict[str, Any]:
        state = dict(self.__dict__)
        state["_dense"] = None   # the continuous extension stays behind: solve again for it
        return state
