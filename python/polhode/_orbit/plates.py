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
from .._core.torques import Formula
from .._keywords import checked
from .orbit import Orbit


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


def _to_plates(plates: Any, name: str) -> list[tuple[Any, ...]]:
    single = isinstance(plates, Plate) or not isinstance(plates, Iterable)
    listed = (plates,) if single else to_items(plates, f"{name}.plates", "plates")
    for plate in listed:
        if not isinstance(plate, Plate):
            raise InvalidInput(f"{name}.plates: must be Plates, got {type(plate).__name__}")
    return [dataclasses.astuple(plate) for plate in listed]


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
    numbers = [to_number(value, f"Drag.{name}") for name, value in names.items()]
    formula: Formula = _core._make_drag(_to_plates(plates, "Drag"), orbit, *numbers)
    return formula


@checked
def SolarPressure(plates: Any, sun: npt.ArrayLike, pressure: float) -> Formula:   # noqa: N802
    """Return the torque of the light on plates, a `Formula`.

    With s = R^T sun and c = (n.s)_+ the force on a plate is -pressure A c ((1 - specular) s + 2 (specular c +
    diffuse / 3) n). In a shadow the torque is left out by `During`.

    Parameters
    ----------
    plates : Plate, or iterable of Plate
        Of the body.
    sun : array_like, shape (3,)
        Towards the sun, in space axes, of any length.
    pressure : float
        Of the light at the body [N/m^2].

    Returns
    -------
    Formula
        [N m], body axes, with the parameter pressure.

    Raises
    ------
    InvalidInput
        For no plates, a sun 0, and a pressure that is negative or not finite.

    References
    ----------
    Wertz 1978, Spacecraft Attitude Determination and Control, sec. 17.2.
    """
    towards = to_any(sun, "SolarPressure.sun").astype(float)
    if towards.shape != (3,):
        raise InvalidInput(f"SolarPressure.sun: must be of shape (3,), got {towards.shape}")
    formula: Formula = _core._make_solar_pressure(_to_plates(plates, "SolarPressure"), towards,
                                                  to_number(pressure, "SolarPressure.pressure"))
    return formula
