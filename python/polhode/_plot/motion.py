"""Pictures of a motion: polhode, herpolhode, path of the axis, z-x-z angles, and drift of invariants."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import torques
from .._attitude.rotation import Rotation
from .._core import InvalidInput, angular_momentum, energy
from .._solve.motion import Floats, Motion
from .._solve.solve import solve
from . import style
from .poinsot import family, herpolhode, in_front, make_view, outline
from .text import to_error

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PARTS = ("polhode", "herpolhode", "axis", "angles", "invariants")
TURNS = 40        # a curve longer than this many turns is drawn up to there, or it covers itself
FINE = 0.05       # radians of turn between two points of a curve
MOST = 20_000     # points of a curve


class Curve(NamedTuple):
    """The motion, finely enough to be drawn as a line."""

    t: Floats
    omega: Floats
    attitude: Floats | None
    whole: bool   # whether it is the whole motion


def _fine(motion: Motion) -> Curve:
    """Return the motion itself where its samples are close enough for a line, else the start of it, solved again."""
    motion._need("omega")
    assert motion.omega is not None
    order = np.argsort(motion.t, kind="stable")
    t, omega = motion.t[order], motion.omega[order]
    attitude = None if motion.attitude is None else motion.attitude[order]
    rate = float(np.linalg.norm(omega, axis=1).max())
    span = float(t[-1] - t[0])
    if t.size < 2 or rate * span == 0:
        return Curve(t, omega, attitude, True)
    drawn = min(span, TURNS * 2 * math.pi / rate)
    gaps = np.diff(t)
    if rate * gaps.max() <= 2 * FINE:
        kept = t <= t[0] + drawn
        return Curve(t[kept], omega[kept], None if attitude is None else attitude[kept], bool(kept.all()))
    times = np.linspace(t[0], t[0] + drawn, min(MOST, int(rate * drawn / FINE) + 2))
    if motion._answer is not None and motion._answer.has_dense:
        return Curve(times, *motion(times), drawn == span)
    if motion.status not in ("finished", "event"):
        return Curve(t, omega, attitude, True)   # nothing is known beyond what there is
    again = solve(motion.scene.replace(times=times), accuracy=1e-6)
    if again.status != "finished" or again.omega is None:
        return Curve(t, omega, attitude, True)
    return Curve(times, again.omega, again.attitude, drawn == span)


def _wanted(motion: Motion, parts: tuple[str, ...]) -> list[str]:
    for part in parts:
        if part not in PARTS:
            raise InvalidInput(f"plot: must be of {', '.join(PARTS)}; got {part!r}")
        motion._need("omega", *(["attitude"] if part not in ("polhode", "invariants") else []))
    if parts:
        return list(parts)
    motion._need("omega")
    if motion.attitude is None:
        return ["polhode", "invariants"]
    return ["polhode", "axis" if motion.scene.torques else "herpolhode", "angles", "invariants"]


def plot(motion: Motion, *parts: str) -> Figure:
    """Draw a motion; see `Motion.plot`."""
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise InvalidInput("plot: needs matplotlib: pip install 'polhode[plot]'") from None
    wanted = _wanted(motion, parts)
    if len(motion) == 0:
        raise InvalidInput("plot: the motion holds no samples")
    curve = _fine(motion)
    columns = 1 if len(wanted) == 1 else 2
    rows = -(-len(wanted) // columns)
    with style.settings():
        width, height = 5.2 * columns, 4.4 * rows + 0.9
        figure = Figure(figsize=(width, height))
        grid = figure.add_gridspec(rows, columns, left=0.75 / width, right=1 - 0.3 / width, bottom=0.55 / height,
                                   top=1 - 1.35 / height, wspace=0.28, hspace=0.34)
        for index, part in enumerate(wanted):
            cell = grid[divmod(index, columns)]
            _DRAW[part](figure, cell, motion, curve)
        style.heading(figure, *_words(motion, curve), 0.3 / width)
    return figure


def _words(motion: Motion, curve: Curve) -> tuple[str, str]:
    scene = motion.scene
    acting = ", ".join(type(torque).__name__ for torque in scene.torques) or "no torque"
    if scene.rotors:
        acting += f"; {len(scene.rotors)} rotor" + ("s" if len(scene.rotors) > 1 else "")
    moments = ", ".join(f"{m:.4g}" for m in scene.inertia.moments)
    under = f"moments {moments} kg m²; {acting}; {len(motion)} samples by {motion.plan.method}"
    if not curve.whole:
        under += f"; curves: the first {curve.t[-1] - curve.t[0]:.3g} s of {np.ptp(motion.t):.4g} s"
    return scene.name or "Motion", under


def _faded(axes: Any, points: Floats, front: Any, colour: str, width: float, zorder: float) -> None:
    """Draw a curve on the ellipsoid; what is behind it, faintly."""
    for seen, alpha in ((False, 0.25), (True, 1.0)):
        shown = points.copy()
        shown[front != seen] = np.nan
        axes.plot(*shown.T, color=colour, linewidth=width, alpha=alpha, zorder=zorder + seen, solid_capstyle="round")


def _polhode(figure: Any, cell: Any, motion: Motion, curve: Curve) -> None:
    axes, view = figure.add_subplot(cell), make_view()
    paper = np.stack([view.right, view.up], axis=1)
    inertia = motion.scene.carrier_inertia
    moments = np.asarray(inertia.moments)
    w = curve.omega @ np.asarray(inertia.axes)   # R_BP^T omega_B
    energies = w**2 @ moments
    axes.set_aspect("equal")
    axes.set_axis_off()
    title = "polhode: the tip of ω on the ellipsoid of its energy"
    if not energies[0] > 0:
        axes.set_title("polhode: the body starts at rest")
        return
    semi = np.sqrt(energies[0] / moments)
    axes.fill(*outline(semi, view).T, facecolor="#f3f6f9", edgecolor=style.FLOOR, linewidth=1.0, zorder=1)
    plain, separatrix = family(moments, float(energies[0]))
    curves = ((plain, style.FLOOR, 0.7), (separatrix, style.QUIET, 1.2))
    for points, colour, width in () if motion.scene.rotors else curves:   # the family is that of free bodies
        for path in points:
            _faded(axes, path @ paper, in_front(path, semi, view), colour, width, 2)
    for k in range(3):
        end = np.zeros(3)
        end[k] = semi[k]
        tip, beyond = end @ paper, 1.18 * end @ paper
        axes.plot(*np.stack([tip, beyond]).T, color=style.QUIET, linewidth=1.0, zorder=1.5)
        axes.annotate(f"axis {k + 1}", beyond, color=style.QUIET, fontsize=8, ha="center", va="center", zorder=7,
                      xytext=14 * beyond / np.linalg.norm(beyond), textcoords="offset points")
    moved = np.ptp(energies) > 1e-6 * energies.max()
    front = w @ view.towards >= 0 if moved else in_front(w, semi, view)
    _faded(axes, w @ paper, front, style.colour("FreeMotion"), 2.0, 4)
    axes.plot(*(w[0] @ paper), marker="o", markersize=6, color=style.INK, zorder=8)
    axes.set_title(title if not moved else "path of ω, with the ellipsoid of the energy at the start")


def _herpolhode(figure: Any, cell: Any, motion: Motion, curve: Curve) -> None:
    axes = figure.add_subplot(cell)
    assert curve.attitude is not None
    turn = Rotation.from_quat(curve.attitude)
    momentum = turn[0].apply(_momentum(motion, curve.t[:1], curve.omega[:1])[0])
    axes.set_aspect("equal")
    axes.set_title("herpolhode: the tip of ω in space, across L")
    axes.set_xlabel("rad/s")
    if not np.linalg.norm(momentum) > 0:
        return
    path = herpolhode(turn.apply(curve.omega), momentum)
    axes.plot(*path.T, color=style.colour("rk45"), linewidth=1.1)
    axes.plot(*path[0], marker="o", markersize=6, color=style.INK)
    axes.plot(0, 0, marker="+", markersize=9, color=style.QUIET)
    axes.annotate("L", (0, 0), xytext=(5, 4), textcoords="offset points", color=style.QUIET, fontsize=9)
    _square(axes, path)


def _momentum(motion: Motion, t: Floats, omega: Floats) -> Floats:
    """The momentum of body and rotors in body axes."""
    identity = np.tile([0.0, 0.0, 0.0, 1.0], (len(t), 1))
    return np.asarray(angular_momentum(motion.scene, np.ascontiguousarray(t), np.ascontiguousarray(omega), identity))


def _square(axes: Any, path: Floats) -> None:
    """The same room on both axes, the origin included."""
    reach = 1.12 * max(float(np.abs(path).max()), 1e-300)
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)


def _axis(figure: Any, cell: Any, motion: Motion, curve: Curve) -> None:
    """The path of body z on the unit sphere."""
    axes, view = figure.add_subplot(cell), make_view(-60.0, 30.0)
    assert curve.attitude is not None
    z = Rotation.from_quat(curve.attitude).apply(np.array([0.0, 0.0, 1.0]))
    paper, sphere = np.stack([view.right, view.up], axis=1), np.ones(3)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.fill(*outline(sphere, view).T, facecolor="#f3f6f9", edgecolor=style.FLOOR, linewidth=1.0, zorder=1)
    angle = np.linspace(0, 2 * math.pi, 181)
    for height in (-60, -30, 0, 30, 60):
        r, h = math.cos(math.radians(height)), math.sin(math.radians(height))
        ring = np.stack([r * np.cos(angle), r * np.sin(angle), np.full(181, h)], axis=1)
        _faded(axes, ring @ paper, in_front(ring, sphere, view), style.FLOOR, 1.0 if height == 0 else 0.5, 2)
    up = np.array([[0, 0, 1.0], [0, 0, 1.22]]) @ paper
    axes.plot(*up.T, color=style.QUIET, linewidth=1.0, zorder=1.5)
    axes.annotate("space z", up[1], xytext=(0, 6), textcoords="offset points", color=style.QUIET, fontsize=8,
                  ha="center")
    _faded(axes, z @ paper, in_front(z, sphere, view), style.colour("rk45"), 1.4, 4)
    axes.plot(*(z[0] @ paper), marker="o", markersize=6, color=style.INK, zorder=8)
    axes.set_title("path of the body's z axis in space")


def _angles(figure: Any, cell: Any, motion: Motion, curve: Curve) -> None:
    assert curve.attitude is not None
    turn = Rotation.from_quat(curve.attitude)
    angles = np.array(turn.as_euler("ZXZ"))
    angles[np.asarray(turn.gimbal_lock("ZXZ"))] = np.nan   # there phi and psi are one angle
    inner = cell.subgridspec(3, 1, hspace=0.18)
    for k, (name, colour) in enumerate((("φ", "#0072b2"), ("θ", "#d55e00"), ("ψ", "#009e73"))):
        axes = figure.add_subplot(inner[k])
        good = np.isfinite(angles[:, k])
        values = angles[:, k].copy()
        if k != 1:
            values[good] = np.unwrap(values[good])
        axes.plot(curve.t, values, color=colour, linewidth=1.3)
        axes.set_ylabel(f"{name} [rad]", color=colour, fontsize=9)
        axes.tick_params(labelbottom=k == 2)
        if k == 0:
            axes.set_title("z-x-z angles")
        if k == 2:
            axes.set_xlabel("t [s]")


def _invariants(figure: Any, cell: Any, motion: Motion, curve: Curve) -> None:
    """What should hold, as its distance from the start; where nothing holds, energy and |L| themselves."""
    axes = figure.add_subplot(cell)
    assert motion.omega is not None
    series = _moves(motion)
    order = np.argsort(motion.t, kind="stable")
    axes.set_xlabel("t [s]")
    if series:
        for (name, values), colour in zip(series.items(), ("#d55e00", "#0072b2")):
            seen = np.where(values > 0, values, np.nan)   # what is exact has no place on this axis
            axes.plot(motion.t, seen, color=colour, marker=".", markersize=3, linestyle="none", alpha=0.7, label=name)
        axes.set_yscale("log")
        axes.set_ylim(1e-17, 100 * max(1e-15, max(float(v.max()) for v in series.values())))
        worst = max(float(v.max()) for v in series.values())
        axes.set_title(f"invariants drifted by {to_error(worst)}")
        axes.set_ylabel("relative, from the start")
        axes.legend(frameon=False, fontsize=8.5, loc="upper left", markerscale=3)
        return
    kinetic = 0.5 * np.sum(motion.omega * (motion.omega @ motion.scene.carrier_inertia.matrix), axis=1)
    size = np.linalg.norm(_momentum(motion, motion.t, motion.omega), axis=1)
    for name, values, colour in (("kinetic energy", kinetic, "#d55e00"), ("|L|", size, "#0072b2")):
        start = values[order][0]
        axes.plot(motion.t[order], (values / start if start > 0 else values)[order], color=colour, linewidth=1.5,
                  label=name)
    axes.set_title("nothing is kept: energy and |L| as they go")
    axes.set_ylabel("times the start's")
    axes.legend(frameon=False, fontsize=8.5)


def _moves(motion: Motion) -> dict[str, Floats]:
    """How far energy and momentum are from their start, relative, of those that `motion.drift` says should hold."""
    assert motion.omega is not None
    scene, found = motion.scene, {}
    kinetic = 0.5 * np.sum(motion.omega * (motion.omega @ scene.carrier_inertia.matrix), axis=1)
    if "energy" in motion.drift:
        total = np.asarray(energy(scene, motion.t, motion.omega, motion.attitude))
        size = max(float(kinetic.max()), float(np.abs(total).max()))
        found["energy"] = np.abs(total - total[0]) / size if size > 0 else total
    if motion.attitude is not None and {"angular_momentum", "vertical_momentum"} & set(motion.drift):
        momentum = np.asarray(motion.angular_momentum)
        size = float(np.linalg.norm(momentum, axis=1).max())
        moved = momentum - momentum[0]
        away = np.linalg.norm(moved, axis=1) if "angular_momentum" in motion.drift else np.abs(moved[:, 2])
        name = "angular momentum" if "angular_momentum" in motion.drift else "vertical angular momentum"
        found[name] = away / size if size > 0 else away
    if "jacobi" in motion.drift:
        (torque,) = (t for t in scene.torques if isinstance(t, torques.GravityGradient))
        total = np.asarray(energy(scene, motion.t, motion.omega, motion.attitude))
        jacobi = total - torque.mean_motion * np.asarray(motion.angular_momentum)[:, 2]
        size = max(float(kinetic.max()), float(np.abs(jacobi).max()))
        found["Jacobi's integral"] = np.abs(jacobi - jacobi[0]) / size
    return found


_DRAW: dict[str, Any] = {"polhode": _polhode, "herpolhode": _herpolhode, "axis": _axis, "angles": _angles,
                         "invariants": _invariants}
