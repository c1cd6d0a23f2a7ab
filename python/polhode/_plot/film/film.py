"""A film of a motion: its frames, evenly in time, and the files and pages that show it."""

from __future__ import annotations

import os
import pathlib
from html import escape
from typing import Any

import numpy as np
import numpy.typing as npt

from ... import _files
from ..._core import InvalidInput
from ..._scene.scene import Scene
from ..._solve.motion import Floats
from ..track import Track
from .solid import Solid, choose_axis, make_solid

MOST = 1500                # frames of a page
SHORTEST, LONGEST = 6.0, 30.0   # seconds that a film takes: a motion in between runs at its own pace


class Film:
    """A motion that can be watched: a notebook plays it, and `save` writes it.

    Attributes
    ----------
    scene : Scene
    t : ndarray, shape (n,)
        The times of the frames, evenly apart [s].
    omega : ndarray, shape (n, 3)
        In body axes [rad/s].
    attitude : ndarray, shape (n, 4)
        Unit quaternions, body to space, without jumps of sign.
    axis : ndarray, shape (3,)
        The body axis whose path in space is drawn.
    """

    def __init__(self, track: Track, body: Any = "box", axis: npt.ArrayLike | None = None,
                 title: str | None = None) -> None:
        if title is not None and not isinstance(title, str):
            raise InvalidInput(f"title: must be a text, got {type(title).__name__}")
        self._title = title
        if track.curve.attitude is None:
            raise InvalidInput("animate: must have the attitude; solve a scene whose want includes it")
        if track.curve.t.size < 2 or not np.ptp(track.curve.t) > 0:
            raise InvalidInput("animate: must have two times at least")
        self.scene: Scene = track.scene
        self.axis: Floats = choose_axis(track.scene, axis)
        self.solid: Solid = make_solid(track.scene, body)
        self.track = track
        curve = track.curve
        assert curve.attitude is not None
        count = min(MOST, max(200, curve.t.size))
        self.t: Floats = np.linspace(curve.t[0], curve.t[-1], count)
        same = np.where(np.sum(curve.attitude[1:] * curve.attitude[:-1], axis=1) < 0, -1.0, 1.0)
        smooth = curve.attitude * np.cumprod(np.concatenate([[1.0], same]))[:, None]
        attitude = self._between(curve.t, smooth)
        self.attitude: Floats = attitude / np.linalg.norm(attitude, axis=1, keepdims=True)
        self.omega: Floats = self._between(curve.t, curve.omega)

    def _between(self, t: Floats, values: Floats) -> Floats:
        return np.stack([np.interp(self.t, t, values[:, k]) for k in range(values.shape[1])], axis=1)

    @property
    def seconds(self) -> float:
        """How long the film takes at its own pace [s]."""
        return float(np.clip(np.ptp(self.t), SHORTEST, LONGEST))

    @property
    def title(self) -> str:
        """As given, or the name of the scene."""
        return self._title or self.scene.name or "Motion"

    @property
    def keeps_momentum(self) -> bool:
        """Whether no torque changes the angular momentum in space, so that its arrow is drawn."""
        return not self.scene.torques and not self.scene.controllers and not self.scene.leaving

    def to_html(self, start: float | None = None) -> str:
        """Return a page that needs no network and no other file.

        Parameters
        ----------
        start : float, optional
            The time to begin at [s], with the film at rest there.
        """
        from .page import render

        return render(self, start)

    def save(self, path: str | os.PathLike[str], fps: int = 25) -> pathlib.Path:
        """Write the film.

        Parameters
        ----------
        path : path
            Ends in .html (a page that can be turned and stopped), .gif, or .mp4, which needs ffmpeg.
        fps : int
            Frames a second of .gif and .mp4.

        Raises
        ------
        InvalidInput
            For another ending, and where a program is missing.
        """
        target = pathlib.Path(path)
        suffix = target.suffix.lower()
        if suffix not in (".html", ".gif", ".mp4"):
            raise InvalidInput(f"animate: must end in .html, .gif or .mp4; got {target.name!r}")
        if suffix == ".html":
            _files.write(target, self.to_html())
        else:
            from .writer import write

            with _files.whole(target) as draft:
                write(self, draft, suffix, fps)
        return target

    def _repr_html_(self) -> str:
        page = escape(self.to_html(), quote=True)
        return (f"<iframe srcdoc=\"{page}\" title=\"{escape(self.title, quote=True)}\" "
                "style='width:100%;height:560px;border:0'></iframe>")

    def __repr__(self) -> str:
        return f"Film({self.title}: {self.t[0]:g} to {self.t[-1]:g} s, {self.solid.name})"
