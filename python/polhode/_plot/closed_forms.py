"""Pictures of closed forms: the scene of each, the times to draw, and the methods `plot` and `animate`."""

from __future__ import annotations

import inspect
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from .._attitude.rotation import Rotation
from .._core import InertiaTensor, MassProperties
from .._core.exact import _ClosedForm
from .._scene.scene import Scene
from .._solve.motion import Floats
from . import html, tables

if TYPE_CHECKING:
    import matplotlib.axes
    import matplotlib.figure

    import polhode._wings

    from .track import Track

TURNS = 10          # of a motion without a period, or with a long one
LONGEST = 40        # turns of two periods that are drawn


def make_scene(form: Any, times: Floats) -> Scene:
    """Return the scene that a closed form solves."""
    torques, rotors, _, _ = form._picture
    return Scene(inertia=form.inertia, omega=form.omega, attitude=form.attitude, times=times,
                 name=type(form).__name__, torques=torques, rotors=rotors)


def find_span(form: Any) -> float:
    """Return two periods [s], or ten turns where there is no period of at most twenty turns."""
    rate = float(np.linalg.norm(form.omega))
    _, _, period, longest = form._picture
    if 0 < period < math.inf:
        largest = float(np.linalg.norm(form.at(np.linspace(0, period, 65))[0], axis=1).max())
        if 2 * period * largest <= 2 * math.pi * LONGEST:
            return 2.0 * float(period)
    return min(2 * math.pi * TURNS / rate if rate else 1.0, float(longest))


def make_track(form: Any, t: Any) -> Track:
    """Return what is drawn of a closed form: at these times, up to this time, or over the span of `find_span`."""
    from .track import count_points, of_closed_form, to_times

    if t is None or np.ndim(t) == 0:
        end = find_span(form) if t is None else float(to_times(t, "t")[0])
        rate = float(np.linalg.norm(form.omega))
        times = np.linspace(0.0, end, min(2000, max(101, count_points(rate, abs(end)))))
    else:
        times = to_times(t, "t")
    return of_closed_form(form, make_scene(form, times), times)


def plot(self: Any, t: Any = None, *parts: str, ax: matplotlib.axes.Axes | None = None,
         marks: Any = None, dark: bool = False) -> matplotlib.figure.Figure:
    """Draw the motion.

    Parameters
    ----------
    t : array_like, shape (n,), or float, optional
        The times, or the end of the span that starts at 0 [s]. By default two periods, or ten turns where a period is
        endless or long. A part's name may stand in its place.
    *parts, ax, marks, dark
        As for :meth:`Motion.plot`.

    Returns
    -------
    matplotlib.figure.Figure
        A notebook shows it. It raises what :meth:`Motion.plot` raises.
    """
    from .motion import draw
    from .style import need_matplotlib

    need_matplotlib("plot")
    if isinstance(t, str):
        t, parts = None, (t, *parts)
    return draw(make_track(self, t), parts, ax, marks, dark)


def animate(self: Any, t: Any = None, *, body: Any = "box", axis: Any = None,
            title: str | None = None) -> polhode._wings.Film:
    """Make a film of the motion: the body turns, beside the polhode on the ellipsoid of its energy.

    Parameters
    ----------
    t : array_like, shape (n,), or float, optional
        As for `plot`: the times, or the end of the span [s].
    body, axis, title
        As for :meth:`Motion.animate`.

    Returns
    -------
    Film
        As :meth:`Motion.animate`, with what that raises.
    """
    from .motion import make_film

    return make_film(make_track(self, t), body, axis, title)


def attach() -> None:
    """Give the compiled classes their methods, and rotations their table."""
    for method in (plot, animate):
        method.__doc__ = inspect.getdoc(method)   # without the indent, for the stubs
    setattr(_ClosedForm, "plot", plot)
    setattr(_ClosedForm, "animate", animate)
    setattr(_ClosedForm, "_repr_html_", html.of_closed_form)
    setattr(InertiaTensor, "_repr_html_", html.of_tensor)
    setattr(MassProperties, "_repr_html_", tables.of_mass_properties)
    setattr(Rotation, "_repr_html_", tables.of_rotation)
