"""The picture of a judgement: deviation against time, residual with the pattern of the cause, ranking, and findings."""

from __future__ import annotations

import os
import pathlib
import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from .._core import InvalidInput
from .._files import whole
from .._plot import style
from .name import GAIN, MARGIN
from .states import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

NAMES = ("omega x", "omega y", "omega z", "rotation x", "rotation y", "rotation z")
LINES, WIDTH = 9, 150  # of the table, in letters


def draw(judgement: Any, path: str | os.PathLike[str] | None = None) -> Figure:
    """Draw a judgement, and write the picture to a file, if one is named."""
    try:
        from matplotlib.figure import Figure as Make
    except ImportError:
        raise InvalidInput("pictures need matplotlib: pip install 'polhode[plot]'") from None
    figure = Make(figsize=(13, 6.2), facecolor=style.PAPER, layout="constrained")
    grid = figure.add_gridspec(2, 3, height_ratios=(3, 1))
    left, middle, right = (figure.add_subplot(grid[0, k]) for k in range(3))
    if judgement.verdict is None:
        left.text(0.5, 0.5, "the motion was not judged", ha="center", va="center", transform=left.transAxes)
        for axes in (middle, right):
            axes.set_axis_off()
    else:
        _deviation(left, judgement)
        _pattern(middle, judgement)
        _ranking(right, judgement)
    _table(figure.add_subplot(grid[1, :]), judgement)
    if path is not None:
        with whole(pathlib.Path(path)) as draft:
            figure.savefig(draft, dpi=160)
    return figure


def _sizes(residual: Array) -> tuple[Array, Array]:
    return np.linalg.norm(residual[:, :3], axis=1), np.linalg.norm(residual[:, 3:], axis=1)


def _best(judgement: Any) -> Any:
    verdict = judgement.verdict
    return verdict.best.track if verdict and verdict.kind == "named" and verdict.best else None


def _deviation(axes: Axes, judgement: Any) -> None:
    assert judgement.verdict is not None
    data, best = judgement.verdict.track.data, _best(judgement)
    before = judgement.verdict.track.deviation()
    colours = style.LIGHT.lines
    channels = [
        (0, "rates, relative", colours[0], data.has_omega),
        (1, "attitude [rad]", colours[1], data.has_attitude),
    ]
    for number, name, colour, there in channels:
        if there:
            axes.plot(data.t, np.maximum(_sizes(before)[number], 1e-17), color=colour, linewidth=1.2, label=name)
            if best is not None:
                axes.plot(
                    data.t,
                    np.maximum(_sizes(best.deviation())[number], 1e-17),
                    color=colour,
                    linewidth=0.7,
                    alpha=0.5,
                    label=f"{name}, with the cause",
                )
    axes.set_yscale("log")
    axes.set_title("deviation from the best start" if judgement.fails("warning") else "nothing wrong")
    axes.set_xlabel("t [s]")
    axes.grid(color=style.GRID)
    axes.legend(frameon=False, fontsize=8)


def _pattern(axes: Axes, judgement: Any) -> None:
    assert judgement.verdict is not None
    track, best = judgement.verdict.track, _best(judgement)
    rest = track.deviation()
    shown = best.deviation() if best is not None else np.full_like(rest, np.nan)
    step = 2.2 * float(np.max(np.abs(rest), initial=0.0)) or 1.0
    noise = 2 * np.std(rest if best is None else shown, axis=0)
    for k in range(len(NAMES)):
        if not judgement.fails("warning") or best is not None:
            axes.axhspan(-k * step - noise[k], -k * step + noise[k], color=style.FLOOR, alpha=0.35, linewidth=0)
        colour = style.LIGHT.lines[k % 3]
        axes.plot(track.data.t, rest[:, k] - k * step, color=colour, linewidth=1.2)
        dashed = rest[:, k] - shown[:, k] - k * step
        axes.plot(track.data.t, dashed, color=style.INK, linewidth=0.7, linestyle=(0, (3, 2)))
    axes.set_yticks([-k * step for k in range(6)], NAMES)
    axes.set_title("residual" + (", and the cause's pattern (dashed)" if best is not None else ""))
    axes.set_xlabel("t [s]")


def _ranking(axes: Axes, judgement: Any) -> None:
    ranking = judgement.ranking[:8][::-1]
    gains = [max(gain, 1.0) for _, gain in ranking]
    named = [_best(judgement) is not None and k == len(ranking) - 1 for k in range(len(ranking))]
    axes.barh(range(len(ranking)), gains, color=[style.LIGHT.accent if yes else style.FLOOR for yes in named])
    axes.set_yticks(range(len(ranking)), [cause for cause, _ in ranking])
    axes.set_xscale("log")
    axes.set_xlim(1.0, 2 * max([GAIN, *gains]))
    axes.axvline(GAIN, color=style.INK, linewidth=0.8, label=f"{GAIN:g} nats are needed")
    if ranking and gains[-1] > GAIN:
        axes.axvline(gains[-1] - MARGIN, color=style.QUIET, linewidth=0.8, linestyle=(0, (4, 3)),
                     label=f"{MARGIN:g} nats behind the first")  # fmt: skip
    axes.legend(frameon=False, fontsize=8, loc="lower right")
    axes.set_title("gain of each cause")
    axes.set_xlabel("nats")


def _table(axes: Axes, judgement: Any) -> None:
    axes.set_axis_off()
    head = f"{judgement.samples} samples, {judgement.turns:.2g} turns"
    texts = [f"{head}: nothing wrong" if judgement.fine else head, *map(str, judgement.findings)]
    lines = [line for text in texts for line in textwrap.wrap(text, WIDTH, subsequent_indent="    ")]
    if len(lines) > LINES:
        lines = [*lines[: LINES - 1], "and more"]
    found = axes.text(0.0, 1.0, "\n".join(lines), va="top", fontsize=9, family="monospace", color=style.INK,
                      transform=axes.transAxes)  # fmt: skip
    found.set_in_layout(False)
