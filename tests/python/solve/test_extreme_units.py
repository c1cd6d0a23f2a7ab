"""Scenes in units of time and of inertia near the ends of float64: bounds hold, or no bound is given."""

import numpy as np
import pytest

import polhode as ph

T = ph.torques
TIMES = np.array((0.0, 1.0, 3.0))
KINDS = ("constant", "space", "gravity", "angular", "damping", "gradient", "rotor", "free")


def make(kind, unit, mass=1.0, want=("omega", "attitude")):
    """The same motion in another unit of time and of inertia, both powers of two: each number is scaled exactly."""
    force = mass / unit / unit if mass >= 1 else 1 / unit * mass / unit
    torques = {
        "constant": lambda: [T.Constant(np.array((0.1, -0.2, 0.06)) * force)],
        "space": lambda: [T.Constant(np.array((0.1, -0.2, 0.06)) * force, "space")],
        "gravity": lambda: [T.Gravity(force, (0.1, 0.2, 0.5))],
        "angular": lambda: [T.AngularDamping(0.25 / unit)],
        "damping": lambda: [T.Damping(np.diag((0.3, 0.2, 0.1)) * (mass / unit))],
        "gradient": lambda: [T.GravityGradient(0.5 / unit)],
    }
    rotors = [ph.Rotor((0, 0, 1), momentum=0.5 * (mass / unit))] if kind == "rotor" else []
    return ph.Scene(inertia=np.array((1.0, 1.5, 2.25)) * mass, omega=np.array((0.3, 0.5, 0.83)) / unit, want=want,
                    torques=torques.get(kind, list)(), rotors=rotors, times=TIMES * unit)


def check(kind, power, mass_power, method, want=("omega", "attitude")):
    unit = 2.0 ** power
    motion = ph.solve(make(kind, unit, 2.0 ** mass_power, want), 1e-9, method=method, max_steps=1000)
    known = ph.solve(make(kind, 1.0, want=want), 1e-12)
    if motion.error_kind not in ("bounded", "limit"):
        assert not motion.success, f"{kind}: {motion.error_kind}"
        return motion
    size = np.linalg.norm(known.omega, axis=1).max()
    error = np.linalg.norm(motion.omega * unit - known.omega, axis=1).max() / size
    if "attitude" in want:
        p, q = motion.attitude, known.attitude
        error = max(error, 2 * np.minimum(np.linalg.norm(p - q, axis=1), np.linalg.norm(p + q, axis=1)).max())
    assert error <= motion.error + 2e-12, f"{kind}: {error:.2g} of {motion.error:.2g}, {motion.error_kind}"
    return motion


# powers of two at which torques and rates are float64 numbers of full accuracy
UNITS = [(-480, 0), (480, 0), (-560, -540), (-700, -700), (-900, -900), (560, 540), (700, 700), (900, 900),
         (0, 900), (0, -900), (480, -40)]


@pytest.mark.parametrize("method", ["taylor", "dop853", "radau", None])
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(("power", "mass_power"), UNITS)
def test_bounds_hold_in_extreme_units(kind, power, mass_power, method):
    try:
        check(kind, power, mass_power, method)
    except ph.InvalidInput as refusal:
        assert power < -500   # rates or torques beyond float64
        assert any(word in str(refusal) for word in ("finite", "no reliable digits"))


@pytest.mark.parametrize("power", [-600, -900])
@pytest.mark.parametrize("kind", [None, "space"])
def test_a_constant_torque_over_a_tiny_span(kind, power):
    """Slow at first: the torque turns a body by far less than the rates change."""
    unit = 2.0 ** power
    torque = T.Constant((0, 0, 0.06 / unit), **({"frame": kind} if kind else {}))
    scene = ph.Scene(inertia=(1, 1, 1), omega=(0, 0, 0.83), torques=[torque], times=[3 * unit])
    motion = ph.solve(scene, method="taylor", accuracy=1e-9)
    assert motion.success and abs(motion.omega[0, 2] - 1.01) < 1e-14


@pytest.mark.parametrize("method", ["taylor", "dop853"])
def test_a_refused_scene_names_another_unit_of_time(method):
    motion = ph.solve(make("gravity", 2.0 ** 700, 2.0 ** 700), 1e-9, method=method)
    assert motion.error_kind == "limit" and "another unit of time helps" in motion.message
