"""Scenes: a body with its rotors, its start, its torques, and the requested samples."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, overload

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import to_items
from .._keywords import checked, wrong
from .._orbit.sunlight import resolve
from .wanted import At, AttitudeAlone, Om, OmegaAlone, Parts, Wanted

if TYPE_CHECKING:
    import pathlib
    from typing import Self, Unpack

    from .wanted import Floats


class Scene(_core.Scene, Wanted[Om, At]):
    """A body with its rotors, its start, its torques, and the sample times.

    Parameters
    ----------
    inertia : InertiaTensor, Changing, or array_like of shape (3,) or (3, 3)
        About the centre of mass, or about the pivot of a body with one [kg m^2]. Three numbers are principal moments
        about the body axes, in any order. Rotors are part of the body, locked.
    omega : array_like, shape (3,)
        Angular velocity in body axes at `t0` [rad/s].
    attitude : array_like, shape (4,), or Rotation
        Unit quaternion (x, y, z, w) that takes body to space components, at `t0`. Default: the identity.
    torques : iterable of torques, optional
        See `polhode.torques`. Several torques add up.
    times : array_like, shape (n,)
        Sample times [s], in any order, before or after `t0`.
    want : iterable of {"omega", "attitude"}
        The quantities to return. The attitude is computed only if the caller or a torque needs it.
    t0 : float
        Start time [s].
    name : str
        Name in tables and charts.
    rotors : iterable of Rotor, optional
        Wheels in the body, in any number. See `Rotor`.
    damper : Damper, optional
        A viscous slug in the body. See `Damper`.
    momentum : Changing, optional
        Angular momentum of parts inside, relative to the body axes [kg m^2/s].
    leaving : bool
        Of an inertia that changes: matter leaves at rest relative to the body, and takes its momentum along. Else parts
        of the body move, and its angular momentum stays.
    controllers : iterable of Controller, optional
        Programs that sample the motion and command torques. See `Controller`.

    Raises
    ------
    InvalidInput
        For bad input, with the parameter and the requirement.
    """

    __slots__ = ("_controllers", "_torques")
    _torques: tuple[Any, ...]
    _controllers: tuple[Any, ...]

    @overload
    def __init__(self: Scene[Floats, None], *, want: OmegaAlone, **parts: Unpack[Parts]) -> None: ...

    @overload
    def __init__(self: Scene[None, Floats], *, want: AttitudeAlone, **parts: Unpack[Parts]) -> None: ...

    @overload
    def __init__(self: Scene[Floats, Floats], *, want: Iterable[str] = ..., **parts: Unpack[Parts]) -> None: ...

    @checked
    def __init__(
        self,
        *,
        inertia: Any,
        omega: npt.ArrayLike,
        attitude: Any = (0.0, 0.0, 0.0, 1.0),
        torques: Iterable[Any] | Any = (),
        times: npt.ArrayLike,
        want: Iterable[str] = ("omega", "attitude"),
        t0: float = 0.0,
        name: str = "",
        rotors: Iterable[_core.Rotor] | _core.Rotor = (),
        damper: _core.Damper | None = None,
        momentum: _core.Changing | None = None,
        leaving: bool = False,
        controllers: Iterable[Any] | Any = (),
    ) -> None:
        kept = to_items(torques, "scene.torques", "torques") if isinstance(torques, Iterable) else (torques,)
        if not isinstance(rotors, Iterable):
            rotors = (rotors,)
        rotors = to_items(rotors, "scene.rotors", "rotors")
        if not isinstance(controllers, Iterable):
            controllers = (controllers,)
        clocks = to_items(controllers, "scene.controllers", "controllers")
        acting = resolve(kept, times, t0)
        super().__init__(inertia, omega, attitude, acting, times, want, t0, name, rotors, damper, momentum,
                         bool(leaving), clocks)
        self._torques = kept   # the compiled scene holds plain pointers to their functions
        self._controllers = clocks

    @property
    def torques(self) -> tuple[Any, ...]:
        """The torques, as they were given."""
        return self._torques

    @property
    def controllers(self) -> tuple[Any, ...]:
        """The controllers, as they were given."""
        return self._controllers

    @classmethod
    def load(cls, source: str | os.PathLike[str]) -> Scene[Floats, Floats]:
        """Read a scene from a TOML file, or a scene of polhode by its name, such as "S1".

        Raises
        ------
        InvalidInput
            For a file that is missing or not TOML, and for a key that is unknown, missing or wrong, with its name.
        """
        from .files import load_scene

        return load_scene(source)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the scene to a TOML file, which `Scene.load` reads back to the same bits.

        Raises
        ------
        InvalidInput
            For a torque that is a Python function (a `Formula` can be written), and for another suffix than .toml.
        """
        from .files import save_scene

        save_scene(self, path)

    def show_url(self, page: str = "playground.html") -> str:
        """Return the address of the scene on the playground, to be opened in a browser.

        Parameters
        ----------
        page : str
            Where the page is: a file, or the address of a copy of the site with the page's name.

        Raises
        ------
        InvalidInput
            For a scene that the page has no fields for, with the reason. See docs/playground.md.
        """
        from .playground import show_url

        return show_url(self, page)

    def _parts(self) -> dict[str, Any]:
        return {
            "inertia": self.inertia if self.changing is None else self.changing,
            "omega": self.omega,
            "attitude": self.attitude,
            "torques": self.torques,
            "times": np.array(self.times),
            "want": self.want,
            "t0": self.t0,
            "name": self.name,
            "rotors": self.rotors,
            "damper": self.damper,
            "momentum": self.momentum,
            "leaving": self.leaving,
            "controllers": self.controllers,
        }

    @overload
    def replace(self, *, want: OmegaAlone, **changes: Any) -> Scene[Floats, None]: ...

    @overload
    def replace(self, *, want: AttitudeAlone, **changes: Any) -> Scene[None, Floats]: ...

    @overload
    def replace(self, *, want: Iterable[str], **changes: Any) -> Scene[Floats, Floats]: ...

    @overload
    def replace(self, **changes: Any) -> Self: ...

    def replace(self, **changes: Any) -> Scene[Any, Any]:
        """Return a scene with some parts changed, by the names of the constructor."""
        parts = self._parts()
        for key in changes:
            if key not in parts:
                raise _core.InvalidInput(wrong("Scene.replace", key, tuple(parts)))
        return _restore(type(self), {**parts, **changes}, "attitude" not in changes)

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (type(self), self._parts())

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scene):
            return NotImplemented
        mine, theirs = self._parts(), other._parts()
        return all(np.array_equal(mine[k], theirs[k]) if k in ("omega", "attitude", "times") else mine[k] == theirs[k]
                   for k in mine)

    def __hash__(self) -> int:
        arrays = self.omega.tobytes(), self.attitude.tobytes(), self.times.tobytes()
        return hash((self.name, self.t0, self.want, *arrays))

    def _repr_html_(self) -> str:
        from .._plot.tables import of_scene

        return of_scene(self)

    def __repr__(self) -> str:
        moments = ", ".join(f"{m:.6g}" for m in self.inertia.moments)
        names = ", ".join(type(torque).__name__ for torque in self.torques) or "none"
        times = self.times
        rotors = f", {len(self.rotors)} rotor{'s' * (len(self.rotors) > 1)}" if self.rotors else ""
        return (f"Scene({self.name or 'unnamed'}: moments ({moments}), torques {names}{rotors}, "
                f"{times.size} times from {times.min():g} to {times.max():g} s)")


def refuse_controllers(scene: Scene, what: str) -> None:
    """Refuse a scene with controllers where ticks are not carried yet."""
    if count := len(scene.controllers):
        raise _core.InvalidInput(f"{what}: must be of a scene without controllers, got {count}; it does not go through "
                                 "ticks yet")


class _Attitude:
    """An attitude that was taken before: it gives no warning again."""

    def __init__(self, quat: npt.NDArray[np.float64]) -> None:
        self._quat = quat

    def as_quat(self) -> npt.NDArray[np.float64]:
        return self._quat


def _restore(cls: type[Scene], parts: dict[str, Any], kept: bool = True) -> Scene:
    return cls(**({**parts, "attitude": _Attitude(parts["attitude"])} if kept else parts))


def scene_folder() -> pathlib.Path:
    """Return the folder of the scenes that are installed with polhode."""
    import pathlib  # not needed by those who only compute, and slow to import

    return pathlib.Path(_core.__file__).parent / "scenes"
