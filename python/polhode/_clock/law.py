"""A controller's function: called on numbers, or traced into texts."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from .._core import InvalidInput
from .._core import symbols as _core
from .._formula.symbols import Symbol, joined, numbers_of
from .._formula.trace import Values

WHERE = "Controller.function"


class Measurement:
    """What a controller measures: t, omega, attitude, and the field and the rotors' speeds if it has them."""

    def __init__(self, t: Any, omega: Any, attitude: Any, **more: Any) -> None:
        self.t, self.omega, self.attitude = t, omega, attitude
        self.__dict__.update(more)

    def __getattr__(self, name: str) -> Any:
        hints = {"field": "give field=", "speed": "give rotors=, the number of the scene's rotors"}
        raise InvalidInput(f"{WHERE}: must use what is measured ({', '.join(self.__dict__)}), got m.{name}"
                           + (f"; {hints[name]}" if name in hints else ""))


class Law:
    """A function with the shapes of its arguments and results."""

    def __init__(self, function: Callable[..., Any], commands: int, states: dict[str, Any], parameters: dict[str, Any],
                 measured: dict[str, int]) -> None:
        if not callable(function):
            raise InvalidInput(f"{WHERE}: must be callable as function(t, m, s, p), got {type(function).__name__}")
        try:
            inspect.signature(function).bind("t", "m", "s", "p")
        except (TypeError, ValueError):
            raise InvalidInput(f"{WHERE}: must be callable as function(t, m, s, p), got "
                               f"{getattr(function, '__name__', type(function).__name__)}") from None
        self.function, self.commands, self.states, self.parameters = function, commands, states, parameters
        self.measured = measured   # besides omega and attitude, with their counts

    def call(self, m: Measurement, s: dict[str, Any], p: dict[str, Any]) -> tuple[list[Any], dict[str, list[Any]]]:
        """Return the numbers of the command, and those of each state."""
        result = self.function(m.t, m, Values("s", s), Values("p", p))
        new: dict[str, Any] = {}
        if isinstance(result, tuple) and len(result) == 2 and isinstance(result[1], dict):
            result, new = result
        for name in new:
            if name not in self.states:
                raise InvalidInput(f"{WHERE}: must return states that are given ({', '.join(self.states) or 'none'}), "
                                   f"got {name}")
        command = _numbers(result, (self.commands,), "a command")
        kept = {name: _numbers(new.get(name, s[name]), np.shape(self.states[name]), f"the state {name}")
                for name in self.states}
        return command, kept

    def trace(self) -> tuple[str, dict[str, str], dict[str, str]]:
        """Return the texts of the command, of each state's new numbers, and of their shared parts.

        Raises
        ------
        InvalidInput
            For a function that cannot be traced, and for one whose two traces differ.
        """
        try:
            first, second = self._trace(), self._trace()
        except InvalidInput as refusal:
            text = str(refusal)
            text = "Controller" + text.removeprefix("Formula") if text.startswith("Formula") else text
            raise InvalidInput(f"{text} (or give trace=False, and Python is called at each tick)") from None
        if first != second:
            raise InvalidInput(f"{WHERE}: must give the same law each time, got two that differ; what it keeps between "
                               "ticks belongs into states=, and noise into measure=")
        let, rates = _core.split_text(first)
        return rates["command"], {name: rates[name] for name in self.states}, let

    def _trace(self) -> Any:
        inputs = {"command": np.zeros(self.commands) if self.commands > 1 else 0.0,
                  **{name: np.zeros(count) if count > 1 else 0.0 for name, count in self.measured.items()},
                  **self.states}
        tracer = _core.Tracer(self.parameters, inputs)

        def named(values: dict[str, Any]) -> dict[str, Any]:
            return {name: joined(value) if isinstance(value, list) else Symbol(value) for name, value in values.items()}

        own, parameters = named(tracer.states()), named(tracer.parameters())
        more = {name: own[name] if count > 1 else joined([own[name]._items[()]]) for name,
                count in self.measured.items()}
        m = Measurement(Symbol(tracer.time()), joined(tracer.omega()), joined(tracer.attitude()), **more)
        command, kept = self.call(m, {name: own[name] for name in self.states}, parameters)
        outputs: list[Any] = [0.0, 0.0, 0.0]
        for name in sorted(inputs):
            count = int(np.size(inputs[name]))
            outputs += command if name == "command" else kept[name] if name in kept else [0.0] * count
        return tracer.finish(outputs)

    def numbers(self, t: float, row: np.ndarray[Any, Any]) -> list[float]:
        """Return the numbers of the command and of the states for a row of omega, attitude and all inputs."""
        at = 7 + self.commands
        more: dict[str, Any] = {}
        for name, count in self.measured.items():
            more[name], at = row[at:at + count].copy(), at + count
        s: dict[str, Any] = {}
        for name in sorted(self.states):
            shape = np.shape(self.states[name])
            count = int(np.prod(shape)) if shape else 1
            s[name] = row[at:at + count].copy() if shape else float(row[at])
            at += count
        m = Measurement(t, row[:3].copy(), row[3:7].copy(), **more)
        p = {name: np.array(value) if isinstance(value, tuple) else value for name, value in self.parameters.items()}
        command, kept = self.call(m, s, p)
        return [float(x) for x in (*command, *(x for name in sorted(kept) for x in kept[name]))]

    def probes(self) -> list[tuple[float, np.ndarray[Any, Any]]]:
        """Return times and rows that look like those of a run."""
        rng = np.random.default_rng(2026)
        size = 7 + self.commands + sum(self.measured.values())
        found = []
        for _ in range(4):
            row = rng.normal(size=size)
            row[3:7] /= np.linalg.norm(row[3:7])
            row[6] = abs(row[6])
            starts = [np.ravel(self.states[name]) + rng.normal(size=np.size(self.states[name]))
                      for name in sorted(self.states)]
            found.append((float(rng.uniform(0, 10)), np.concatenate([row, *starts])))
        return found


def _numbers(result: Any, shape: tuple[int, ...], what: str) -> list[Any]:
    try:
        found = result.shape if isinstance(result, Symbol) else np.shape(result)
    except ValueError:
        found = None
    if isinstance(result, (dict, str)) or (found != shape and not (found == () and shape == (1,))):
        raise InvalidInput(f"{WHERE}: must return {what} of shape {shape}, got {type(result).__name__} of shape "
                           f"{found}")
    return list(np.ravel(numbers_of(result)))
