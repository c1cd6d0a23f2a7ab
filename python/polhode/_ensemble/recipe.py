"""Recipe files of ensembles: a scene file whose numbers may be drawn or swept, with summaries and a store."""

from __future__ import annotations

import copy
import hashlib
import itertools
import json
import os
import pathlib
from dataclasses import dataclass, field
from functools import cache, cached_property
from typing import Annotated, Any

import numpy as np

from .. import _files
from .._core import InvalidInput
from .._scene.bodies import attitude_of, place_meshes
from .._scene.files import make_scene, read_toml
from .._scene.scene import Scene
from .._scene.validation import euler_model, kinds, model, validate
from . import distributions
from .distributions import Quantity

MOST_BODIES = 4_000_000_000      # of a point: counts of a histogram have 32 bits
MOST_POINTS = 100_000            # of a sweep
SCENE = ("body", "start", "orbits", "torques", "rotors", "controllers", "times")
OPTIONS = ("accuracy", "method", "rtol", "atol", "step", "max_steps")


@dataclass(frozen=True)
class Point:
    """One point of a sweep, or the whole recipe without one."""

    settings: dict[str, Any]            # the swept values by their places
    data: dict[str, Any]                # a scene file: each draw at its middle
    quantities: tuple[Quantity, ...]
    nominal: Scene

    @property
    def without_middle(self) -> list[str]:
        """The drawn quantities that have no middle, such as a uniform attitude."""
        return [quantity.key for quantity in self.quantities if quantity.middle is None]


@dataclass(frozen=True)
class Wanted:
    """A summary that a recipe wants: the angle from a nominal motion, or another number of each state."""

    name: str
    of: str
    nominal: Any = None                 # of angles: "undisturbed", or a quaternion
    axis: tuple[float, ...] = ()
    target: tuple[float, ...] = ()
    function: str = ""
    bounds: dict[str, float] = field(default_factory=dict)   # of the histogram


@dataclass(frozen=True, eq=False)
class EnsembleRecipe:
    """What is drawn and what is wanted of it. Equal recipes have equal hashes."""

    name: str
    count: int                          # bodies at each point of the sweep
    seed: int
    raw: dict[str, Any]                 # the file's content, with the count in use
    folder: str                         # of the file: meshes are relative to it
    points: tuple[Point, ...]
    wanted: tuple[Wanted, ...]
    options: dict[str, Any]             # of `solve`
    states: str                         # "none", "float32" or "float64"
    every: int                          # store every n-th time
    chunk: int | None                   # bodies, if the file says

    @cached_property
    def hash(self) -> str:
        """SHA-256 of all that the numbers depend on."""
        content = {key: value for key, value in self.raw.items() if key not in ("name", "title", "about")}
        if "mesh" in json.dumps(content.get("body")):
            matrices = [point.nominal.inertia.matrix.ravel().tolist() for point in self.points]
            content["inertia"] = [[value.hex() for value in matrix] for matrix in matrices]
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()

    @property
    def title(self) -> str:
        """The file's title, or its name."""
        return str(self.raw.get("title") or self.name)

    @property
    def times(self) -> Any:
        """The sample times [s]."""
        return self.points[0].nominal.times


@cache
def _numbers() -> Any:
    kind = kinds()
    value: Any = kind.number | kind.numbers
    return value


def _check_store(table: Any) -> None:
    if table.chunk is not None and table.chunk & (table.chunk - 1):
        raise ValueError(f"chunk: must be a power of two, got {table.chunk}")
    if table.every > 1 and table.states == "none":
        raise ValueError("every: must be left out where no states are stored")


NEEDS = {"angle": {"nominal"}, "axis_angle": {"axis", "target"}, "omega": set(), "energy": set(), "attitude": set(),
         "function": {"function"}}


def _check_summary(table: Any) -> None:
    given = table.model_fields_set - {"of", "name", "least", "largest"}
    if wrong := given - NEEDS[table.of]:
        raise ValueError(f"{min(wrong)}: must be left out for {table.of}")
    if missing := NEEDS[table.of] - given - {"nominal"}:
        raise ValueError(f"{min(missing)}: missing for {table.of}")
    if table.of == "attitude" and (table.least is not None or table.largest is not None):
        raise ValueError("least, largest: must be left out for attitude, which has no histogram")
    low, high = table.least, table.largest
    if (low is None) != (high is None):
        raise ValueError("least, largest: give both or none")
    if low is not None and not low < high:
        raise ValueError(f"least: must be below largest, got {low:g} and {high:g}")


