"""The scene file: one schema, made from the compiled lists, that names the wrong key and says why."""

from __future__ import annotations

import difflib
import os
import pathlib
import re
import tomllib
from collections.abc import Callable
from functools import cache
from typing import Annotated, Any, Literal, NamedTuple, Union

import numpy as np

from . import _core, torques
from .scene import Scene, scene_folder

InvalidInput = _core.InvalidInput


def _pydantic() -> Any:
    try:
        import pydantic
    except ImportError:
        raise InvalidInput("scene files need pydantic: pip install 'polhode[cli]'") from None
    return pydantic


class Kinds(NamedTuple):
    """What a key may hold: a finite number, or so many of them."""

    number: Any
    pair: Any
    windows: Any   # pairs, either of them perhaps infinite
    vector: Any
    quaternion: Any
    matrix: Any
    numbers: Any


def kinds() -> Kinds:
    """Return the types of what scene files hold; strict, so that neither True nor "1" is a number."""
    field = _pydantic().Field
    number: Any = Annotated[float, field(allow_inf_nan=False)]

    def rows(one: Any, least: int, most: int | None = None) -> Any:
        return Annotated[list[one], field(min_length=least, max_length=most)]

    vector = rows(number, 3, 3)
    return Kinds(number, rows(number, 2, 2), rows(rows(float, 2, 2), 0), vector, rows(number, 4, 4), rows(vector, 3, 3), rows(number, 1))


def model(name: str, check: Callable[[Any], None] | None = None, extra: str = "forbid", /, **fields: Any) -> Any:
    """Make the model of one table, with a check over its keys together."""
    p = _pydantic()

    def checked(table: Any) -> Any:
        if check is not None:
            check(table)
        return table

    return p.create_model(name, __config__=p.ConfigDict(extra=extra, strict=True),
                          __validators__={"checked": p.model_validator(mode="after")(checked)}, **fields)


def one_of(table: Any, *choices: str) -> None:
    """Raise ValueError unless one of these keys is given, and one alone."""
    given = [name for name in choices if getattr(table, name) is not None]
    if len(given) != 1:
        raise ValueError(f"give one of {', '.join(choices)}; got {' and '.join(given) or 'none of them'}")


def _check_start(start: Any) -> None:
    one_of(start, "omega", "omega_deg")
    if start.attitude is not None and start.euler is not None:
        raise ValueError("give attitude or euler, not both")


def _check_times(times: Any) -> None:
    given = {name for name in ("span", "samples", "values") if getattr(times, name) is not None}
    if given not in ({"span", "samples"}, {"values"}):
        raise ValueError(f"give span and samples, or values; got {', '.join(sorted(given)) or 'none of them'}")


@cache
def euler_model() -> Any:
    """Return the pydantic model of an attitude given by angles."""
    kind = kinds()
    return model("Euler", lambda table: one_of(table, "angles", "angles_deg"), sequence=(str, ...),
                 angles=(kind.numbers | None, None), angles_deg=(kind.numbers | None, None))


@cache
def scene_model() -> Any:
    """Return the pydantic model of a scene file; its JSON Schema is `scene_model().model_json_schema()`."""
    from .bodies import body_model

    kind = kinds()
    start = model("Start", _check_start, omega=(kind.vector | None, None), omega_deg=(kind.vector | None, None),
                   attitude=(kind.quaternion | None, None), euler=(euler_model() | None, None), t0=(kind.number, 0.0))
    times = model("Times", _check_times, span=(kind.number | None, None), values=(kind.numbers | None, None),
                   samples=(Annotated[int, _pydantic().Field(ge=1)] | None, None))
    any_torque: Any = Union[tuple(_torque_models())]
    torque: Any = Annotated[any_torque, _pydantic().Field(discriminator="kind")]
    return model("SceneFile", name=(str, ""), title=(str, ""), about=(str, ""),
                  want=(list[Literal["omega", "attitude"]], ["omega", "attitude"]),
                  body=(body_model(), ...), start=(start, ...), torques=(list[torque], []), times=(times, ...))


def _torque_models() -> list[Any]:
    """Return the models of all torques that can stand in a file, told apart by their kind."""
    kind = kinds()
    models = []
    for record in torques.records():
        if record["key"] == "custom":
            continue   # a function cannot stand in a file
        fields: dict[str, Any] = {"kind": (Literal[record["key"]], ...), "during": (kind.windows | None, None)}
        for parameter in record["parameters"]:
            default = ... if parameter["default"] is None else parameter["default"]
            if parameter["kind"] == "matrix":
                fields[parameter["name"]], fields["diagonal"] = (kind.matrix | None, None), (kind.vector | None, None)
            elif parameter["kind"] == "choice":
                fields[parameter["name"]] = (Literal[tuple(parameter["choices"])], default)
            else:
                fields[parameter["name"]] = ({"real": kind.number, "vector": kind.vector}[parameter["kind"]], default)
        models.append(model(record["name"], **fields))
    return models


