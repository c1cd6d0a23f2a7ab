"""The bodies of an ensemble: each is drawn from its own number, in any order and on any machine."""

from __future__ import annotations

import copy
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _core
from .._core import InertiaTensor, InvalidInput
from .._scene.bodies import body_inertia, body_model
from .._scene.validation import validate
from ..inertia import Flaw, check
from . import distributions
from .distributions import Floats, Path, Quantity
from .recipe import EnsembleRecipe, Point

MOST_ATTEMPTS = 100   # draws of a body that cannot exist, before it is given up
MOMENTS: Path = ("body", "moments")


class Bodies(NamedTuple):
    """Bodies of consecutive numbers.

    `values` has the drawn numbers by their places in a scene file, a row for each body. `inertia` has principal
    moments about the body axes, one tensor for all, or a list of tensors. Bodies that were given up are `impossible`.
    """

    first: int
    values: dict[Path, Floats]
    inertia: Floats | InertiaTensor | list[InertiaTensor | None]
    attempts: npt.NDArray[np.int64]
    impossible: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return int(self.attempts.size)


def _draw(quantity: Quantity, seed: int, first: int, count: int, attempt: int = 0) -> Floats:
    """Draw one quantity of bodies first .. first + count, as it stands in a scene file."""
    rows = _core._draw(quantity.kind, seed, quantity.key, first, count, quantity.parameters, attempt)
    if quantity.kind == "sphere":
        return quantity.scale * rows
    if quantity.kind == "rotation":
        assert quantity.base is not None
        rotated: Floats = _core.attitude.product(quantity.base, rows)
        return rotated
    if quantity.same:
        rows = np.repeat(rows, 3, axis=1)
    if quantity.base is not None:
        rows = quantity.base * (1 + rows)
    return rows[:, 0] if quantity.single else rows


def _are_possible(moments: Floats, physical: bool) -> npt.NDArray[np.bool_]:
    """Return True for moments that some body has: positive, and by `InertiaTensor` none above the sum of the others."""
    fits = np.asarray((np.isfinite(moments) & (moments > 0)).all(axis=1))
    return fits & (check(moments[:, None] * np.eye(3))[1] & Flaw.TRIANGLE == 0) if physical else fits


def _tensor(data: dict[str, Any], values: dict[Path, Any]) -> InertiaTensor | None:
    table = copy.deepcopy({"body": data["body"]})
    for path, value in values.items():
        distributions.put(table, path, value)
    try:
        return body_inertia(validate(body_model(), table["body"], "body"))
    except InvalidInput:
        return None


def draw(recipe: EnsembleRecipe, point: Point, first: int, count: int) -> Bodies:
    """Draw bodies first .. first + count of a recipe. One that no body can be is drawn again, alone."""
    values = {q.path: _draw(q, recipe.seed, first, count) for q in point.quantities}
    attempts = np.zeros(count, dtype=np.int64)
    own = [q for q in point.quantities if q.path[0] == "body"]
    if not own:
        return Bodies(first, values, point.nominal.inertia, attempts, np.zeros(count, dtype=bool))
    if [q.path for q in own] == [MOMENTS]:
        return _with_moments(recipe, point, own[0], first, values, attempts)
    tensors: list[InertiaTensor | None] = []
    for i in range(count):
        tensor = _tensor(point.data, {q.path: values[q.path][i].tolist() for q in own})
        while tensor is None and attempts[i] < MOST_ATTEMPTS:
            attempts[i] += 1
            for q in own:
                values[q.path][i] = _draw(q, recipe.seed, first + i, 1, int(attempts[i]))[0]
            tensor = _tensor(point.data, {q.path: values[q.path][i].tolist() for q in own})
        tensors.append(tensor)
    return Bodies(first, values, tensors, attempts, np.array([tensor is None for tensor in tensors]))


def _with_moments(recipe: EnsembleRecipe, point: Point, quantity: Quantity, first: int, values: dict[Path, Floats],
                  attempts: npt.NDArray[np.int64]) -> Bodies:
    physical = point.data["body"].get("physical", True)
    moments = values[MOMENTS]
    left = np.flatnonzero(~_are_possible(moments, physical))
    while left.size and attempts[left[0]] < MOST_ATTEMPTS:
        attempts[left] += 1
        for i in left:
            moments[i] = _draw(quantity, recipe.seed, first + int(i), 1, int(attempts[i]))[0]
        left = left[~_are_possible(moments[left], physical)]
    impossible = np.zeros(len(moments), dtype=bool)
    impossible[left] = True
    return Bodies(first, values, moments, attempts, impossible)
