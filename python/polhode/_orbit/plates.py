"""Plates on a body, and what the air and the light do to them."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core
from .._attitude.arrays import to_any, to_items, to_number
from .._core import InvalidInput
from .._core.torques import During, Formula
from .._keywords import checked
from .named import make_named, register
from .orbit import Orbit
from .sunlight import make_sunlit


@dataclasses.dataclass(frozen=True)
class Plate:
    """A flat plate on a body. Its side towards the normal sees the air and the light; a thin panel is two plates.

    Plates do not shade each other.

    Parameters
    ----------
    area : float
        [m^2].
    normal : array_like, shape (3,)
        Outward, in body axes, of any length.
    centre : array_like, shape (3,)
        From the centre of mass, in body axes [m].
    specular, diffuse : float
        Shares of the light that are reflected like by a mirror, and evenly.

    Raises
    ------
    InvalidInput
        For a negative area, a normal 0, numbers that are not finite, and shares that are negative or above 1 together.
    """

    area: float
    normal: Any
    centre: Any
    specular: float = 0.0
    diffuse: float = 0.0

    def __post_init__(self) -> None:
        for name in ("area", "specular", "diffuse"):
            object.__setattr__(self, name, to_number(getattr(self, name), f"Plate.{name}"))
        for name in ("normal", "centre"):
            row = to_any(getattr(self, name), f"Plate.{name}").astype(float)
            if row.shape != (3,):
                raise InvalidInput(f"Plate.{name}: must be of shape (3,), got {row.shape}")
            if not np.isfinite(row).all():
                raise InvalidInput(f"Plate.{name}: must be finite, got {row[~np.isfinite(row)][0]}")
            object.__setattr__(self, name, tuple(row.tolist()))
        if not 0.0 <= self.area < np.inf:
            raise InvalidInput(f"Plate.area: must be at least 0 and finite, got {self.area}")
        if not any(self.normal):
            raise InvalidInput("Plate.normal: must be not 0, got (0, 0, 0)")
        if min(self.specular, self.diffuse) < 0.0 or not self.specular + self.diffuse <= 1.0:
            raise InvalidInput("Plate.specular, Plate.diffuse: must be at least 0 and together at most 1, got "
                               f"{self.specular} and {self.diffuse}")


def _to_plates(plates: Any, name: str) -> tuple[Plate, ...]:
    single = isinstance(plates, Plate) or not isinstance(plates, Iterable)
    listed = (plates,) if single else to_items(plates, f"{name}.plates", "plates")
    for plate in listed:
        if not isinstance(plate, Plate):
            raise InvalidInput(f"{name}.plates: must be Plates, got {type(plate).__name__}")
    return tuple(listed)


def _to_tuples(plates: tuple[Plate, ...]) -> list[tuple[Any, ...]]:
    return [dataclasses.astuple(plate) for plate in plates]


@checked
def Drag(plates: Any, orbit: Orbit, coefficient: float, density: float, height_radius: float,   # noqa: N802
         scale_height: float, spin: float = 0.0) -> Formula:
    """Return the torque of the air on plates, a `Formula`.

    tau = sum of c x (-Cd/2 A rho (n.b)_+ b), b = R^T (v - spin e_z x r), in free molecular flow without lift. The
    body's own rates are neglected beside b. rho = density exp((height_radius - abs(r)) / scale_height).

    Parameters
    ----------
    plates : Plate, or iterable of Plate
        Of the body.
    orbit : Orbit
        A conic.
    coefficient : float
        Cd.
    density, height_radius, scale_height : float
        Of the air at abs(r) = height_radius [kg/m^3, m], and the height in which it falls to 1/e [m].
    spin : float
        The rate of the atmosphere about space z [rad/s].

    Returns
    -------
    Formula
        [N m], body axes, with the parameters coefficient, density and scale_height.

    Raises
    ------
    InvalidInput
        For no plates, and numbers that are negative or not finite.
    """
    names = {"coefficient": coefficient, "density": density, "height_radius": height_radius,
             "scale_height": scale_height, "spin": spin}
    numbers = {name: to_number(value, f"Drag.{name}") for name, value in names.items()}
    own = _to_plates(plates, "Drag")
    formula = _core._make_drag(_to_tuples(own), orbit, *numbers.values())
    return make_named("drag", formula, {"plates": own, "orbit": orbit, **numbers})


register("drag", Drag)


@checked
def SolarPressure(plates: Any, sun: npt.ArrayLike, pressure: float, orbit: Orbit | None = None,   # noqa: N802
                  shadow: float | None = None) -> Formula | During:
    """Return the torque of the light on plates, a `Formula`; with a shadow a `During` around it.

    With s = R^T sun and c = (n.s)_+ the force on a plate is -pressure A c ((1 - specular) s + 2 (specular c +
    diffuse / 3) n). It is dark where r.sun < 0 and the distance from the line to the sun is below `shadow`. All edges
    are found from the orbit when the scene is built.

    Parameters
    ----------
    plates : Plate, or iterable of Plate
        Of the body.
    sun : array_like, shape (3,)
        Towards the sun, in space axes, of any length.
    pressure : float
        Of the light at the body [N/m^2].
    orbit : Orbit, optional
        With `shadow`.
    shadow : float, optional
        The radius of the central body's shadow, a cylinder [m].

    Returns
    -------
    Formula or During
        [N m], body axes, with the parameter pressure.

    Raises
    ------
    InvalidInput
        For no plates, a sun 0, a pressure that is negative or not finite, a shadow without an orbit, and a radius that
        is not positive. When the scene is built, for an orbit nearer than the radius.

    References
    ----------
    Wertz 1978, Spacecraft Attitude Determination and Control, sec. 17.2.
    """
    towards = to_any(sun, "SolarPressure.sun").astype(float)
    if towards.shape != (3,):
        raise InvalidInput(f"SolarPressure.sun: must be of shape (3,), got {towards.shape}")
    own, number = _to_plates(plates, "SolarPressure"), to_number(pressure, "SolarPressure.pressure")
    formula = make_named("solar_pressure", _core._make_solar_pressure(_to_tuples(own), towards, number),
                         {"plates": own, "sun": towards.tolist(), "pressure": number})
    if (orbit is None) != (shadow is None):
        raise InvalidInput("SolarPressure.orbit, SolarPressure.shadow: must be given together, got "
                           + ("orbit alone" if shadow is None else f"shadow {shadow} alone"))
    if orbit is None:
        return formula
    return make_sunlit(formula, orbit, towards.tolist(), shadow)


register("solar_pressure", SolarPressure)
