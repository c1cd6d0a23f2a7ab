"""The parts of a picture of a motion, each drawn into axes of its own."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .._attitude.rotation import Rotation
from .._core import energy
from .._solve.motion import Floats
from . import style
from .poinsot import family, herpolhode, in_front, make_view, outline
from .text import to_error
from .track import Track, compute_kinetic, compute_momentum, find_moves


class Drawing(NamedTuple):
    """A motion, the colours of its picture, and the times that get a mark [s]."""

    track: Track
    palette: style.Palette
    marks: Floats


def _faded(axes: Any, points: Floats, front: Any, colour: str, width: float, zorder: float) -> None:
    """Draw a curve on the ellipsoid; what is behind it, faintly."""
    for seen, alpha in ((False, 0.25), (True, 1.0)):
        shown = points.copy()
        shown[front != seen] = np.nan
        axes.plot(*shown.T, color=colour, linewidth=width, alpha=alpha, zorder=zorder + seen, solid_capstyle="round")


def _mark_times(axes: Any, drawing: Drawing) -> None:
    """A faint line at each marked time, for axes with time to the right."""
    for t in drawing.marks:
        axes.axvline(t, color=drawing.palette.floor, linewidth=0.9, linestyle=(0, (4, 3)), zorder=1)


def _mark_path(axes: Any, drawing: Drawing, path: Floats) -> None:
    """A dot with its time on a path that has a point for each time of the curve."""
    curve, palette = drawing.track.curve, drawing.palette
    for t in drawing.marks:
        if curve.t[0] <= t <= curve.t[-1]:
            x, y = (float(np.interp(t, curve.t, path[:, k])) for k in (0, 1))
            axes.plot(x, y, marker="o", markersize=4.5, color=palette.paper, markeredgecolor=palette.ink, zorder=8.5)
            axes.annotate(f"{t:.3g} s", (x, y), xytext=(5, 4), textcoords="offset points", fontsize=7.5,
                          color=palette.ink, zorder=9)


def _solid(axes: Any, semi: Floats, view: Any, palette: style.Palette) -> None:
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.fill(*outline(semi, view).T, facecolor=palette.solid, edgecolor=palette.floor, linewidth=1.0, zorder=1)


def _principal_axes(axes: Any, semi: Floats, paper: Floats, palette: style.Palette) -> None:
    for k in range(3):
        tip, beyond = (reach * semi[k] * paper[k] for reach in (1.0, 1.18))
        axes.plot(*np.stack([tip, beyond]).T, color=palette.quiet, linewidth=1.0, zorder=1.5)
        axes.annotate(f"axis {k + 1}", beyond, color=palette.quiet, fontsize=8, ha="center", va="center", zorder=7,
                      xytext=14 * beyond / np.linalg.norm(beyond), textcoords="offset points")


def _polhode(axes: Any, drawing: Drawing) -> None:
    (scene, *_), curve, palette = drawing.track, drawing.track.curve, drawing.palette
    view = make_view()
    paper = np.stack([view.right, view.up], axis=1)
    moments = np.asarray(scene.carrier_inertia.moments)
    w = curve.omega @ np.asarray(scene.carrier_inertia.axes)   # R_BP^T omega_B
    energies = w**2 @ moments
    if not energies[0] > 0:
        axes.set_axis_off()
        axes.set_title("polhode: the body starts at rest")
        return
    semi = np.sqrt(energies[0] / moments)
    _solid(axes, semi, view, palette)
    plain, separatrix = family(moments, float(energies[0]))
    curves = ((plain, palette.floor, 0.7), (separatrix, palette.quiet, 1.2))
    for points, colour, width in () if scene.rotors else curves:   # the family is that of free bodies
        for path in points:
            _faded(axes, path @ paper, in_front(path, semi, view), colour, width, 2)
    _principal_axes(axes, semi, paper, palette)
    varies = np.ptp(energies) > 1e-6 * energies.max()
    front = w @ view.towards >= 0 if varies else in_front(w, semi, view)
    _faded(axes, w @ paper, front, palette.accent, 2.0, 4)
    axes.plot(*(w[0] @ paper), marker="o", markersize=6, color=palette.ink, zorder=8)
    _mark_path(axes, drawing, w @ paper)
    axes.set_title("polhode: the tip of ω on the ellipsoid of its energy" if not varies else
                   "path of ω; ellipsoid of the start's energy", pad=16)


def _momentum(axes: Any, drawing: Drawing) -> None:
    """The momentum in body axes on the sphere of its length, with the curves that free bodies follow there."""
    (scene, *_), curve, palette = drawing.track, drawing.track.curve, drawing.palette
    view = make_view()
    paper = np.stack([view.right, view.up], axis=1)
    inertia = scene.carrier_inertia
    momentum = compute_momentum(scene, curve.t, curve.omega, curve.states) @ np.asarray(inertia.axes)
    size = float(np.linalg.norm(momentum[0]))
    if not size > 0:
        axes.set_axis_off()
        axes.set_title("momentum sphere: L is 0 at the start")
        return
    path, sphere, moments = momentum / size, np.ones(3), np.asarray(inertia.moments)
    _solid(axes, sphere, view, palette)
    plain, separatrix = family(moments, 1.0)
    curves = () if scene.rotors else ((plain, palette.floor, 0.7), (separatrix, palette.quiet, 1.2))
    for points, colour, width in curves:
        for w in points:   # I omega has one length along a polhode: drawn on the sphere of that length
            shown = w * moments / np.linalg.norm(w * moments, axis=1, keepdims=True)
            _faded(axes, shown @ paper, in_front(shown, sphere, view), colour, width, 2)
    _principal_axes(axes, sphere, paper, palette)
    varies = np.ptp(np.linalg.norm(path, axis=1)) > 1e-6
    _faded(axes, path @ paper, path @ view.towards >= 0, palette.accent, 2.0, 4)
    axes.plot(*(path[0] @ paper), marker="o", markersize=6, color=palette.ink, zorder=8)
    _mark_path(axes, drawing, path @ paper)
    axes.set_title("path of L in the body; sphere of the start" if varies else
                   "momentum sphere: the tip of L in the body", pad=16)


def _herpolhode(axes: Any, drawing: Drawing) -> None:
    curve, palette = drawing.track.curve, drawing.palette
    assert curve.attitude is not None
    rotation = Rotation.from_quat(curve.attitude)
    first = compute_momentum(drawing.track.scene, curve.t[:1], curve.omega[:1], curve.states[:1])
    momentum = rotation[0].apply(first[0])
    axes.set_aspect("equal")
    axes.set_title("herpolhode: the tip of ω in space, across L")
    axes.set_xlabel("rad/s")
    if not np.linalg.norm(momentum) > 0:
        return
    path = herpolhode(rotation.apply(curve.omega), momentum)
    axes.plot(*path.T, color=palette.path, linewidth=1.1)
    axes.plot(*path[0], marker="o", markersize=6, color=palette.ink)
    axes.plot(0, 0, marker="+", markersize=9, color=palette.quiet)
    axes.annotate("L", (0, 0), xytext=(5, 4), textcoords="offset points", color=palette.quiet, fontsize=9)
    _mark_path(axes, drawing, path)
    reach = 1.12 * max(float(np.abs(path).max()), 1e-300)   # the same room on both axes, the origin included
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)


def _axis(axes: Any, drawing: Drawing) -> None:
    """The path of body z on the unit sphere."""
    curve, palette, view = drawing.track.curve, drawing.palette, make_view(-60.0, 30.0)
    assert curve.attitude is not None
    z = Rotation.from_quat(curve.attitude).apply(np.array([0.0, 0.0, 1.0]))
    paper, sphere = np.stack([view.right, view.up], axis=1), np.ones(3)
    _solid(axes, sphere, view, palette)
    angle = np.linspace(0, 2 * math.pi, 181)
    for height in (-60, -30, 0, 30, 60):
        r, h = math.cos(math.radians(height)), math.sin(math.radians(height))
        ring = np.stack([r * np.cos(angle), r * np.sin(angle), np.full(181, h)], axis=1)
        _faded(axes, ring @ paper, in_front(ring, sphere, view), palette.floor, 1.0 if height == 0 else 0.5, 2)
    up = np.array([[0, 0, 1.0], [0, 0, 1.22]]) @ paper
    axes.plot(*up.T, color=palette.quiet, linewidth=1.0, zorder=1.5)
    axes.annotate("space z", up[1], xytext=(0, 6), textcoords="offset points", color=palette.quiet, fontsize=8,
                  ha="center")
    _faded(axes, z @ paper, in_front(z, sphere, view), palette.path, 1.4, 4)
    axes.plot(*(z[0] @ paper), marker="o", markersize=6, color=palette.ink, zorder=8)
    _mark_path(axes, drawing, z @ paper)
    axes.set_title("path of the body's z axis in space", pad=16)


def _components(axes: Any, drawing: Drawing, values: Floats, names: str) -> None:
    t, palette = drawing.track.curve.t, drawing.palette
    for k, name in enumerate(names):
        axes.plot(t, values[:, k], color=palette.lines[k], linewidth=1.3, label=name)
    _mark_times(axes, drawing)
    axes.set_xlabel("t [s]")
    axes.legend(frameon=False, fontsize=8.5, ncols=len(names), loc="lower right", bbox_to_anchor=(1.0, 0.99),
                borderaxespad=0.1, handlelength=1.1, columnspacing=0.9)


def _rates(axes: Any, drawing: Drawing) -> None:
    _components(axes, drawing, drawing.track.curve.omega, "xyz")
    axes.set_title("ω in body axes")
    axes.set_ylabel("rad/s")


def _attitude(axes: Any, drawing: Drawing) -> None:
    attitude = drawing.track.curve.attitude
    assert attitude is not None
    signs = np.cumprod(np.concatenate([[1.0], np.where(np.sum(attitude[1:] * attitude[:-1], axis=1) < 0, -1.0, 1.0)]))
    _components(axes, drawing, attitude * signs[:, None], "xyzw")   # q and -q are one attitude: no jumps
    axes.set_title("attitude, body to space")
    axes.set_ylabel("quaternion")


def angles(drawing: Drawing, axes: list[Any]) -> None:
    """Draw the z-x-z angles into three axes, or into one."""
    curve = drawing.track.curve
    assert curve.attitude is not None
    rotation = Rotation.from_quat(curve.attitude)
    values = np.array(rotation.as_euler("ZXZ"))
    values[np.asarray(rotation.gimbal_lock("ZXZ"))] = np.nan   # there phi and psi are one angle
    one = len(axes) == 1
    for k, (name, colour) in enumerate(zip("φθψ", drawing.palette.lines)):
        place = axes[0] if one else axes[k]
        good = np.isfinite(values[:, k])
        if k != 1:
            values[good, k] = np.unwrap(values[good, k])
        place.plot(curve.t, values[:, k], color=colour, linewidth=1.3, label=name)
        if not one:
            place.set_ylabel(f"{name} [rad]", color=colour, fontsize=9)
            place.tick_params(labelbottom=k == 2)
    for place in axes:
        _mark_times(place, drawing)
    axes[0].set_title("z-x-z angles")
    axes[-1].set_xlabel("t [s]")
    if one:
        axes[0].set_ylabel("rad")
        axes[0].legend(frameon=False, fontsize=8.5)


def _energy(axes: Any, drawing: Drawing) -> None:
    """The energy less that of the start; relative where it is conserved."""
    track = drawing.track
    order = np.argsort(track.t, kind="stable")
    needs = any(t.traits["has_potential"] for t in track.scene.torques)
    kept = "energy" in track.drift
    sees = kept or not needs or track.attitude is not None
    total = (np.asarray(energy(track.scene, track.t, track.omega, track.attitude, track.states)) if sees
             else compute_kinetic(track))
    total = total[order]
    change = total - total[0]
    size = max(float(compute_kinetic(track).max()), float(np.abs(total).max()))
    if kept and size > 0:
        change = change / size
    axes.plot(track.t[order], change, color=drawing.palette.accent, marker=".", markersize=3,
              linewidth=0.8, alpha=0.8)
    _mark_times(axes, drawing)
    axes.set_xlabel("t [s]")
    axes.set_ylabel("relative" if kept else "J")
    axes.set_title(f"energy drifted by {to_error(float(np.abs(change).max()))}" if kept else
                   "energy less that of the start")


def _invariants(axes: Any, drawing: Drawing) -> None:
    """What should hold, as its distance from the start; where nothing holds, energy and |L| themselves."""
    track = drawing.track
    series = find_moves(track)
    order = np.argsort(track.t, kind="stable")
    colours = drawing.palette.lines[1], drawing.palette.lines[0]
    axes.set_xlabel("t [s]")
    if series:
        for (name, values), colour in zip(series.items(), colours):
            seen = np.where(values > 0, values, np.nan)   # what is exact has no place on this axis
            axes.plot(track.t, seen, color=colour, marker=".", markersize=3, linestyle="none", alpha=0.7, label=name)
        worst = max(float(v.max()) for v in series.values())
        axes.set_yscale("log")
        axes.set_ylim(1e-17, 100 * max(1e-15, worst))
        axes.set_title(f"invariants drifted by {to_error(worst)}")
        axes.set_ylabel("relative, from the start")
        axes.legend(frameon=False, fontsize=8.5, loc="upper left", markerscale=3)
    else:
        size = np.linalg.norm(compute_momentum(track.scene, track.t, track.omega, track.states), axis=1)
        for name, values, colour in zip(("kinetic energy", "|L|"), (compute_kinetic(track), size), colours):
            start = values[order][0]
            axes.plot(track.t[order], (values / start if start > 0 else values)[order], color=colour, linewidth=1.5,
                      label=name)
        axes.set_title("nothing is kept: energy and |L| as they go")
        axes.set_ylabel("times the start's")
        axes.legend(frameon=False, fontsize=8.5)
    _mark_times(axes, drawing)


UNITS = {"torque": "N m", "dipole": "A m²", "rotor_torque": "N m", "rotor_momentum": "N m s"}


def _commands(axes: Any, drawing: Drawing) -> None:
    """What controllers command, as it acts: from the delay after a tick to the next command, or for its width."""
    track, palette = drawing.track, drawing.palette
    end, most = track.curve.t[-1], 0
    for i, (controller, ticks) in enumerate(zip(track.scene.controllers, track.ticks, strict=True)):
        begins = ticks.t + controller.delay
        ends = np.append(begins[1:], max(end, *begins[-1:])) if ticks.t.size else begins
        if controller.width is not None:
            ends = np.minimum(begins + controller.width, ends)
        seen = begins <= end
        t = np.stack([begins, begins, ends, ends], axis=1)[seen].ravel()
        for k in range(ticks.command.shape[1]):
            held = ticks.command[seen, k]
            beside = held if controller.width is None else np.zeros_like(held)
            name = "xyz"[k] if controller.output in ("torque", "dipole") else str(k)
            label = name if len(track.ticks) == 1 else f"{i} {name}"
            values = np.stack([beside, held, held, beside], axis=1).ravel()
            axes.plot(np.minimum(t, end), values, linewidth=1.2, label=label, linestyle=("-", "--", ":")[i % 3],
                      color=palette.lines[k % len(palette.lines)])
        most += int(seen.sum())
    _mark_times(axes, drawing)
    axes.set_xlabel("t [s]")
    axes.set_ylabel(", ".join(sorted({UNITS[one.output] for one in track.scene.controllers})))
    axes.set_title(f"commands: {most} ticks" if track.ticks else "commands: the scene has no controller")
    if most:
        axes.legend(frameon=False, fontsize=8.5, ncols=6, loc="lower right", bbox_to_anchor=(1.0, 0.99),
                    borderaxespad=0.1, handlelength=1.1, columnspacing=0.9)


DRAW: dict[str, Callable[[Any, Drawing], None]] = {
    "polhode": _polhode, "herpolhode": _herpolhode, "momentum": _momentum, "axis": _axis, "rates": _rates,
    "attitude": _attitude, "angles": lambda axes, drawing: angles(drawing, [axes]), "energy": _energy,
    "invariants": _invariants, "commands": _commands,
}
WITHOUT_ATTITUDE = ("polhode", "momentum", "rates", "energy", "invariants", "commands")
