"""A zero of an event, as `solve` found it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]


class EventHit(NamedTuple):
    """A zero of the function of an event."""

    event: int
    t: float
    omega: Floats
    attitude: Floats
    states: dict[str, Any] = {}
