"""Distributions in place of numbers of a scene file: what is drawn, from what, and its middle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import torques
from .._core import InvalidInput
from .._scene.validation import kinds, model, one_of, validate

Floats = npt.NDArray[np.float64]
Path = tuple[Any, ...]   # keys and indices that lead to a number of a scene file

NUMBERS = {"uniform": 2, "normal": 2, "log_uniform": 2, "truncated_normal": 4}   # parameters of one component
ROTATIONS = ("normal", "normal_deg")
WORDS = {*NUMBERS, "sphere", "normal_deg"}
DRAWN = ("body", "start", "torques", "rotors", "controllers")   # the tables whose numbers may be drawn
RELATIVE = "_relative"


class Quantity(NamedTuple):
    """A drawn quantity of a recipe.

    `parameters` has a row for each component, as the core's `draw` takes them.
    """

    path: Path
    kind: str
    parameters: Floats
    single: bool = False            # the value is a number, not a list
    same: bool = False              # one draw for all three components
    base: Floats | None = None      # of relative draws: what 1 + draw multiplies; of rotations: the middle attitude
    scale: float = 1.0              # of directions: the length

    @property
    def key(self) -> str:
        """The name that the random words depend on."""
        return ".".join(map(str, self.path))

    @property
    def middle(self) -> Any:
        """The value in the middle of the distribution, as it stands in a scene file; None without one."""
        if self.kind in ("sphere", "attitude"):
            return None
        if self.kind == "rotation":
            assert self.base is not None
            return self.base.tolist()
        rows = np.array([_middle(self.kind, row) for row in self.parameters])
        values = rows if self.base is None else self.base * (1 + rows)
        return float(values[0]) if self.single else (values.tolist() * 3)[:3] if self.same else values.tolist()


def _middle(kind: str, row: Floats) -> float:
    if kind == "uniform":
        return float(row[0] + (row[1] - row[0]) / 2)
    if kind == "log_uniform":
        return math.sqrt(row[0]) * math.sqrt(row[1])
    return float(row[0] if kind == "normal" else min(max(row[0], row[2]), row[3]))


def is_distribution(value: Any) -> bool:
    """Return True for a table that stands in place of a number."""
    return isinstance(value, dict) and bool(WORDS & value.keys())


def _check(table: Any) -> None:
    one_of(table, *NUMBERS, "sphere")
    if table.sphere is not None and not 0 < table.sphere < math.inf:
        raise ValueError(f"sphere: must be the positive length of the vectors, got {table.sphere:g}")


@cache
def _model() -> Any:
    from pydantic import Field

    kind = kinds()
    entry: Any = kind.number | kind.numbers

    def rows(count: int) -> Any:
        return Annotated[list[entry], Field(min_length=count, max_length=count)]

    fields = {name: (rows(count) | None, None) for name, count in NUMBERS.items()}
    return model("Distribution", _check, **fields, sphere=(kind.number | None, None), same=(bool, False))


def _check_attitude(table: Any) -> None:
    one_of(table, "uniform", *ROTATIONS)
    if table.uniform is not None and table.about is not None:
        raise ValueError("about: must be left out beside uniform")


@cache
def _attitude_model() -> Any:
    from typing import Literal

    kind = kinds()
    size: Any = kind.number | kind.vector
    return model("AttitudeDistribution", _check_attitude, uniform=(Literal["sphere"] | None, None),
                 normal=(size | None, None), normal_deg=(size | None, None), about=(kind.quaternion | None, None))


def _rows(kind: str, given: list[Any], width: int, where: str) -> Floats:
    """Return the parameters, a row for each component."""
    sizes = {len(value) for value in given if isinstance(value, list)}
    if sizes - {width}:
        raise InvalidInput(f"{where}.{kind}: must have {width} numbers in each list, got {max(sizes - {width})}")
    columns = [value if isinstance(value, list) else [value] * width for value in given]
    rows = np.array(columns, dtype=float).T
    for row in rows:
        low, high = row[-2:] if kind != "normal" else (0.0, row[1])
        if kind in ("normal", "truncated_normal") and row[1] < 0:
            raise InvalidInput(f"{where}.{kind}: must have a deviation of 0 or more, got {row[1]:g}")
        if not low <= high:
            raise InvalidInput(f"{where}.{kind}: must have low <= high, got {low:g} and {high:g}")
        if kind == "log_uniform" and low <= 0:
            raise InvalidInput(f"{where}.{kind}: must have positive bounds, got {low:g}")
    return np.ascontiguousarray(rows)


def _attitude(table: Any, path: Path, where: str, nominal: Any) -> Quantity:
    entry = validate(_attitude_model(), table, where)
    if entry.uniform is not None:
        return Quantity(path, "attitude", np.empty((4, 0)))
    sizes = entry.normal if entry.normal is not None else np.radians(entry.normal_deg)
    deviations = np.broadcast_to(np.asarray(sizes, dtype=float), 3)
    if (deviations < 0).any():
        raise InvalidInput(f"{where}: must have deviations of 0 or more, got {deviations.min():g}")
    about = nominal if entry.about is None else np.asarray(entry.about, dtype=float)
    return Quantity(path, "rotation", np.array(deviations, dtype=float).reshape(1, 3), base=about)


def _width(path: Path, data: dict[str, Any]) -> int:
    """Return how many numbers a scene file has at a path: 3 for vectors, 0 for a number."""
    table, key = path[0], path[-1]
    if table == "torques" and len(path) == 3:
        kind = data["torques"][path[1]].get("kind")
        kinds_of = {parameter["name"]: parameter["kind"] for record in torques.records() if record["key"] == kind
                    for parameter in record["parameters"]}
        return 3 if key == "diagonal" or kinds_of.get(key) == "vector" else 0
    # Of a formula: as many as its own lists have.
    if table in ("torques", "controllers") and {"parameters", "states"} & set(path):
        drawn = get(data, path)
        lists = [value for entry in drawn.values() if isinstance(entry, list) for value in entry]
        return 3 if "sphere" in drawn else max((len(value) for value in lists if isinstance(value, list)), default=0)
    vectors = {"body": ("moments", "about", "position"), "start": ("omega", "omega_deg"), "rotors": ("axis",)}
    return 3 if key in vectors.get(table, ()) else 0


def _number(table: Any, path: Path, where: str, width: int, base: Any) -> Quantity:
    entry = validate(_model(), table, where)
    if entry.sphere is not None:
        if width != 3 or base is not None or entry.same:
            raise InvalidInput(f"{where}: sphere must stand in place of a vector")
        return Quantity(path, "sphere", np.empty((3, 0)), scale=entry.sphere)
    kind = next(name for name in NUMBERS if getattr(entry, name) is not None)
    if entry.same and width != 3:
        raise InvalidInput(f"{where}.same: must stand in place of a vector")
    rows = _rows(kind, getattr(entry, kind), 1 if entry.same or not width else width, where)
    return Quantity(path, kind, rows, single=not width, same=entry.same, base=base)


def _places(value: Any, path: Path) -> Iterator[tuple[Path, dict[str, Any]]]:
    if is_distribution(value):
        yield path, value
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from _places(inner, (*path, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from _places(inner, (*path, index))


def find(data: dict[str, Any], nominal_attitude: Floats) -> list[Quantity]:
    """Return all drawn quantities of the tables of a scene, in the order of the file.

    Raises
    ------
    InvalidInput
        For a wrong distribution, with its place.
    """
    found = []
    for path, table in [item for name in DRAWN if name in data for item in _places(data[name], (name,))]:
        where = ".".join(map(str, path))
        if path == ("start", "attitude"):
            found.append(_attitude(table, path, where, nominal_attitude))
            continue
        base = None
        if isinstance(path[-1], str) and path[-1].endswith(RELATIVE):
            path = (*path[:-1], path[-1].removesuffix(RELATIVE))
            base = _base(data, path, where)
        width = _width(path, data) if base is None else base.size if base.ndim else 0
        found.append(_number(table, path, where, width, None if base is None else np.atleast_1d(base)))
    return found


def _base(data: dict[str, Any], path: Path, where: str) -> Floats:
    try:
        value = np.asarray(get(data, path), dtype=float)
    except (KeyError, ValueError, TypeError):
        raise InvalidInput(f"{where}: must stand beside {path[-1]!r} with its numbers") from None
    if value.ndim > 1 or value.size > 3:
        raise InvalidInput(f"{where}: must stand beside a number or three of them")
    return value


def get(data: Any, path: Path) -> Any:
    """Return what stands at a path."""
    for key in path:
        data = data[key]
    return data


def put(data: Any, path: Path, value: Any) -> None:
    """Set what stands at a path; a relative distribution there goes."""
    inner = get(data, path[:-1])
    inner[path[-1]] = value
    if isinstance(inner, dict):
        inner.pop(f"{path[-1]}{RELATIVE}", None)
