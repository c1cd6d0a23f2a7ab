"""What a notebook shows of a scene, mass properties, a rotation, a fit and many motions."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from .html import _frame, _list, _number, _table
from .text import to_error

MOST = 10   # rows of an array


def of_scene(scene: Any) -> str:
    """Return the body, its start, its torques and its times."""
    rows = [["moments [kg m²]", _number(scene.inertia.moments)], ["ω at the start [rad/s]", _number(scene.omega)],
            ["attitude (x, y, z, w)", _number(scene.attitude)]]
    rows += [["torque", escape(repr(torque))] for torque in scene.torques]
    rows += [["rotor", escape(repr(rotor))] for rotor in scene.rotors]
    rows += [[name, escape(repr(part))] for name in ("damper", "momentum")
             if (part := getattr(scene, name)) is not None]
    rows += [["controller", escape(repr(controller))] for controller in scene.controllers]
    times = scene.times
    rows += [["times [s]", f"{times.size} from {times.min():g} to {times.max():g}, start at {scene.t0:g}"],
             ["wants", escape(", ".join(scene.want))]]
    return _frame("Scene", scene.name or "unnamed", _table(rows))


def of_mass_properties(body: Any) -> str:
    """Return mass, centre of mass and tensor."""
    tensor = body.inertia
    rows = [["mass [kg]", _number(body.mass)], ["centre of mass [m]", _number(body.com)],
            ["moments about it [kg m²]", _number(tensor.moments)]]
    matrix = _table([[_number(value) for value in row] for row in tensor.matrix])
    return _frame("MassProperties", "tensor about the centre of mass [kg m²]", _table(rows), matrix)


def of_rotation(rotation: Any) -> str:
    """Return the quaternions with angle and axis; of many the first ones."""
    quat = np.reshape(rotation.as_quat(), (-1, 4))
    vectors = np.reshape(rotation.as_rotvec(), (-1, 3))
    angles = np.linalg.norm(vectors, axis=1)
    axes = np.divide(vectors, angles[:, None], out=np.zeros_like(vectors), where=angles[:, None] > 0)
    rows = [[_number(quat[k]), f"{np.degrees(angles[k]):.6g}", _number(axes[k]) if angles[k] else ""]
            for k in range(min(MOST, len(quat)))]
    count = "" if rotation.single else f"{len(quat)} rotations" + (f", the first {MOST}" if len(quat) > MOST else "")
    return _frame("Rotation", count, _table(rows, ("quaternion (x, y, z, w)", "angle [deg]", "axis")))


def of_fit(fit: Any) -> str:
    """Return the parameters with their errors, chi2, and what the data cannot tell."""
    rows = [[escape(name), f"{value:.9g}", "not observable" if np.isnan(error) else f"{error:.2g}"]
            for name, value, error in zip(fit.parameters, fit.x, fit.stderr, strict=True)]
    known = [f"chi2 {fit.chi2:.6g} for {fit.dof} degrees of freedom", fit.message]
    known += [f"moments over the largest: {_number(fit.moments)}"]
    known += [f"not observable: {text}" for text in fit.unobservable] + [f"twin: {text}" for text in fit.twins]
    table = _table(rows, ("parameter", "value", "standard error"))
    return _frame(f"{'✓' if fit.success else '✗'} FitResult", f"{len(fit.candidates)} minima", table, _list(known))


def of_motions(motions: Any) -> str:
    """Return what became of the bodies; of many the first ones."""
    count = len(motions.status)
    rows = [[str(k), escape(motions.method[k]), escape(motions.status[k]), f"{motions.t_reached[k]:.6g}",
             to_error(motions.error[k]), f"{motions.steps[k]:,}"] for k in range(min(MOST, count))]
    under = f"{count:,} bodies, {int(motions.success.sum()):,} with success, {int(motions.steps.sum()):,} steps"
    under += f"; the first {MOST}" if count > MOST else ""
    return _frame("Motions", under, _table(rows, ("body", "method", "status", "reached [s]", "error", "steps")))