def find_scene(source: str | os.PathLike[str]) -> pathlib.Path:
    """Return the path of a scene file: a path as it is, or the name of one installed with polhode."""
    path = pathlib.Path(source)
    if path.is_file():
        return path
    installed = scene_folder() / f"{path.name}.toml"
    if path.parent == pathlib.Path() and not path.suffix and installed.is_file():
        return installed
    names = ", ".join(sorted(p.stem for p in scene_folder().glob("*.toml")))
    raise InvalidInput(f"scene: must be a file, or one of {names}; got {str(source)!r}")


def read_toml(path: pathlib.Path) -> dict[str, Any]:
    """Return the content of a TOML file, or say in one line what is wrong with it."""
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path}: not TOML: {error}") from None
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}") from None


def _keys(schema: Any) -> set[str]:
    """Return every key that stands anywhere in a JSON Schema."""
    if isinstance(schema, list):
        return set().union(*map(_keys, schema))
    if not isinstance(schema, dict):
        return set()
    return set(schema.get("properties", {})).union(*map(_keys, schema.values()))


def _explain(table: Any, error: Any) -> str:
    """One line for one finding of pydantic: the key, and what is wrong with it."""
    where = ".".join(str(part) for part in error["loc"]) or "the file"
    if error["type"] == "missing":
        return f"{where}: missing"
    if error["type"] == "extra_forbidden":
        near = difflib.get_close_matches(str(error["loc"][-1]), _keys(table.model_json_schema()), n=1)
        return f"{where}: unknown key{f', did you mean {near[0]!r}?' if near else ''}"
    if error["type"] == "value_error":
        return f"{where}: {error['ctx']['error']}"
    if error["type"] == "union_tag_not_found":
        return f"{where}: missing the key 'kind'"
    if error["type"] == "union_tag_invalid":
        return f"{where}.kind: must be one of {error['ctx']['expected_tags']}; got {error['ctx']['tag']!r}"
    found = repr(error["input"])
    text = re.sub(r"^Input should|^List should", "must", error["msg"]).replace(" after validation", "")
    text = re.sub(r"a valid dictionary or instance of \w+", "a table", text)
    text = text.replace("a valid integer", "an integer").replace("a valid ", "a ")
    return f"{where}: {text}; got {found if len(found) < 60 else found[:57] + '...'}"


def validate(table: Any, data: dict[str, Any], where: str) -> Any:
    """Check data against the model of a table; up to three wrong keys are named in one line."""
    try:
        return table.model_validate(data)
    except _pydantic().ValidationError as error:
        lines = [_explain(table, one) for one in error.errors()]
        more = f" (and {len(lines) - 3} more)" if len(lines) > 3 else ""
        raise InvalidInput(f"{where}: {'; '.join(lines[:3])}{more}") from None


def _torque(entry: Any) -> Any:
    record = next(r for r in torques.records() if r["key"] == entry.kind)
    values = entry.model_dump(exclude={"kind", "diagonal", "during"})
    if hasattr(entry, "diagonal"):
        if (entry.diagonal is None) == (entry.matrix is None):
            raise InvalidInput(f"torques: {entry.kind}: give matrix or diagonal, one of them")
        values["matrix"] = entry.matrix if entry.diagonal is None else entry.diagonal
    torque = getattr(torques, record["name"])(**values)
    return torque if entry.during is None else torques.During(torque, entry.during)


def attitude_of(start: Any) -> Any:
    """Return the attitude that a table gives as quaternion or angles, or else none at all."""
    if start.euler is None:
        return (0.0, 0.0, 0.0, 1.0) if start.attitude is None else start.attitude
    from .attitude import Rotation

    degrees = start.euler.angles is None
    angles = start.euler.angles_deg if degrees else start.euler.angles
    return Rotation.from_euler(start.euler.sequence, angles, degrees=degrees).as_quat()


def make_scene(data: dict[str, Any], where: str = "scene") -> Scene:
    """Build a scene from the content of a scene file."""
    from .bodies import body_inertia

    entry = validate(scene_model(), data, where)
    start, times = entry.start, entry.times
    grid = times.values
    if grid is None:
        grid = np.linspace(start.t0, start.t0 + times.span, times.samples)
    try:
        return Scene(
            inertia=body_inertia(entry.body),
            omega=np.radians(start.omega_deg) if start.omega is None else start.omega,
            attitude=attitude_of(start),
            torques=[_torque(one) for one in entry.torques],
            times=grid,
            want=entry.want,
            t0=start.t0,
            name=entry.name,
        )
    except InvalidInput as error:
        raise InvalidInput(f"{where}: {error}") from None


def load_scene(source: str | os.PathLike[str]) -> Scene:
    """Read a scene file; see `Scene.load`."""
    from .bodies import place_meshes

    path = find_scene(source)
    data = read_toml(path)
    data.setdefault("name", path.stem)
    place_meshes(data.get("body"), path.parent)
    return make_scene(data, path.name)


def load_body(source: str | os.PathLike[str]) -> Any:
    """Return the checked [body] table of a scene file, or of a file that holds nothing else."""
    from .bodies import body_model, place_meshes

    path = find_scene(source)
    data = read_toml(path)
    if not isinstance(data.get("body"), dict):
        raise InvalidInput(f"{path.name}: body: missing, or not a table")
    place_meshes(data["body"], path.parent)
    return validate(body_model(), data["body"], f"{path.name}: body")