@cache
def ensemble_model() -> Any:
    """Return the pydantic model of the tables that a recipe has beside those of a scene file."""
    from typing import Literal

    from pydantic import Field

    kind = kinds()
    positive: Any = Annotated[float, Field(gt=0, allow_inf_nan=False)]
    whole: Any = Annotated[int, Field(ge=1)]
    solve = model("Solve", accuracy=(positive | None, None), method=(str | None, None), rtol=(positive | None, None),
                  atol=(positive | None, None), step=(positive | None, None), max_steps=(whole | None, None))
    nominal: Any = Literal["undisturbed"] | kind.quaternion
    summary: Any = model("Summary", _check_summary, of=(Literal[tuple(NEEDS)], ...), name=(str | None, None),
                         nominal=(nominal, "undisturbed"), axis=(kind.vector, None), target=(kind.vector, None),
                         function=(str, None), least=(positive | None, None), largest=(positive | None, None))
    store = model("Store", _check_store, states=(Literal["none", "float32", "float64"], "none"), every=(whole, 1),
                  chunk=(Annotated[int, Field(ge=8, le=2**30)] | None, None))
    value: Any = _numbers()
    swept: Any = Annotated[list[value], Field(min_length=1)]
    table: Any = dict[str, Any]
    return model("EnsembleFile", name=(str, ""), title=(str, ""), about=(str, ""),
                 count=(Annotated[int, Field(ge=1, le=MOST_BODIES)], ...),
                 seed=(Annotated[int, Field(ge=0, lt=2**64)], ...), draw=(Literal["by-body"], ...),
                 body=(table, ...), start=(table, ...), times=(table, ...),
                 orbits=(dict[str, table], {}), torques=(list[table], []), rotors=(list[table], []),
                 controllers=(list[table], []),
                 solve=(solve, solve()), store=(store, store()), summary=(list[summary] | None, None),
                 sweep=(dict[str, swept], {}))


def _place(key: str) -> distributions.Path:
    return tuple(int(part) if part.isdigit() else part for part in key.split("."))


def _sweep(data: dict[str, Any], sweep: dict[str, list[Any]], where: str) -> list[tuple[dict[str, Any], Any]]:
    """Return the settings and the content for each point of the grid."""
    total = int(np.prod([len(values) for values in sweep.values()], dtype=object))
    if total > MOST_POINTS:
        raise InvalidInput(f"{where}: sweep: must have at most {MOST_POINTS} points, got {total}")
    points = []
    for values in itertools.product(*sweep.values()):
        changed, settings = copy.deepcopy(data), dict(zip(sweep, values, strict=True))
        for key, value in settings.items():
            path = _place(key)
            try:
                if path[0] not in distributions.DRAWN:
                    raise KeyError(key)
                distributions.get(changed, path)
            except (KeyError, IndexError, TypeError):
                raise InvalidInput(f"{where}: sweep: must name numbers of the file, such as 'torques.0.diagonal'; "
                                   f"got {key!r}") from None
            distributions.get(changed, path[:-1])[path[-1]] = value
        points.append((settings, changed))
    return points


def _nominal_attitude(start: dict[str, Any], where: str) -> Any:
    """Return the attitude in the middle of a drawn rotation: that of `euler`, which goes, or the identity."""
    drawn = distributions.is_distribution(start.get("attitude"))
    if not drawn or "euler" not in start:
        return np.array([0.0, 0.0, 0.0, 1.0])
    entry = validate(model("Start", euler=(euler_model(), ...)), {"euler": start.pop("euler")}, f"{where}: start")
    return np.asarray(attitude_of(entry), dtype=float)


def _point(settings: dict[str, Any], data: dict[str, Any], where: str) -> Point:
    scene = {key: copy.deepcopy(data[key]) for key in SCENE if key in data}
    about = _nominal_attitude(scene["start"], where)
    try:
        quantities = distributions.find(scene, about)
    except InvalidInput as error:
        raise InvalidInput(f"{where}: {error}") from None
    for quantity in quantities:
        middle = quantity.middle
        if middle is None:   # any value passes for the check of the file
            middle = [0.0, 0.0, quantity.scale] if quantity.kind == "sphere" else [0.0, 0.0, 0.0, 1.0]
        distributions.put(scene, quantity.path, middle)
    nominal = make_scene({**scene, "name": str(data.get("name", ""))}, where)
    return Point(settings, scene, tuple(quantities), nominal)


