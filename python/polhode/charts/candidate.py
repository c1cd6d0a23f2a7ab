"""Candidates of a chart: records with a function that solves a scene at one setting."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from .._scene.scene import Scene
from .._solve.motion import Floats


class Answer(NamedTuple):
    """The result of a candidate: the states at the scene's times, and their cost."""

    omega: Floats
    attitude: Floats
    stats: dict[str, int]


class Failure(Exception):
    """A run that ended without a result; the text says why."""


OWN = "compiled, its own"   # where the equations of most candidates are evaluated
EULER, SEPARATRIX, CLOSED = "Euler's rates", "u, v", "closed form"   # the variables of a candidate


def euler(scene: Scene) -> str:
    """The variables of a solver of the plain equations."""
    return EULER


def separatrix(scene: Scene) -> str:
    """The variables of methods that step u and v of triaxial bodies: docs/ode.md, Variables."""
    return SEPARATRIX if scene.inertia.symmetry == "triaxial" else EULER


def closed(scene: Scene) -> str:
    """A closed form has no variables that are stepped."""
    return CLOSED


Run = Callable[[float, float | None], Answer]
Settings = tuple[tuple[str, float], ...]


class Candidate(NamedTuple):
    """A solver in a chart.

    `settings(scene)`: what is swept, from loose to tight, as (label, value). `start(scene)` gets everything ready, such
    as a compiled right-hand side, and returns `run(value, limit)`, which answers the scene or raises `Failure`; that
    ends after `limit` seconds when it is given, and otherwise looks at no clock, so that timed runs pay for none.
    `refuses(scene)`: why it does not take part, or "".
    """

    name: str
    family: str          # "method" | "cheap" | "formula" | "plan" | "exact" | "peer"
    source: str
    settings: Callable[[Scene], Settings]
    start: Callable[[Scene], Run]
    refuses: Callable[[Scene], str]
    swept: str = "rtol"   # | "accuracy" | "step" | "": what a setting's value is
    variables: Callable[[Scene], str] = euler
    right_hand_side: str = OWN   # where the equations are evaluated

    def run(self, scene: Scene, value: float, limit: float | None) -> Answer:
        """Get ready and answer once."""
        return self.start(scene)(value, limit)


def tolerances(first: int, last: int, step: int = 1) -> Callable[[Scene], Settings]:
    """Powers of ten from 10^-first to 10^-last."""
    settings = tuple((f"1e-{k:02d}", 10.0**-k) for k in range(first, last + 1, step))
    return lambda scene: settings


def fixed(label: str) -> Callable[[Scene], Settings]:
    """One setting without a number."""
    return lambda scene: ((label, 0.0),)


def steps(scene: Scene, count: int = 11, factor: int = 2) -> Settings:
    """Fixed steps that land on the samples: their interval over 1, 2, 4, ..., from about a radian of rotation on."""
    gaps = np.diff(np.concatenate([[scene.t0], scene.times]))
    gap = float(np.abs(gaps[gaps != 0]).min()) if gaps.any() else 1.0
    rate = float(np.linalg.norm(scene.omega))
    first = max(0, math.ceil(math.log(gap * rate, factor))) if gap * rate > 1 else 0
    found = [gap / factor**k for k in range(first, first + count)]
    return tuple((f"{h:.3g} s", h) for h in found)


def refuses_times(scene: Scene) -> str:
    """Why a program that goes forward through its samples cannot take a scene, or ""."""
    if (np.diff(scene.times) <= 0).any() or scene.times[0] < scene.t0:
        return "it wants its times in order, from the start on"
    return ""


def uniform(scene: Scene) -> bool:
    """Whether the samples are equally far apart, from the start on."""
    gaps = np.diff(scene.times)
    return bool(scene.times[0] == scene.t0 and np.allclose(gaps, gaps[0], rtol=1e-9))
