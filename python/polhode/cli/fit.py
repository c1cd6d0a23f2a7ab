"""The fit of a table of measurements."""

from __future__ import annotations

import math
import pathlib
from typing import Any

from .._core import InertiaTensor, InvalidInput
from .._sensitivity.fit import fit
from .._sensitivity.result import FitResult
from .._sensitivity.table import read


def _vector(text: str, option: str) -> tuple[float, ...]:
    try:
        found = tuple(float(part) for part in text.split(","))
    except ValueError:
        found = ()
    if len(found) != 3 or not all(map(math.isfinite, found)):
        raise InvalidInput(f"--{option}: must be three numbers such as 0,0,1, got {text!r}")
    return found


def _sigmas(text: str) -> dict[str, float]:
    found = {}
    for part in text.split(","):
        name, _, value = part.partition("=")
        try:
            found[name.strip()] = float(value)
        except ValueError:
            raise InvalidInput(f"--sigma: must be such as omega=0.01,attitude=0.02, got {text!r}") from None
    return found


def run(data: pathlib.Path, columns: str | None, sigma: str, parameters: str, axis: str, direction: str | None,
        bias: bool, degrees: bool, loss: str, seed: int, first: float | None, last: float | None) -> FitResult:
    """Read the table and fit."""
    measured = read(data, columns, _sigmas(sigma), bias=bias, degrees=degrees, axis=_vector(axis, "axis"),
                    direction=None if direction is None else _vector(direction, "direction"), first=first, last=last)
    return fit(measured, fit=[part.strip() for part in parameters.split(",")], loss=loss, seed=seed)


def to_json(found: FitResult) -> dict[str, Any]:
    """Return the result; errors of what is not observable are null."""
    inertia = found.inertia.matrix if isinstance(found.inertia, InertiaTensor) else found.inertia
    return {
        "success": found.success, "message": found.message, "chi2": found.chi2, "dof": found.dof,
        "parameters": {name: {"value": float(value), "stderr": float(error) if math.isfinite(error) else None}
                       for name, value, error in zip(found.parameters, found.x, found.stderr, strict=True)},
        "omega": found.omega.tolist(), "attitude": found.attitude.as_quat().tolist(), "inertia": inertia.tolist(),
        "candidates": [{"omega": one.omega.tolist(), "inertia": one.inertia.tolist(), "chi2": one.chi2,
                        "nutation": one.nutation if math.isfinite(one.nutation) else None,
                        "precession": one.precession if math.isfinite(one.precession) else None}
                       for one in found.candidates],
        "outliers": [places.tolist() for places in found.outliers],
        "bias": found.bias.tolist(), "unobservable": list(found.unobservable), "twins": list(found.twins),
        "left_out": found.left_out,
    }
