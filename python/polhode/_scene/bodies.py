"""Bodies in scene files: moments, a matrix, a shape, a mesh, several parts, or pieces of one that changes."""

from __future__ import annotations

import pathlib
from functools import cache
from typing import Any

from .. import _core, shapes
from .._attitude.rotation import Rotation
from .._core import InvalidInput
from .validation import euler_model, kinds, model, one_of

BODIES = ("moments", "matrix", "shape", "mesh", "parts")
PARTS = ("shape", "mesh", "masses")
# What may stand beside each; a shape has its own parameters besides.
BESIDE = {
    "moments": {"physical"},
    "matrix": {"physical"},
    "shape": {"mass", "density"},
    "mesh": {"mass", "density", "unit", "repair"},
    "masses": {"positions"},
    "parts": set(),
}
PLACE = {"position", "attitude", "euler", "subtract"}


def _kind(table: Any, choices: tuple[str, ...]) -> str:
    return next(name for name in choices if getattr(table, name) is not None)


def _check(table: Any, choices: tuple[str, ...], more: set[str]) -> None:
    one_of(table, *choices)
    kind = _kind(table, choices)
    wrong = table.model_fields_set - {kind} - BESIDE[kind] - more
    if kind == "shape":
        wrong -= set(table.model_extra)   # its own parameters, it will see
    if wrong:
        beside = {"moments": "moments or a matrix", "matrix": "moments or a matrix"}.get(kind, f"a {kind}")
        beside = beside.replace("a parts", "parts").replace("a masses", "masses")
        raise ValueError(f"unknown key {min(wrong)!r} beside {beside}")
    if kind == "mesh":
        one_of(table, "mass", "density")


def _check_body(body: Any) -> None:
    pieces = body.pieces or []
    if any(piece.inertia is not None for piece in pieces):
        wrong = body.model_fields_set - {"pieces", "leaving", "physical"}
        if wrong:
            raise ValueError(f"unknown key {min(wrong)!r} beside pieces with an inertia")
        return
    more = {"about"} if body.moments is None and body.matrix is None else set()
    _check(body, BODIES, more | {"pieces", "leaving"})


def _check_piece(piece: Any) -> None:
    if piece.inertia is None and piece.momentum is None:
        raise ValueError("give inertia, momentum or both")


@cache
def piece_model() -> Any:
    """Return the pydantic model of a piece of a body that changes, with the terms of its polynomials."""
    kind = kinds()
    vector: Any = kind.vector
    either: Any = kind.vector | kind.matrix
    tensors: Any = list[either]
    vectors: Any = list[vector]
    return model("Piece", _check_piece, **{"from": (float, ...), "to": (float, ...)}, inertia=(tensors | None, None),
                 momentum=(vectors | None, None))


def _check_part(part: Any) -> None:
    _check(part, PARTS, PLACE)
    if part.masses is not None and part.positions is None:
        raise ValueError("masses: give their positions too")
    if part.attitude is not None and part.euler is not None:
        raise ValueError("give attitude or euler, not both")


@cache
def part_model() -> Any:
    """Return the pydantic model of a part of a body; unknown keys are parameters of the shape."""
    kind = kinds()
    vector: Any = kind.vector
    rows: Any = list[vector]
    return model("Part", _check_part, "allow", **_solid(), masses=(kind.numbers | None, None),
                 positions=(rows | None, None), position=(kind.vector, [0.0, 0.0, 0.0]),
                 attitude=(kind.quaternion | None, None), euler=(euler_model() | None, None), subtract=(bool, False))


@cache
def body_model() -> Any:
    """Return the pydantic model of a [body] table; unknown keys are parameters of the shape."""
    kind = kinds()
    part: Any = part_model()
    parts: Any = list[part]
    piece: Any = piece_model()
    pieces: Any = list[piece]
    return model("Body", _check_body, "allow", moments=(kind.vector | None, None), matrix=(kind.matrix | None, None),
                 **_solid(), parts=(parts | None, None), about=(kind.vector | None, None),
                 physical=(bool, True), pieces=(pieces | None, None), leaving=(bool, False))


def _solid() -> dict[str, Any]:
    kind = kinds()
    return {"shape": (str | None, None), "mesh": (str | None, None), "mass": (kind.number | None, None),
            "density": (kind.number | None, None), "unit": (str | kind.number, "m"), "repair": (str | None, None)}


