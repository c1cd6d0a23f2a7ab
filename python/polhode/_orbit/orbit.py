"""The path of a body's centre of mass: a Kepler orbit on any conic, or a table."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import to_any, to_number
from .._core import InvalidInput
from .._formula.symbols import Symbol, joined
from .._keywords import checked

Array = npt.NDArray[np.float64]
NUMBERS = ("e", "inclination", "node", "periapsis", "anomaly", "t0", "j2", "radius")


class Orbit:
    """A Kepler orbit through a position and a velocity, on any conic, in closed form at any time.

    `Orbit.from_elements` takes elements, and `Orbit.table` positions at some times.

    Parameters
    ----------
    mu : float
        Gravitational parameter of the planet [m^3/s^2].
    r0, v0 : array_like, shape (3,)
        Position and velocity from the planet's centre at `t0`, in space axes [m, m/s].
    t0 : float
        The time of the given state [s].

    Raises
    ------
    InvalidInput
        For mu that is not positive, r0 = 0, and numbers that are not finite.

    Notes
    -----
    Universal variables from the periapsis (Battin 1999, section 4.5). The error of r is some units of rounding of
    abs(r), and of what the rounding of t moves it. No planet, date or atmosphere is built in.
    """

    _kind = "state"

    @checked
    def __init__(self, mu: float, r0: npt.ArrayLike, v0: npt.ArrayLike, t0: float = 0.0) -> None:
        given = {"mu": to_number(mu, "mu"), "r0": _to_row(r0, "r0"), "v0": _to_row(v0, "v0"), "t0": to_number(t0, "t0")}
        self._set("state", given)

    def _set(self, kind: str, given: dict[str, Any]) -> None:
        if kind == "state":
            core = _core._Orbit.from_state(given["mu"], given["r0"], given["v0"], given["t0"])
        elif kind == "elements":
            core = _core._Orbit.from_elements(given)
        else:
            core = _core._Orbit.table(given["t"], given["r"], given["v"], given.get("mu", math.nan))
        self._kind, self._given, self._core = kind, given, core

    @classmethod
    @checked
    def from_elements(cls, mu: float, *, periapsis_distance: float | None = None, a: float | None = None,
                      e: float = 0.0, inclination: float = 0.0, node: float = 0.0, periapsis: float = 0.0,
                      anomaly: float = 0.0, t0: float = 0.0, j2: float = 0.0, radius: float = 0.0) -> Orbit:
        """Return the conic of these elements.

        Parameters
        ----------
        mu : float
            Gravitational parameter [m^3/s^2].
        periapsis_distance, a : float
            One of them: the least distance, or the semi-major axis of an ellipse [m].
        e : float
            Eccentricity: 0 a circle, below 1 an ellipse, 1 a parabola, above 1 a hyperbola.
        inclination, node, periapsis : float
            Rotations about z, x and z: of the node, of the plane, of the periapsis in the plane [rad].
        anomaly : float
            The true anomaly at `t0` [rad].
        t0 : float
            [s].
        j2, radius : float
            The planet's flattening term and equatorial radius [m]. The node, the periapsis and the mean anomaly then
            have their secular rates, without periodic terms (Vallado 2013, section 9.6). Ellipses only.

        Raises
        ------
        InvalidInput
            For e < 0, `a` with e >= 1, an anomaly beyond the asymptotes, `j2` without `radius` or with e >= 1.
        """
        given: dict[str, Any] = {"mu": to_number(mu, "mu")}
        for name, value in (("periapsis_distance", periapsis_distance), ("a", a)):
            if value is not None:
                given[name] = to_number(value, name)
        own = {"e": e, "inclination": inclination, "node": node, "periapsis": periapsis, "anomaly": anomaly, "t0": t0,
               "j2": j2, "radius": radius}
        given |= {name: to_number(value, name) for name, value in own.items()}
        orbit = cls.__new__(cls)
        orbit._set("elements", {name: value for name, value in given.items() if name not in NUMBERS or value != 0.0})
        return orbit

    @classmethod
    @checked
    def table(cls, t: npt.ArrayLike, r: npt.ArrayLike, v: npt.ArrayLike, mu: float | None = None) -> Orbit:
        """Return an orbit through given positions and velocities, with a cubic polynomial between two times.

        Parameters
        ----------
        t : array_like, shape (n,)
            Increasing times [s]. There is no extrapolation.
        r, v : array_like, shape (n, 3)
            In space axes [m, m/s].
        mu : float, optional
            Gravitational parameter, for torques that need it [m^3/s^2].
        """
        given: dict[str, Any] = {"t": to_any(t, "t").astype(float), "r": to_any(r, "r").astype(float),
                                 "v": to_any(v, "v").astype(float)}
        if mu is not None:
            given["mu"] = to_number(mu, "mu")
        if given["t"].ndim != 1:
            raise InvalidInput(f"t: must be of shape (n,), got {given['t'].shape}")
        orbit = cls.__new__(cls)
        orbit._set("table", given)
        return orbit

    @checked
    def at(self, t: npt.ArrayLike) -> tuple[Array, Array]:
        """Return position and velocity in space axes [m, m/s].

        Parameters
        ----------
        t : array_like, shape (...)
            Times [s], or the time of a formula that is traced.

        Returns
        -------
        r, v : ndarray, shape (..., 3)

        Raises
        ------
        InvalidInput
            For a time outside a table, or beyond one at which a radial orbit is at the centre.
        """
        if isinstance(t, Symbol):
            found = _core.symbols.see_orbit(self, t._items[()])
            return joined(found[0]), joined(found[1])
        r, v = self._core.at(t)
        return r, v

    @checked
    def eclipses(self, sun: npt.ArrayLike, shadow: float, begin: float, end: float) -> Array:
        """Return when the orbit is in the shadow of the central body.

        The shadow is a cylinder: it is dark where r.s < 0 and abs(r)^2 - (r.s)^2 < shadow^2, with s the direction of
        `sun`.

        Parameters
        ----------
        sun : array_like, shape (3,)
            Towards the sun, in space axes, of any length.
        shadow : float
            The radius of the shadow, that of the central body [m].
        begin, end : float
            The span [s].

        Returns
        -------
        ndarray, shape (n, 2)
            The times at which each shadow that meets the span is entered and left [s], rounded once. They may lie
            outside the span. An orbit that is dark from its beginning, or to its end, has an infinite time there.

        Raises
        ------
        InvalidInput
            For a shadow that is larger than the least distance of the orbit, a sun 0, and times outside a table.
        """
        pairs: Array = self._core.eclipses(sun, shadow, begin, end)
        return pairs

    @property
    def kind(self) -> str:
        """'circular', 'elliptic', 'parabolic', 'hyperbolic', 'radial' or 'table'."""
        return str(self._core.kind)

    @property
    def mu(self) -> float:
        """Gravitational parameter [m^3/s^2]; NaN of a table without it."""
        return float(self._core.mu)

    @property
    def e(self) -> float:
        """Eccentricity; NaN of a table."""
        return float(self._core.e)

    @property
    def period(self) -> float:
        """Period [s]; infinite unless the orbit is closed, NaN of a table."""
        return float(self._core.period)

    @property
    def periapsis_distance(self) -> float:
        """Least distance from the centre [m]; NaN of a table."""
        return float(self._core.periapsis_distance)

    def _key(self) -> tuple[Any, ...]:
        return (self._kind, *((name, value.tobytes(), value.shape) if isinstance(value, np.ndarray) else (name, value)
                              for name, value in sorted(self._given.items())))

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Orbit) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __reduce__(self) -> tuple[Any, ...]:
        return _restore, (self._kind, self._given)

    def __repr__(self) -> str:
        maker = {"state": "Orbit", "elements": "Orbit.from_elements", "table": "Orbit.table"}[self._kind]
        if self._kind == "table":
            t = self._given["t"]
            return f"polhode.{maker}({len(t)} times from {t[0]} to {t[-1]} s)"
        texts = {name: tuple(value.tolist()) if isinstance(value, np.ndarray) else value
                 for name, value in self._given.items()}
        return f"polhode.{maker}({', '.join(f'{name}={value!r}' for name, value in texts.items())})"


def _to_row(value: Any, name: str) -> Array:
    row = to_any(value, name).astype(float)
    if row.shape != (3,):
        raise InvalidInput(f"{name}: must be of shape (3,), got {row.shape}")
    return row


def _restore(kind: str, given: dict[str, Any]) -> Orbit:
    if kind not in ("state", "elements", "table") or not isinstance(given, dict):
        raise InvalidInput("Orbit: must be restored from its own state")
    orbit = Orbit.__new__(Orbit)
    try:
        orbit._set(kind, given)
    except (KeyError, TypeError) as error:
        raise InvalidInput("Orbit: must be restored from its own state") from error
    return orbit
