"""GIF and MP4 of a film, drawn by matplotlib."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..._attitude.rotation import Rotation
from ..._core import InvalidInput
from ..._solve.motion import Floats
from .. import style
from ..panels import DRAW, Drawing
from ..poinsot import View, make_view

if TYPE_CHECKING:
    from .film import Film

LONGEST = 12.0   # seconds of a file
TRAIL = 0.25   # of the film that the path of the axis reaches back


def _shade(solid: Any, rotated: Floats, view: View) -> Floats:
    """Return each triangle's colour in the light from above the reader."""
    light = view.towards + 0.5 * view.up
    bright = 0.45 + 0.55 * np.clip(rotated @ (light / np.linalg.norm(light)), 0, 1)
    found: Floats = solid.colours * bright[:, None]
    return found


def _frames(film: Film, chosen: list[int]) -> Iterator[Floats]:
    """Draw the frames, shape (height, width, 3). What stays is drawn once."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.collections import PolyCollection

    from ..picture import Picture

    view, look, solid = make_view(-60.0, 22.0), style.LIGHT, film.solid
    paper = np.stack([view.right, view.up], axis=1)
    rotations = Rotation.from_quat(film.attitude)
    tips = rotations.apply(1.15 * film.axis) @ paper
    panel = make_view()   # that of the polhode
    w = film.omega @ np.asarray(film.scene.carrier_inertia.axes) @ np.stack([panel.right, panel.up], axis=1)
    back = max(2, int(TRAIL * len(film.t)))
    with style.settings(look):
        figure = Picture(figsize=(8.4, 4.5), dpi=80)
        canvas: Any = FigureCanvasAgg(figure)
        left, right = (figure.add_axes((x, 0.02, 0.46, 0.84)) for x in (0.02, 0.52))
        left.set(xlim=(-1.25, 1.25), ylim=(-1.25, 1.25), aspect="equal")
        left.set_axis_off()
        DRAW["polhode"](right, Drawing(film.track, look, np.empty(0)))
        right.set_title("ω in the body")
        if film.keeps_momentum and (size := float(np.linalg.norm(momentum := film.track.angular_momentum[0]))) > 0:
            end = 1.2 * (momentum / size) @ paper
            left.annotate("", end, (0, 0), arrowprops={"arrowstyle": "-|>", "color": look.ink, "linewidth": 1.6})
            left.annotate("L", end, xytext=(4, -2), textcoords="offset points", color=look.ink)
        (trail,) = left.plot([], [], color=look.path, linewidth=1.6)
        body: Any = left.add_collection(PolyCollection([]))
        (tip,) = left.plot([], [], "o", color=look.path, markersize=5)
        (dot,) = right.plot([], [], "o", color=look.ink, markersize=7)
        head = figure.text(0.03, 0.95, "", fontsize=11, fontweight="bold", va="center")
        moving = (trail, body, tip, dot, head)
        for artist in moving:
            artist.set_animated(True)
        canvas.draw()
        still = canvas.copy_from_bbox(figure.bbox)
        for frame in chosen:
            corners = solid.corners @ rotations[frame].as_matrix().T
            normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
            seen = np.flatnonzero(normal @ view.towards > 0)
            seen = seen[np.argsort(corners[seen].mean(axis=1) @ view.towards)]   # the nearest last
            colours = _shade(solid, normal, view)[seen]
            body.set_verts(corners[seen] @ paper)
            body.set_facecolor(colours)
            body.set_edgecolor(colours)
            trail.set_data(*tips[max(0, frame - back):frame + 1].T)
            tip.set_data(*tips[frame:frame + 1].T)
            dot.set_data(*w[frame:frame + 1].T)
            head.set_text(f"{film.title}   t = {film.t[frame]:.2f} s")
            canvas.restore_region(still)
            for artist in moving:
                (artist.axes or figure).draw_artist(artist)
            yield np.asarray(canvas.buffer_rgba())[..., :3].copy()


def _write_gif(frames: Iterator[Floats], path: Path, fps: int) -> None:
    from PIL import Image

    pictures = [Image.fromarray(frame).quantize(64, Image.Quantize.FASTOCTREE) for frame in frames]
    pictures[0].save(path, save_all=True, append_images=pictures[1:], duration=1000 / fps, loop=0)


def _write_mp4(frames: Iterator[Floats], path: Path, fps: int) -> None:
    first = next(frames)
    size = f"{first.shape[1]}x{first.shape[0]}"
    command = ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", size, "-r", str(fps),
               "-i", "-", "-vf", "pad=ceil(iw/2)*2:ceil(ih/2)*2", "-pix_fmt", "yuv420p", str(path)]
    sent = b"".join(frame.tobytes() for frame in (first, *frames))
    done = subprocess.run(command, input=sent, capture_output=True, check=False)
    if done.returncode:
        raise InvalidInput(f"animate: ffmpeg failed: {done.stderr.decode(errors='replace').strip()[-300:]}")


def write(film: Film, path: Path, suffix: str, fps: int) -> None:
    """Write the film as a GIF, or as an MP4 by ffmpeg."""
    style.need_matplotlib("animate")
    if suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise InvalidInput("animate: .mp4 needs ffmpeg, which is not installed; .gif and .html need no program")
    if isinstance(fps, bool) or not isinstance(fps, (int, np.integer)) or not 1 <= fps <= 100:
        raise InvalidInput(f"fps: must be a whole number from 1 to 100, got {fps!r}")
    count = max(2, round(min(film.seconds, LONGEST) * fps))
    chosen = [int(k) for k in np.linspace(0, len(film.t) - 1, count).round()]
    (_write_gif if suffix == ".gif" else _write_mp4)(_frames(film, chosen), path, int(fps))
