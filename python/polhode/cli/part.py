"""Mass properties of a mesh file, or the reason why its surface encloses no body."""

from __future__ import annotations

import math
import pathlib
import warnings
from typing import Any

from .. import _core, mesh
from .._core import InvalidInput, MassProperties


def is_mesh(file: str) -> bool:
    """Return True if the suffix is that of a mesh file."""
    return pathlib.Path(file).suffix.lower() in mesh.FORMATS


def examine(file: str, density: float | None, mass: float | None, unit: str, flip: bool) -> dict[str, Any]:
    """Return mass, centre, moments and axes of the solid in a mesh file.

    A surface that encloses no body is a finding, not an error: `valid` is False, and `verdict` says why.
    """
    finding: dict[str, Any] = {"file": file, "valid": True, "verdict": "the surface of a body", "notes": []}
    for name, value in {"density": density, "mass": mass}.items():
        if value is not None and not 0 < value < math.inf:
            raise InvalidInput(f"--{name}: must be positive and finite, got {value:g}")
    if density is not None and mass is not None:
        raise InvalidInput("--density: must be given, or else --mass, got both")
    if density is None and mass is None:
        density = 1.0
        finding["notes"].append("neither --density nor --mass is given: the density is 1 kg/m^3")
    length = _core.unit_in_metres(_number(unit))
    vertices, faces = mesh.read(file)
    finding["faces"] = len(faces)
    repair = "flip" if flip else None
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            report = mesh.report(vertices, faces)
            finding |= {"surfaces": report["components"], "cavities": report["cavities"]}
            finding["size"] = [float(x) * length for x in report["high"] - report["low"]]
            finding["volume"] = MassProperties.from_mesh(vertices, faces, density=1, unit=length, repair=repair).mass
        except InvalidInput as error:
            return finding | {"valid": False, "verdict": str(error).replace('repair="flip"', "--flip")}
    finding["notes"] += [str(warning.message).replace('unit="', "--unit ").replace('"', "") for warning in caught]
    if report["degenerate"]:
        finding["notes"].append(f"{report['degenerate']} faces have two equal corners and are ignored")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # said above
        body = MassProperties.from_mesh(vertices, faces, density=density, mass=mass, unit=length, check=False,
                                        repair=repair)
    principal = body.inertia.principal()
    return finding | {
        "mass": body.mass, "com": body.com.tolist(),
        "matrix": body.inertia.matrix.tolist(), "moments": body.inertia.moments.tolist(),
        "axes": body.inertia.axes.tolist(), "symmetry": principal.symmetry, "arbitrary": principal.arbitrary,
    }


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
