"""A figure that shows itself where a notebook evaluates it."""

from __future__ import annotations

import io

from matplotlib.figure import Figure

SHOWN = 110   # dots an inch in a notebook


class Picture(Figure):
    """A matplotlib figure that belongs to no window: a notebook shows it without ``%matplotlib inline``."""

    def _repr_png_(self) -> bytes:
        held = io.BytesIO()
        self.savefig(held, format="png", dpi=SHOWN)
        return held.getvalue()

