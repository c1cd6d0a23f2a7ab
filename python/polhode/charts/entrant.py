"""A solver of your own in a chart: a Python function that gets a scene and a setting, and returns the states."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import InvalidInput
from .._scene.scene import Scene
from .candidate import Answer, Candidate, Failure, Run, Settings, fixed, steps, tolerances

SWEPT = ("rtol", "step", "accuracy", "")


class Entrant:
    """A solver of your own, to be measured beside the others.

    Parameters
    ----------
    name : str
        In tables and pictures.
    solve : callable
        ``solve(scene, value)`` returns omega (n, 3) in body axes [rad/s] and attitude (n, 4), body to space,
        (x, y, z, w), at ``scene.times``; a dict of counts may follow. An exception is a failed point with its text.
    swept : {"rtol", "step", "accuracy", ""}
        What the value is. "" is for a closed form, which runs once, with the value 0.
    settings : sequence of float, optional
        The values, from loose to tight. By default 1e-3 to 1e-12, or eleven steps that end at the samples.
    source : str
        Where the method is described.
    refuses : callable, optional
        ``refuses(scene)`` returns the reason why it does not take part, or "".

    Raises
    ------
    InvalidInput
        For a name that is empty, a function that is none, and settings that do not get tighter.
    """

    def __init__(self, name: str, solve: Callable[[Scene, float], Any], *, swept: str = "rtol",
                 settings: npt.ArrayLike | None = None, source: str = "",
                 refuses: Callable[[Scene], str] | None = None) -> None:
        if not isinstance(name, str) or not name.strip():
            raise InvalidInput(f"name: must be a text that is not empty, got {name!r}")
        if not callable(solve):
            raise InvalidInput(f"solve: must be callable, got {type(solve).__name__}")
        if swept not in SWEPT:
            raise InvalidInput(f"swept: must be of 'rtol', 'step', 'accuracy' and '', got {swept!r}")
        values = None if settings is None else np.asarray(settings, dtype=float)
        if values is not None and not (values.ndim == 1 and values.size and (values > 0).all()
                                       and (np.diff(values) < 0).all()):
            raise InvalidInput(f"settings: must be positive numbers from loose to tight, got {settings!r}")
        self.name, self.solve, self.swept, self.source = name.strip(), solve, swept, source
        self.settings, self.refuses = values, refuses

    def as_candidate(self) -> Candidate:
        """Return the record that a chart measures."""
        return Candidate(self.name, "peer", self.source, self._choose(), self._start,
                         self.refuses or (lambda scene: ""), self.swept)

    def _choose(self) -> Callable[[Scene], Settings]:
        if self.settings is not None:
            found = tuple((f"{v:.3g}{' s' if self.swept == 'step' else ''}", float(v)) for v in self.settings)
            return lambda scene: found
        return fixed("closed form") if not self.swept else steps if self.swept == "step" else tolerances(3, 12)

    def _start(self, scene: Scene) -> Run:
        def run(value: float, limit: float | None) -> Answer:
            return _read(self.solve(scene, value), scene.times.size)

        return run


def _read(found: Any, count: int) -> Answer:
    """Return the states of a result, or say what is wrong with it."""
    if not isinstance(found, (tuple, list)) or len(found) not in (2, 3):
        raise Failure(f"must return omega and attitude, got {type(found).__name__}")
    omega, attitude = (np.asarray(part, dtype=float) for part in found[:2])
    for name, array, shape in (("omega", omega, (count, 3)), ("attitude", attitude, (count, 4))):
        if array.shape != shape:
            raise Failure(f"{name} must have the shape {shape}, got {array.shape}")
    return Answer(omega, attitude, {str(k): int(v) for k, v in dict(found[2] if len(found) == 3 else {}).items()})


def _to_candidates(entrant: Any) -> list[Candidate]:
    if isinstance(entrant, Candidate):
        return [entrant]
    if isinstance(entrant, Entrant):
        return [entrant.as_candidate()]
    if hasattr(entrant, "candidates") and hasattr(entrant, "found"):   # a module of `peers`
        if not entrant.found():
            raise InvalidInput(f"entrants: {entrant.NAME} is not installed: {entrant.INSTALL}")
        return list(entrant.candidates())
    if callable(entrant):
        return [Entrant(getattr(entrant, "__name__", type(entrant).__name__), entrant).as_candidate()]
    raise InvalidInput(f"entrants: must be Entrant, functions or peers, got {type(entrant).__name__}")


def read_entrants(entrants: Iterable[Any], others: list[Candidate]) -> list[Candidate]:
    """Return the candidates of entrants that are not yet among the others; refuse a name that two of them have."""
    if callable(entrants) or isinstance(entrants, Entrant) or not isinstance(entrants, Iterable):
        raise InvalidInput("entrants: must be a list, also of a single one")
    found: list[Candidate] = []
    known = {candidate.name: candidate for candidate in others}
    for candidate in (c for entrant in entrants for c in _to_candidates(entrant)):
        if candidate.name in known:
            if known[candidate.name].source == candidate.source != "":   # a peer that takes part anyway
                continue
            raise InvalidInput(f"entrants: {candidate.name!r} is the name of another candidate; choose another")
        known[candidate.name] = candidate
        found.append(candidate)
    return found
