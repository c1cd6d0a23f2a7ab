"""Options and checks that several commands share."""

from __future__ import annotations

import re
from typing import Annotated

import typer

from .._core import InvalidInput

Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of a table.")]


def need_matplotlib(what: str) -> None:
    """Refuse without matplotlib; `what` is such as "charts need"."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise InvalidInput(f"{what} matplotlib: pip install 'polhode[plot]'") from None


def to_seconds(text: str) -> float:
    """Return the seconds of a text such as 90, 90s or 1.5min."""
    found = re.fullmatch(r"\s*(\d+\.?\d*|\.\d+)\s*(s|min|)\s*", text)
    if not found:
        raise InvalidInput(f"budget: must be a time such as 90s or 5min, got {text!r}")
    return float(found[1]) * (60 if found[2] == "min" else 1)
