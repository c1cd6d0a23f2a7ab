"""The picture of a `FitResult`: the motion over the data, residuals, correlations, the spread of the prediction."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .._sensitivity.rotations import Array
from ..measured import Attitudes, Brightness, Scalar
from . import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
LABELS = {"Rates": "omega [rad/s]", "Attitudes": "attitude (x, y, z, w)", "Axis": "axis in space",
          "Direction": "direction in the body", "Scalar": "scalar", "Brightness": "brightness",
          "Acceleration": "acceleration [m/s^2]"}


def _model_over_data(axes: Axes, found: Any) -> None:
    m = found.problem.data[0]
    own_times = isinstance(m, (Scalar, Brightness))   # of what each sample has of its own, as a night
    t = m.t if own_times else np.linspace(m.t.min(), m.t.max(), 1500)
    own = found.bias[: m.bias]

    def values(times: Array) -> Array:
        p = found.predict(times)
        if isinstance(m, Attitudes):
            return np.asarray(p.attitude)
        seen = found.problem.with_acceleration(found.state, p.omega) if m.accelerates else p.omega
        if own_times:
            return np.asarray(m.residual(seen, p.attitude, own)[:, 0] + m.y)[:, None]
        other = object.__new__(type(m))
        other.__dict__.update(m.__dict__)
        other.y = np.zeros((len(times), *m.y.shape[1:]))
        return np.asarray(other.residual(seen, p.attitude, own))

    y = m.y
    if isinstance(m, Attitudes):   # the sign of a quaternion is free: that of the model
        at = found.predict(m.t).attitude
        y = y * np.sign((at * y).sum(axis=1, keepdims=True))
    curve, y = values(t), y.reshape(len(y), -1)
    for k in range(y.shape[1]):
        axes.plot(t, curve[:, k], color=COLOURS[k], linewidth=1.2)
        axes.plot(m.t, y[:, k], ".", color=COLOURS[k], markersize=2.5, alpha=0.6)
        if y.shape[1] > 1:
            style.label(axes, t[-1], curve[-1, k], "xyzw"[k], COLOURS[k])
    axes.set_title("fitted motion and data")
    axes.set_ylabel(LABELS[type(m).__name__])
    axes.set_xlabel("t [s]")


def _residuals(axes: Axes, found: Any) -> None:
    first = 0
    for k, m in enumerate(found.problem.data):
        count = len(m) * m.residuals
        part = found.fun[first : first + count].reshape(len(m), -1)
        axes.plot(np.repeat(m.t, part.shape[1]), part.ravel(), ".", markersize=2.5, color=COLOURS[k % 4],
                  label=LABELS[type(m).__name__])
        first += count
    for level in (-2, 2):
        axes.axhline(level, color=style.FLOOR, linewidth=0.8, linestyle=(0, (4, 3)))
    axes.set_title(f"residuals over sigma: chi2 {found.chi2:.1f} for {found.dof}")
    axes.set_xlabel("t [s]")
    if len(found.problem.data) > 1:
        axes.legend(frameon=False, fontsize=8)


def _spread(axes: Axes, found: Any) -> None:
    last = float(np.abs(found.problem.t).max()) or 1.0
    t = np.geomspace(last / 100, last * 1e4, 400)
    prediction = found.predict(t)
    axes.loglog(t, prediction.spread, color=COLOURS[0], linewidth=1.6)
    axes.axhline(1.0, color=style.FLOOR, linewidth=0.8, linestyle=(0, (4, 3)))
    axes.axvspan(t[0], last, color=style.GRID, zorder=0)
    after = prediction.unknown_after()
    end = f": unknown after {after:.3g} s" if np.isfinite(after) else ""
    axes.set_title("predicted spread of the attitude" + end)
    axes.set_xlabel("t [s]; the data span the grey part")
    axes.set_ylabel("largest standard deviation [rad]")


def _corner(figure: Figure, found: Any, box: tuple[float, float, float, float]) -> None:
    """Ellipses of one and two standard deviations of each pair of parameters."""
    seen = [k for k in range(len(found.x)) if np.isfinite(found.stderr[k]) and found.stderr[k] > 0]
    n, (left, bottom, width, height) = len(seen), box
    angle = np.linspace(0, 2 * np.pi, 73)
    circle = np.stack([np.cos(angle), np.sin(angle)])
    for row in range(1, n):
        for column in range(row):
            a, b = seen[column], seen[row]
            axes = figure.add_axes((left + column * width / (n - 1), bottom + (n - 1 - row) * height / (n - 1),
                                    0.92 * width / (n - 1), 0.92 * height / (n - 1)))
            rho = float(np.clip(found.correlation[a, b], -1, 1))
            shape = np.array([[1, 0], [rho, np.sqrt(max(1 - rho**2, 0))]]) @ circle
            for level, alpha in ((2, 0.15), (1, 0.35)):
                axes.fill(level * shape[0], level * shape[1], color=COLOURS[0], alpha=alpha, linewidth=0)
            axes.set_xlim(-2.3, 2.3), axes.set_ylim(-2.3, 2.3)
            axes.set_xticks([]), axes.set_yticks([])
            axes.grid(False)
            if column == 0:
                axes.set_ylabel(found.parameters[b], fontsize=6.5, rotation=0, ha="right", va="center")
            if row == n - 1:
                axes.set_xlabel(found.parameters[a], fontsize=6.5, rotation=35, ha="right")
    figure.text(left, bottom + height + 0.012, "correlations: one and two standard deviations",
                fontsize=10.5, fontweight="bold")


def draw(found: Any) -> Figure:
    """Return a figure with all four parts."""
    with style.used() as plt:
        figure = plt.figure(figsize=(12, 9))
        head = "The fit describes the data" if found.success else "The fit does not describe the data"
        figure.text(0.07, 0.965, head, fontsize=13, fontweight="bold")
        _model_over_data(figure.add_axes((0.07, 0.57, 0.4, 0.33)), found)
        _residuals(figure.add_axes((0.56, 0.57, 0.4, 0.33)), found)
        _spread(figure.add_axes((0.56, 0.09, 0.4, 0.36)), found)
        _corner(figure, found, (0.13, 0.11, 0.34, 0.34))
        out: Figure = figure
        return out
