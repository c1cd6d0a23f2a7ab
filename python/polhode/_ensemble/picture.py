"""Pictures of an ensemble: the spread of each quantity against time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInput
from .._plot import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from .ensemble import Ensemble

BANDS = ((0.01, 0.99, 0.15), (0.05, 0.95, 0.25), (0.25, 0.75, 0.35))   # quantiles, and how dark
MOST_TIMES = 1000
COLOUR = "#0072b2"


def _draw(axes: Any, found: Any, times: Any, pick: Any) -> None:
    if found.of == "attitude":
        axes.plot(times, pick(found.spread), color=COLOUR, label="spread")
        axes.set_ylabel("spread of the attitude [rad]")
        return
    shares = sorted({share for low, high, _ in BANDS for share in (low, high)} | {0.5})
    bounds = found.quantile(shares)
    column = {share: pick(bounds.value)[..., k] for k, share in enumerate(shares)}
    for low, high, dark in BANDS:
        axes.fill_between(times, column[low], column[high], color=COLOUR, alpha=dark, linewidth=0,
                          label=f"{100 * (high - low):g} % of the bodies")
    axes.plot(times, column[0.5], color=COLOUR, label="median")
    axes.plot(times, pick(found.rms), color="#d55e00", linestyle="--", label="rms")
    axes.set_ylabel(f"{found.name} [{found.unit}]")


def draw(run: Ensemble, names: tuple[str, ...], point: int = 0) -> Figure:
    """Draw the spread of quantities against time, one below the other; all of them if none is named."""
    style.need_matplotlib("plot")
    for name in names:
        if name not in run.summary:
            raise InvalidInput(f"plot: must be one of {', '.join(run.summary)}, got {name!r}")
    names = names or tuple(run.summary)
    if not names:
        raise InvalidInput("plot: the recipe asks for no summary")
    order = np.argsort(run.times, kind="stable")
    order = order[:: max(1, -(-order.size // MOST_TIMES))]
    swept = len(run.points) > 1

    def pick(values: Any) -> Any:
        return (values[point] if swept else values)[order]

    with style.settings():
        figure = style.make_picture(figsize=(8, 0.4 + 3.6 * len(names)), layout="constrained")
        for axes, name in zip(figure.subplots(len(names), squeeze=False)[:, 0], names, strict=True):
            _draw(axes, run.summary[name], run.times[order], pick)
            axes.set_xlabel("time [s]")
            axes.legend(frameon=False, fontsize=8)
    return figure
