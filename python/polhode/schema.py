"""The scene file: one schema, made from the compiled lists, that names the wrong key and says why."""

from __future__ import annotations

import os
import pathlib
import tomllib
from typing import TYPE_CHECKING, Annotated, Any, Literal, Union

import numpy as np

from . import _core, torques
from .scene import Scene, scene_folder

if TYPE_CHECKING:
    from pydantic import BaseModel

InvalidInput = _core.InvalidInput


def _models() -> type[BaseModel]:
    """Build the pydantic model of a scene file; needs the `cli` extra."""
    try:
        from pydantic import BaseModel, ConfigDict, Field, create_model, model_validator
    except ImportError:
        raise InvalidInput("scene files need pydantic: pip install 'polhode[cli]'") from None

    number = Annotated[float, Field(allow_inf_nan=False)]
    vector = Annotated[list[number], Field(min_length=3, max_length=3)]
    quaternion = Annotated[list[number], Field(min_length=4, max_length=4)]
    matrix = Annotated[list[vector], Field(min_length=3, max_length=3)]
    strict = ConfigDict(extra="forbid")

    class Euler(BaseModel):
        model_config = strict
        sequence: str
        angles: list[number] | None = None
        angles_deg: list[number] | None = None

        @model_validator(mode="after")
        def one_of(self) -> Euler:
            if (self.angles is None) == (self.angles_deg is None):
                raise ValueError("give angles (radians) or angles_deg, one of them")
            return self

    class Body(BaseModel):
        model_config = ConfigDict(extra="allow")   # a shape's own parameters, checked by the shape
        moments: vector | None = None
        matrix: matrix | None = None               # type: ignore[valid-type]
        shape: str | None = None
        physical: bool = True

        @model_validator(mode="after")
        def one_of(self) -> Body:
            given = [k for k in ("moments", "matrix", "shape") if getattr(self, k) is not None]
            if len(given) != 1:
                raise ValueError(f"give one of moments, matrix and shape, got {', '.join(given) or 'none of them'}")
            if self.shape is None and self.model_extra:
                raise ValueError(f"unknown key {next(iter(self.model_extra))!r}")
            return self

    class Start(BaseModel):
        model_config = strict
        omega: vector | None = None
        omega_deg: vector | None = None
        attitude: quaternion | None = None
        euler: Euler | None = None
        t0: number = 0.0

        @model_validator(mode="after")
        def one_of(self) -> Start:
            if (self.omega is None) == (self.omega_deg is None):
                raise ValueError("give omega (rad/s) or omega_deg (deg/s), one of them")
            if self.attitude is not None and self.euler is not None:
                raise ValueError("give attitude or euler, not both")
            return self

    class Times(BaseModel):
        model_config = strict
        span: number | None = None
        samples: Annotated[int, Field(ge=1)] | None = None
        values: Annotated[list[number], Field(min_length=1)] | None = None

        @model_validator(mode="after")
        def one_of(self) -> Times:
            if (self.values is None) != (self.span is not None and self.samples is not None) or (
                self.values is not None and (self.span is not None or self.samples is not None)
            ):
                raise ValueError("give span and samples, or values")
            return self

    kinds: list[Any] = []
    for record in torques.records():
        if record["key"] == "custom":
            continue   # a function cannot stand in a file
        fields: dict[str, Any] = {"kind": (Literal[record["key"]], ...)}
        for parameter in record["parameters"]:
            kind = {"real": number, "vector": vector, "matrix": matrix | vector}.get(parameter["kind"])
            if kind is None:
                kind = Literal[tuple(parameter["choices"])]
            default = ... if parameter["default"] is None else parameter["default"]
            if parameter["kind"] == "matrix":
                fields["diagonal"] = (vector | None, None)
                kind, default = kind | None, None
            fields[parameter["name"]] = (kind, default)
        kinds.append(create_model(record["name"], __config__=strict, **fields))
    torque = Annotated[Union[tuple(kinds)], Field(discriminator="kind")]

    return create_model(
        "SceneFile",
        __config__=strict,
        name=(str, ""),
        title=(str, ""),
        about=(str, ""),
        want=(list[Literal["omega", "attitude"]], ["omega", "attitude"]),
        body=(Body, ...),
        start=(Start, ...),
        torques=(list[torque], []),
        times=(Times, ...),
    )


