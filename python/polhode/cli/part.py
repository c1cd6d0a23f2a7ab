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


def examine(file: str, density: float | None, mass: float | None, unit: str, flip: bool,
            weld: float) -> dict[str, Any]:
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
            report = mesh.report(vertices, faces, weld=weld)
            finding |= {"surfaces": report["components"], "cavities": report["cavities"]}
            finding |= {key: report[key] for key in ("welded", "moved") if report["welded"]}
            if not report["closed"]:
                finding |= {key: report[key] for key in ("hole_count", "closes_at")}
                finding["holes"] = [{**hole, "centre": hole["centre"].tolist()} for hole in report["holes"]]
                errors = report["errors"].items()
                finding["errors"] = {key: value if value < math.inf else None for key, value in errors}
                finding["notes"] += _holes(report, length)
            finding["size"] = [float(x) * length for x in report["high"] - report["low"]]
            finding["volume"] = MassProperties.from_mesh(vertices, faces, density=1, unit=length, repair=repair,
                                                          weld=weld).mass
        except InvalidInput as error:
            return finding | {"valid": False, "verdict": _options(str(error))}
    finding["notes"] += [str(warning.message).replace('unit="', "--unit ").replace('"', "") for warning in caught]
    if report["welded"]:
        finding["notes"].append(f"{report['welded']} vertices of open edges took the place of another, "
                                f"{report['moved'] * length:.2g} m away at most")
    if report["degenerate"]:
        finding["notes"].append(f"{report['degenerate']} faces have two equal corners and are ignored")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # said above
        body = MassProperties.from_mesh(vertices, faces, density=density, mass=mass, unit=length, repair=repair,
                                        weld=weld)
    principal = body.inertia.principal()
    return finding | {
        "mass": body.mass, "com": body.com.tolist(),
        "matrix": body.inertia.matrix.tolist(), "moments": body.inertia.moments.tolist(),
        "axes": body.inertia.axes.tolist(), "symmetry": principal.symmetry, "arbitrary": principal.arbitrary,
    }


def _options(text: str) -> str:
    """A message with the names of the command's options."""
    return text.replace('repair="flip"', "--flip").replace("weld=", "--weld ")


def _holes(report: dict[str, Any], length: float) -> list[str]:
    """Where a surface is open, and what that can change."""
    notes = []
    for hole in report["holes"][:3]:
        place = ", ".join(f"{x * length:.4g}" for x in hole["centre"])
        notes.append(f"a hole of {hole['edges']} edges about ({place}) m, {hole['radius'] * length:.4g} m in radius")
    if report["hole_count"] > 3:
        notes.append(f"{report['hole_count'] - 3} more holes")
    errors = report["errors"]
    if errors["mass"] < math.inf:
        text = f"left open, the mass of a density is within {100 * errors['mass']:.2g} %"
        if errors["inertia"] < math.inf:
            text += f", the centre within {errors['centre'] * length:.2g} m, the tensor within "
            text += f"{100 * errors['inertia']:.2g} % of its largest moment"
        notes.append(text)
    return notes


def _number(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text
