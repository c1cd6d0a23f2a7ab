"""The magnetic field of a planet along an orbit, and the torque of a magnetic moment in it."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import to_any, to_number
from .._core import InvalidInput
from .._core.torques import Formula
from .._formula.symbols import Symbol, joined
from .._keywords import checked
from ..formula import to_body
from .named import make_named, register
from .orbit import Orbit

Array = npt.NDArray[np.float64]
MAKERS = ("dipole", "gauss")


class MagneticField:
    """The magnetic field of a turning planet on an orbit, in space axes [T].

    It is made by `MagneticField.dipole` or `MagneticField.gauss`. The planet turns about space z.
    """

    _kind: str
    _given: dict[str, Any]
    _core: Any

    def __init__(self) -> None:
        raise InvalidInput("MagneticField: must be made by MagneticField.dipole or MagneticField.gauss, got a call")

    @classmethod
    @checked
    def dipole(cls, orbit: Orbit, strength: float, tilt: float = 0.0, spin: float = 0.0,
               phase: float = 0.0) -> MagneticField:
        """Return the field of a dipole in the centre of the orbit.

        Its direction is m = (sin tilt cos a, sin tilt sin a, cos tilt) with a = spin t + phase, and the field is
        strength / r^3 (3 (m.u) u - m), u = r / abs(r).

        Parameters
        ----------
        orbit : Orbit
            A conic.
        strength : float
            [T m^3]. That of the Earth is 7.9e15, with a tilt near pi - 0.17: m points to the south.
        tilt, phase : float
            The angle of m from space z, and its angle from space x about it at t = 0 [rad].
        spin : float
            The rate of the planet [rad/s].

        Raises
        ------
        InvalidInput
            For an orbit that is a table, and for numbers that are not finite.

        References
        ----------
        Wertz 1978, Spacecraft Attitude Determination and Control, appendix H.
        """
        numbers = {"strength": strength, "tilt": tilt, "spin": spin, "phase": phase}
        return cls._make("dipole", orbit, {name: to_number(value, name) for name, value in numbers.items()})

    @classmethod
    @checked
    def gauss(cls, orbit: Orbit, radius: float, g: Any, h: Any, spin: float = 0.0, phase: float = 0.0) -> MagneticField:
        """Return the field of Gauss coefficients, V = a sum (a/r)^(n+1) (g cos m l + h sin m l) P_n^m(sin latitude).

        B = -grad V. The functions are Schmidt semi-normalised, without the Condon-Shortley phase. l is the longitude
        from space x less spin t + phase.

        Parameters
        ----------
        orbit : Orbit
            A conic.
        radius : float
            a, the radius of the coefficients [m].
        g, h : sequence of sequences of float
            g[n][m] and h[n][m] for m = 0 to n [T]. Row 0 is [0], and h[n][0] is 0. The degree is at most 13.
        spin, phase : float
            The rate of the planet [rad/s], and its angle at t = 0 [rad].

        Raises
        ------
        InvalidInput
            For a radius that is not positive, rows of other lengths, and coefficients that must be 0.

        References
        ----------
        Cunningham 1970, Celestial Mechanics 2, 207. Pines 1973, AIAA Journal 11, 1508.
        """
        numbers = {"radius": radius, "spin": spin, "phase": phase}
        given: dict[str, Any] = {name: to_number(value, name) for name, value in numbers.items()}
        return cls._make("gauss", orbit, {**given, "g": _to_rows(g, "g"), "h": _to_rows(h, "h")})

    @classmethod
    def _make(cls, kind: str, orbit: Orbit, given: dict[str, Any]) -> MagneticField:
        if not isinstance(orbit, Orbit):
            raise InvalidInput(f"MagneticField.orbit: must be an Orbit, got {type(orbit).__name__}")
        field = cls.__new__(cls)
        make = _core._MagneticField.dipole if kind == "dipole" else _core._MagneticField.gauss
        names = ("strength", "tilt", "spin", "phase") if kind == "dipole" else ("radius", "g", "h", "spin", "phase")
        field._core = make(orbit, *(given[name] for name in names))
        field._kind, field._given = kind, {"orbit": orbit, **given}
        return field

    @property
    def orbit(self) -> Orbit:
        """The orbit that the field is met on."""
        orbit: Orbit = self._given["orbit"]
        return orbit

    @checked
    def at(self, t: npt.ArrayLike, r: npt.ArrayLike | None = None) -> Array:
        """Return the field in space axes [T].

        Parameters
        ----------
        t : array_like, shape (...)
            Times [s], or the time of a formula that is traced.
        r : array_like, shape (..., 3), optional
            Positions in space axes [m]; those on the orbit if left out.

        Returns
        -------
        ndarray, shape (..., 3)

        Raises
        ------
        InvalidInput
            For a position in the centre.
        """
        if isinstance(t, Symbol):
            if r is not None:
                raise InvalidInput("MagneticField.at.r: must be left out in a formula, got a position")
            return joined(_core.symbols.see_field(self._core, t._items[()]))
        times = to_any(t, "t").astype(float)
        if r is None:
            rows = [self._core.at(float(time)) for time in times.ravel()]
            return np.array(rows, float).reshape((*times.shape, 3))
        places = to_any(r, "r").astype(float)
        if places.ndim == 0 or places.shape[-1] != 3:
            raise InvalidInput(f"r: must be of shape (..., 3), got {places.shape}")
        shape = np.broadcast_shapes(times.shape, places.shape[:-1])
        times, places = np.broadcast_to(times, shape), np.broadcast_to(places, (*shape, 3))
        pairs = zip(times.ravel(), places.reshape(-1, 3), strict=True)
        rows = [self._core.at(float(time), place) for time, place in pairs]
        return np.array(rows, float).reshape((*shape, 3))

    def _key(self) -> tuple[Any, ...]:
        return self._kind, *sorted(self._given.items(), key=lambda item: item[0])

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, MagneticField) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (self._kind, self._given)

    def __repr__(self) -> str:
        return f"polhode.MagneticField.{self._kind}({', '.join(f'{name}={v!r}' for name, v in self._given.items())})"


def _to_rows(rows: Any, name: str) -> tuple[tuple[float, ...], ...]:
    try:
        return tuple(tuple(float(number) for number in row) for row in rows)
    except (TypeError, ValueError):
        raise InvalidInput(f"{name}: must be rows of numbers, {name}[n][m], got {type(rows).__name__}") from None


def _restore(kind: str, given: dict[str, Any]) -> MagneticField:
    if kind not in MAKERS or not isinstance(given, dict):
        raise InvalidInput("MagneticField: must be restored from its own state")
    return MagneticField._make(kind, given["orbit"], {name: v for name, v in given.items() if name != "orbit"})


def Dipole(moment: npt.ArrayLike | Callable[..., Any], field: MagneticField, **parameters: Any) -> Any:   # noqa: N802
    """Return the torque m x B of a magnetic moment in a field, a `Formula`.

    Parameters
    ----------
    moment : array_like of shape (3,), or callable
        m in body axes [A m^2]: numbers, which are the parameter ``moment`` of the formula, or
        ``moment(t, omega, attitude, field, p)`` as the function of a `Formula`. There field is B in body axes [T].
    field : MagneticField
        On the body's orbit.
    **parameters : float or array_like, shape (n,)
        Named numbers of a function.

    Returns
    -------
    Formula
        [N m], body axes.

    Raises
    ------
    InvalidInput
        For another shape, and for a function that cannot be traced.

    References
    ----------
    Wertz 1978, Spacecraft Attitude Determination and Control, sec. 17.2.
    """
    if not isinstance(field, MagneticField):
        raise InvalidInput(f"Dipole.field: must be a MagneticField, got {type(field).__name__}")
    if callable(moment):
        function = moment
        try:
            inspect.signature(function).bind("t", "omega", "attitude", "field", "p")
        except (TypeError, ValueError):
            raise InvalidInput("Dipole.moment: must be callable as moment(t, omega, attitude, field, p), got "
                               f"{getattr(function, '__name__', type(function).__name__)}") from None
        own = None
    else:
        own = to_any(moment, "Dipole.moment").astype(float)
        if own.shape != (3,) or parameters:
            raise InvalidInput(f"Dipole.moment: must be of shape (3,) alone, got {own.shape} and "
                               f"{', '.join(parameters) or 'no parameters'}")
        parameters = {"moment": own}

        def function(t: Any, omega: Any, attitude: Any, field: Any, p: Any) -> Any:
            return p.moment

    def torque(t: Any, omega: Any, attitude: Any, p: Any) -> Any:
        seen = to_body(attitude, field.at(t))
        return np.cross(function(t, omega, attitude, seen, p), seen)

    formula = Formula(torque, **parameters)
    return formula if own is None else make_named("dipole", formula, {"moment": own.tolist(), "field": field})


register("dipole", Dipole)