_model: list[type[BaseModel]] = []


def scene_model() -> type[BaseModel]:
    """Return the pydantic model of a scene file; its JSON Schema is `scene_model().model_json_schema()`."""
    if not _model:
        _model.append(_models())
    return _model[0]


def find_scene(source: str | os.PathLike[str]) -> pathlib.Path:
    """Return the path of a scene file: a path as it is, or the name of one installed with polhode."""
    path = pathlib.Path(source)
    if path.is_file():
        return path
    installed = scene_folder() / f"{path.name}.toml"
    if path.parent == pathlib.Path() and not path.suffix and installed.is_file():
        return installed
    names = ", ".join(sorted(p.stem for p in scene_folder().glob("*.toml")))
    raise InvalidInput(f"scene: must be a file, or one of {names}, got {str(source)!r}")


def read_toml(path: pathlib.Path) -> dict[str, Any]:
    """Return the content of a TOML file, or say in one line what is wrong with it."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path}: not TOML: {error}") from None
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None


def validate(model: type[BaseModel], data: dict[str, Any], where: str) -> Any:
    """Check data against a model; the first wrong key is named in one line."""
    from pydantic import ValidationError

    try:
        return model.model_validate(data)
    except ValidationError as error:
        details = error.errors()
        lines = [f"{'.'.join(str(part) for part in d['loc']) or 'top level'}: {d['msg'].removeprefix('Value error, ')}"
                 for d in details]
        more = f" (and {len(lines) - 3} more)" if len(lines) > 3 else ""
        raise InvalidInput(f"{where}: {'; '.join(lines[:3])}{more}") from None


def body_inertia(body: Any) -> Any:
    """Return the InertiaTensor that the [body] table describes."""
    from . import shapes
    from .inertia import InertiaTensor

    if body.shape is not None:
        make = getattr(shapes, body.shape, None) if body.shape in shapes.__all__ else None
        if make is None:
            raise InvalidInput(f"body.shape: must be one of {', '.join(shapes.__all__)}, got {body.shape!r}")
        try:
            return make(**body.model_extra).inertia
        except TypeError as error:
            raise InvalidInput(f"body: {error}") from None
    if body.moments is not None:
        return InertiaTensor.from_moments(body.moments, physical=body.physical)
    return InertiaTensor(body.matrix, physical=body.physical)


def _torque(entry: Any) -> Any:
    record = next(r for r in torques.records() if r["key"] == entry.kind)
    values = entry.model_dump(exclude={"kind", "diagonal"})
    if hasattr(entry, "diagonal"):
        if (entry.diagonal is None) == (entry.matrix is None):
            raise InvalidInput(f"torques: {entry.kind}: give matrix or diagonal, one of them")
        values["matrix"] = entry.matrix if entry.diagonal is None else entry.diagonal
    return getattr(torques, record["name"])(**values)


def make_scene(data: dict[str, Any], where: str = "scene") -> Scene:
    """Build a scene from the content of a scene file."""
    entry = validate(scene_model(), data, where)
    start, times = entry.start, entry.times
    attitude: Any = (0.0, 0.0, 0.0, 1.0) if start.attitude is None else start.attitude
    try:
        if start.euler is not None:
            from .attitude import Rotation

            degrees = start.euler.angles is None
            angles = start.euler.angles_deg if degrees else start.euler.angles
            attitude = Rotation.from_euler(start.euler.sequence, angles, degrees=degrees).as_quat()
        return Scene(
            inertia=body_inertia(entry.body),
            omega=np.radians(start.omega_deg) if start.omega is None else start.omega,
            attitude=attitude,
            torques=[_torque(one) for one in entry.torques],
            times=times.values if times.values is not None else np.linspace(start.t0, start.t0 + times.span, times.samples),
            want=entry.want,
            t0=start.t0,
            name=entry.name,
        )
    except InvalidInput as error:
        raise InvalidInput(f"{where}: {error}") from None


def load_scene(source: str | os.PathLike[str]) -> Scene:
    """Read a scene file; see `Scene.load`."""
    path = find_scene(source)
    data = read_toml(path)
    data.setdefault("name", path.stem)
    return make_scene(data, path.name)
