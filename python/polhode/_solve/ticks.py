"""What controllers did at their ticks."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import _export

Floats = npt.NDArray[np.float64]


class Ticks(NamedTuple):
    """What one controller did at its ticks."""

    t: Floats                          # (n,) [s]
    measurement: dict[str,
                      Floats]     # omega (n, 3), attitude (n, 4), and field (n, 3) and speed (n, rotors) if measured
    command: Floats                    # (n, k): of the tick; it acts after the delay
    states: dict[str, Floats]          # new numbers of the controller's states

    def _arrays(self) -> dict[str, Floats]:
        """All arrays but t, by names as in a file."""
        return {**{f"measurement.{name}": array for name, array in self.measurement.items()}, "command": self.command,
                **{f"states.{name}": array for name, array in self.states.items()}}

    def to_pandas(self) -> Any:
        """Return the ticks as a pandas.DataFrame with the columns t, measured numbers, command_0 ... and states."""
        return _export.ticks_to_pandas(self.t, self._arrays())


def list_arrays(ticks: tuple[Ticks, ...]) -> dict[str, Floats]:
    """Return the arrays of all controllers by their names in a file."""
    return {f"ticks.{i}.{name}": array for i, one in enumerate(ticks)
            for name, array in {"t": one.t, **one._arrays()}.items()}
