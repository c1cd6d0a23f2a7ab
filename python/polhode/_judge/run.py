"""`polhode.judge`: from samples to findings."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._core import InertiaTensor, InvalidInput
from .._scene.scene import Scene
from .findings import Finding, ordered
from .judgement import Deviation, Judgement, Repaired
from .read import numbers, read
from .states import Array
from .work import Work


def judge(
    t: Any,
    attitude: Any = None,
    omega: Any = None,
    *,
    inertia: Any = None,
    scene: Scene | None = None,
    order: str = "xyzw",
    frame: str = "body",
    euler: str | None = None,
    degrees: bool = False,
    tolerance: float = 1e-6,
    sigma: Any = None,
) -> Judgement:
    """Judge samples of a rotational motion: what is wrong with them, by how much, and why.

    Arguments state what the user believes. A finding says where the data disagree.

    Parameters
    ----------
    t : array_like, shape (n,)
        Times [s], ascending.
    attitude : array_like of shape (n, 4), (n, 3, 3) or (n, 3), or a Rotation, optional
        Body to space: quaternions, matrices, or Euler angles with `euler`.
    omega : array_like, shape (n, 3), optional
        Angular velocity [rad/s]. One of attitude and omega is enough.
    inertia : InertiaTensor, or array_like of shape (3,) or (3, 3), optional
        Of a free body [kg m^2]. Without it and without a scene the inertia is fitted.
    scene : Scene, optional
        Inertia, torques and rotors. Its start is a claim too, and is checked.
    order : {'xyzw', 'wxyz'}
        Where the quaternions' scalar stands.
    frame : {'body', 'space'}
        The axes of `omega`.
    euler : str, optional
        The sequence of Euler angles, as in :meth:`Rotation.from_euler`.
    degrees : bool
        Angles and rates are in degrees, and degrees a second.
    tolerance : float
        Warnings with a smaller effect become remarks [rad]; for rates relative to their rms.
    sigma : float or pair of float, optional
        Standard deviations of the noise, of rates [rad/s] and attitude [rad]. By default the noise is estimated.

    Returns
    -------
    Judgement

    Raises
    ------
    InvalidInput
        Arrays of other shapes or lengths, or options that contradict each other. Faults of the data are findings.

    Notes
    -----
    See docs/judge.md for the algorithm and for what no data can tell.
    """
    if inertia is not None and scene is not None:
        raise InvalidInput("inertia: must be left out with scene, which has one; got both")
    if scene is not None and not isinstance(scene, Scene):
        raise InvalidInput(f"scene: must be a polhode.Scene, got {type(scene).__name__}")
    if scene is not None:
        _refuse(scene)
    if not (isinstance(tolerance, (int, float)) and 0 <= tolerance < 1e300):
        raise InvalidInput(f"tolerance: must be a number from 0 up, got {tolerance!r}")
    deviations = None if sigma is None else numbers([sigma] if isinstance(sigma, (int, float)) else sigma, "sigma", ())
    if deviations is not None and not (
        len(deviations) in (1, 2) and np.all(deviations > 0) and np.all(np.isfinite(deviations))
    ):
        raise InvalidInput(f"sigma: must be a positive number, or two for rates and attitude, got {sigma!r}")
    body = _body(inertia, scene)
    samples, findings = read(t, attitude, omega, order, frame, euler, degrees)
    if samples is None:
        return _unread(np.asarray(t, float), findings)
    return Work(samples, findings, body, scene, float(tolerance), deviations).run()


def _refuse(scene: Scene) -> None:
    """Refuse scenes whose motion has more states than rates and attitude: samples do not show these."""
    for there, what in (
        (scene.changing is not None or scene.momentum is not None, "a body of constant inertia and momentum, "
         "got one that changes"),
        (scene.damper is not None, "no damper, got one"),
        (bool(scene.controllers), "no controllers, whose outputs samples do not show, got some"),
        (any(name.startswith("rotor_momentum_") for name in scene.states), "no motors or friction of rotors, "
         "got some"),
        (bool(scene.states), f"no formulas with states of their own, got {', '.join(scene.states)}"),
    ):
        if there:
            raise InvalidInput(f"scene: must have {what}")


def _body(inertia: Any, scene: Scene | None) -> Array | None:
    if scene is not None:
        matrix: Array = scene.inertia.matrix
        return matrix
    if inertia is None:
        return None
    if isinstance(inertia, InertiaTensor):
        given: Array = inertia.matrix
        return given
    try:
        moments = np.shape(inertia) == (3,)
    except MemoryError:
        raise
    except Exception:  # InertiaTensor says what is wrong with it
        moments = False
    return InertiaTensor.from_moments(inertia).matrix if moments else InertiaTensor(inertia).matrix


def _unread(t: Array, findings: list[Finding]) -> Judgement:
    return Judgement(
        ordered(findings),
        Deviation(),
        ("nothing but the data was judged",),
        Repaired(t, None, None),
        None,
        Deviation(),
        (),
        {},
        len(t),
        0.0,
    )