def attitude_of(start: Any) -> Any:
    """Return the attitude of a table, given as a quaternion or angles, or None."""
    if start.euler is None:
        return (0.0, 0.0, 0.0, 1.0) if start.attitude is None else start.attitude
    degrees = start.euler.angles is None
    angles = start.euler.angles_deg if degrees else start.euler.angles
    return Rotation.from_euler(start.euler.sequence, angles, degrees=degrees).as_quat()


def place_meshes(table: Any, folder: pathlib.Path) -> None:
    """Resolve mesh paths relative to the scene file."""
    if not isinstance(table, dict):
        return
    if isinstance(table.get("mesh"), str):
        table["mesh"] = str(folder / table["mesh"])
    parts = table.get("parts")
    for part in parts if isinstance(parts, list) else []:
        place_meshes(part, folder)


def is_solid(body: Any) -> bool:
    """Return True if a [body] table describes a whole body, not only its inertia."""
    return body.moments is None and body.matrix is None


def body_properties(body: Any) -> _core.MassProperties:
    """Return the MassProperties of a [body] table that names a shape, a mesh or parts."""
    if body.parts is None:
        return _made(body, "body")
    if not body.parts:
        raise InvalidInput("body.parts: must be one part or more, got none")
    whole: _core.MassProperties | None = None
    # What is taken out comes last, in any order of the file.
    for i, part in sorted(enumerate(body.parts), key=lambda entry: entry[1].subtract):
        where = f"body.parts.{i}"
        placed = _made(part, where).moved(attitude_of(part), part.position)
        if part.subtract and whole is None:
            raise InvalidInput(f"{where}: must have a part to be taken out of, got subtract alone")
        try:
            whole = placed if whole is None else whole - placed if part.subtract else whole + placed
        except InvalidInput as error:
            raise InvalidInput(f"{where}: {error}") from None
    assert whole is not None
    return whole


def _made(entry: Any, where: str) -> _core.MassProperties:
    """Return the body of a shape, a mesh or points, in its own axes."""
    if entry.shape is not None:
        return _shape(entry, where)
    if entry.mesh is not None:
        return _core.MassProperties.from_file(entry.mesh, density=entry.density, mass=entry.mass, unit=entry.unit,
                                              repair=entry.repair)
    try:
        return _core.MassProperties.from_points(entry.masses, entry.positions)
    except InvalidInput as error:
        raise InvalidInput(f"{where}: {error}") from None


def _shape(entry: Any, where: str) -> _core.MassProperties:
    names = [record[0] for record in _core.shape_records()]
    if entry.shape not in names:
        raise InvalidInput(f"{where}.shape: must be one of {', '.join(names)}; got {entry.shape!r}")
    try:
        sizes = dict(entry.model_extra)
        if entry.mass is not None:
            sizes["mass"] = entry.mass
        if entry.density is not None:
            one_of(entry, "mass", "density")
            if not entry.density > 0:
                raise InvalidInput(f"density: must be positive, got {entry.density:g}")
            sizes["mass"] = entry.density * shapes.volume(entry.shape, **sizes)
        made: _core.MassProperties = getattr(shapes, entry.shape)(**sizes)
        return made
    except (TypeError, ValueError) as error:
        raise InvalidInput(f"{where}: {error}") from None


def changing_of(body: Any, name: str) -> _core.Changing | None:
    """Return the inertia or the momentum that the pieces of a [body] table describe, or None."""
    pieces = [(getattr(piece, "from"), piece.to, getattr(piece, name)) for piece in body.pieces or []
              if getattr(piece, name) is not None]
    if not pieces:
        return None
    try:
        return _core.Changing(pieces, physical=body.physical)
    except InvalidInput as error:
        raise InvalidInput(f"body.pieces: {name}: {error}") from None


def body_inertia(body: Any) -> _core.InertiaTensor:
    """Return the InertiaTensor that a [body] table describes.

    Raises
    ------
    InvalidInput
        For a body that is none, and for pieces of an inertia that changes.
    """
    if changing_of(body, "inertia") is not None:
        raise InvalidInput("body: must have a constant inertia here, got pieces")
    if is_solid(body):
        properties = body_properties(body)
        return properties.inertia if body.about is None else properties.about(body.about)
    if body.moments is not None:
        return _core.InertiaTensor.from_moments(body.moments, physical=body.physical)
    return _core.InertiaTensor(body.matrix, physical=body.physical)
