"""Speed against accuracy: every method, the closed forms and other programs on the same scenes, in one run.

`chart(scenes, folder)` measures with `measure`, draws with `pictures`, and writes the results.
"""

from __future__ import annotations

from .chart import chart as chart
from .entrant import Entrant as Entrant

__all__ = ["Entrant", "chart"]
