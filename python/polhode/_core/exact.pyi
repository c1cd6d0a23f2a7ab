"""
The classes of the closed forms.
"""
from __future__ import annotations
import matplotlib.axes
import matplotlib.figure
from polhode._core import DampedFree as DampedFree
from polhode._core import FreeMotion as FreeMotion
from polhode._core import Gyrostat as Gyrostat
from polhode._core import HeavyTop as HeavyTop
from polhode._core import Pendulum as Pendulum
import polhode._wings
import typing
class _ClosedForm:
    """
    A closed form.
    """
    @staticmethod
    def _repr_html_(form: typing.Any) -> str:
        """
        Return the start and the properties of a closed form.
        """
    def animate(self, t: typing.Any = None, *, body: typing.Any = 'box', axis: typing.Any = None, title: str | None = None) -> polhode._wings.Film:
        """
        Make a film of the motion: the body turns, beside the polhode on the ellipsoid of its energy.

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
    def plot(self, t: typing.Any = None, *parts: str, ax: matplotlib.axes.Axes | None = None, marks: typing.Any = None, dark: bool = False) -> matplotlib.figure.Figure:
        """
        Draw the motion.

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