def _wanted(tables: list[Any] | None, points: list[Point], where: str) -> tuple[Wanted, ...]:
    missing = [key for point in points for key in point.without_middle]
    if tables is None:
        return (Wanted("omega", "omega"), Wanted("attitude", "attitude") if missing
                else Wanted("angle", "angle", "undisturbed"))
    found: list[Wanted] = []
    for index, table in enumerate(tables):
        place = f"{where}: summary.{index}"
        if table.of == "angle" and table.nominal == "undisturbed" and missing:
            raise InvalidInput(f"{place}.nominal: must be a quaternion, because {missing[0]} has no middle")
        name = table.name or table.function or table.of
        if not name.isidentifier():
            raise InvalidInput(f"{place}.name: must be a word of letters, digits and _, got {name!r}")
        if any(name == other.name for other in found):
            raise InvalidInput(f"{place}.name: must differ from the others, got {name!r}")
        bounds = {key: getattr(table, key) for key in ("least", "largest") if getattr(table, key) is not None}
        nominal = table.nominal if table.of == "angle" else None
        if isinstance(nominal, list):
            size = float(np.linalg.norm(nominal))
            if not abs(size - 1) < 1e-6:
                raise InvalidInput(f"{place}.nominal: must be a unit quaternion, got the length {size:.9g}")
        for key in ("axis", "target"):
            if getattr(table, key) is not None and not any(getattr(table, key)):
                raise InvalidInput(f"{place}.{key}: must have a direction, got zeros")
        found.append(Wanted(name, table.of, nominal, tuple(table.axis or ()), tuple(table.target or ()),
                            table.function or "", bounds))
    if not found:
        raise InvalidInput(f"{where}: summary: must have one table or more, or be left out")
    return tuple(found)


def from_content(raw: dict[str, Any], folder: str, where: str, count: int | None = None) -> EnsembleRecipe:
    """Return the recipe of a file's content; refuse what is wrong by its name."""
    if raw.get("draw", "whole-arrays") == "whole-arrays":
        raise InvalidInput(f"{where}: draw: must be 'by-body' for an ensemble, because whole arrays cannot be drawn in "
                           f"parts")
    raw = copy.deepcopy(raw)
    if count is not None:
        if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 1:
            raise InvalidInput(f"count: must be a whole number of 1 or more, got {count!r}")
        raw["count"] = int(count)
    entry = validate(ensemble_model(), raw, where)
    data = copy.deepcopy(raw)
    place_meshes(data["body"], pathlib.Path(folder))
    points = [_point(settings, changed, where) for settings, changed in _sweep(data, entry.sweep, where)]
    options = {key: getattr(entry.solve, key) for key in OPTIONS if getattr(entry.solve, key) is not None}
    return EnsembleRecipe(entry.name, entry.count, entry.seed, raw, folder, tuple(points),
                          _wanted(entry.summary, points, where), options, entry.store.states, entry.store.every,
                          entry.store.chunk)


def load(source: str | os.PathLike[str], count: int | None = None) -> EnsembleRecipe:
    """Read a recipe of an ensemble from a TOML file, or one of polhode by its name."""
    path = _files.to_path(source, "recipe")
    if not _files.is_file(path):
        from .._scene.recipe import find_recipe

        path = find_recipe(source)
    raw = read_toml(path)
    raw.setdefault("name", path.stem)
    return from_content(raw, str(path.parent.resolve()), path.name, count)


@cache
def _again(text: str, folder: str) -> EnsembleRecipe:
    return from_content(json.loads(text), folder, "recipe")


def to_message(recipe: EnsembleRecipe) -> tuple[str, str]:
    """Return what a worker needs to make the recipe again."""
    return json.dumps(recipe.raw), recipe.folder


def from_message(message: tuple[str, str]) -> EnsembleRecipe:
    """Return the recipe of a message, made once in each process."""
    return _again(*message)
