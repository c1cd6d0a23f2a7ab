"""Recipes: many bodies drawn at random from a seed."""

from __future__ import annotations

import os
import pathlib
from dataclasses import dataclass
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _files
from .._core import InvalidInput
from .files import read_toml
from .scene import scene_folder
from .validation import kinds, model, validate

Floats = npt.NDArray[np.float64]


MOST_BODIES = 10_000_000   # of a file; `draw` takes any number


class Draw(NamedTuple):
    """The bodies of a recipe: one free body and one time for each row."""

    half_sides: Floats   # (count, 3) [m]
    moments: Floats      # (count, 3), in body axes, unsorted [kg m^2]
    omega: Floats        # (count, 3), at the start, in body axes [rad/s]
    t: Floats            # (count,) [s]


@dataclass(frozen=True)
class Recipe:
    """Many free boxes, with the distributions of their sizes, rates and times.

    Attributes
    ----------
    half_sides, times : (low, high)
        Bounds of uniform distributions [m], [s].
    omega : (mean, deviation)
        A normal distribution of each component [rad/s].
    """

    name: str
    title: str
    count: int
    seed: int
    mass: float
    half_sides: tuple[float, float]
    omega: tuple[float, float]
    times: tuple[float, float]

    def draw(self, count: int | None = None) -> Draw:
        """Draw the bodies, the same each time; another `count` gives other bodies.

        ``numpy.random.default_rng(seed)`` gives whole arrays in this order: half sides, omega, t.
        """
        n = self.count if count is None else count
        if isinstance(n, bool) or not isinstance(n, (int, np.integer)) or n < 0:
            raise InvalidInput(f"count: must be a whole number of 0 or more, got {n!r}")
        rng = np.random.default_rng(self.seed)
        half_sides = rng.uniform(*self.half_sides, (n, 3))
        omega = rng.normal(*self.omega, (n, 3))
        t = rng.uniform(*self.times, n)
        squares = half_sides**2
        moments = self.mass / 3 * (squares[:, [1, 2, 0]] + squares[:, [2, 0, 1]])
        return Draw(half_sides, moments, omega, t)


def _ordered(where: str) -> Any:
    def check(table: Any) -> None:
        low, high = table.uniform
        if not low <= high:
            raise ValueError(f"{where}: must be [low, high], got [{low:g}, {high:g}]")

    return check


def _positive(table: Any) -> None:
    _ordered("uniform")(table)
    if table.uniform[0] <= 0:
        raise ValueError(f"uniform: half sides must be positive, got {table.uniform[0]:g}")


def _deviation(table: Any) -> None:
    if table.normal[1] < 0:
        raise ValueError(f"normal: must be [mean, deviation] with a deviation of 0 or more, got {table.normal[1]:g}")


@cache
def recipe_model() -> Any:
    """Return the pydantic model of a recipe file."""
    from typing import Annotated, Literal

    from pydantic import Field

    kind = kinds()
    half_sides = model("HalfSides", _positive, uniform=(kind.pair, ...))
    mass: Any = Annotated[float, Field(gt=0, allow_inf_nan=False)]
    count, seed = Annotated[int, Field(ge=1, le=MOST_BODIES)], Annotated[int, Field(ge=0)]
    body = model("RecipeBody", shape=(Literal["box"], ...), mass=(mass, ...), half_sides=(half_sides, ...))
    start = model("RecipeStart", omega=(model("Rates", _deviation, normal=(kind.pair, ...)), ...))
    times = model("RecipeTimes", _ordered("uniform"), uniform=(kind.pair, ...))
    return model("RecipeFile", name=(str, ""), title=(str, ""), about=(str, ""), count=(count, ...), seed=(seed, ...),
                 draw=(Literal["whole-arrays"], "whole-arrays"),
                 body=(body, ...), start=(start, ...), times=(times, ...))


def find_recipe(source: str | os.PathLike[str]) -> pathlib.Path:
    """Return the path of a recipe, given as a path or as the name of a recipe of polhode."""
    path = _files.to_path(source, "recipe")
    if _files.is_file(path):
        return path
    folder = scene_folder() / "recipes"
    installed = folder / f"{path.name}.toml"
    if path.parent == pathlib.Path() and not path.suffix and _files.is_file(installed):
        return installed
    names = ", ".join(sorted(p.stem for p in folder.glob("*.toml")))
    raise InvalidInput(f"recipe: must be a file, or one of {names}; got {str(source)!r}")


def load_recipe(source: str | os.PathLike[str]) -> Recipe:
    """Read a recipe from a TOML file, or a recipe of polhode by its name, such as "S8".

    Raises
    ------
    InvalidInput
        For a file that is missing or not TOML, and for a key that is unknown, missing or wrong, with its name.
    """
    path = find_recipe(source)
    data = read_toml(path)
    data.setdefault("name", path.stem)
    entry = validate(recipe_model(), data, path.name)
    return Recipe(entry.name, entry.title, entry.count, entry.seed, entry.body.mass,
                  tuple(entry.body.half_sides.uniform), tuple(entry.start.omega.normal), tuple(entry.times.uniform))
