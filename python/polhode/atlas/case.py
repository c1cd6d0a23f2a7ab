"""One problem of a family: the swept value, the scene, and its truth."""

from __future__ import annotations

import functools
import math
import pathlib
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from .._harness.truth import Truth, find_truth, start_rate
from .._scene.scene import Scene
from .._solve.motion import Floats

S1_MOMENTS = (0.2, 0.4, 0.52)
STORE = pathlib.Path(__file__).with_name("truth.npz")


class Case(NamedTuple):
    """One value of what a family sweeps."""

    x: float
    scene: Scene
    series: str = ""   # which of several sweeps, "" when there is one
    grows: bool = False   # costs more than the case before: left out when that one was not done in time


def turn_of(scene: Scene) -> float:
    """One turn at the start's rate [s]."""
    return 2 * math.pi / float(np.linalg.norm(scene.omega))


def key(family: str, case: Case) -> str:
    """The name of a case's truth in the store."""
    return f"{family}/{case.series}/{case.x:.6g}"


@functools.cache
def _store() -> dict[str, Floats]:
    with np.load(STORE) as table:
        return {name: table[name] for name in table.files}


def stored(name: str) -> Floats:
    """Return one array of the store."""
    return _store()[name]


def truth_of(family: str, case: Case) -> Truth:
    """Return the stored truth at the case's times, from 113-bit arithmetic or a closed form in mpmath."""
    if case.scene.name:
        return find_truth(case.scene)
    rows: npt.NDArray[np.float64] = stored(key(family, case))
    return Truth(rows[:, :3], rows[:, 3:], "stored", "113-bit Taylor series or closed form in mpmath", 3e-16, None,
                 start_rate(case.scene))
