"""Torques on orbits that are proved negligible: their bounds against runs with them."""

import numpy as np
import pytest

import polhode as ph

MU = 3.986e14
ORBITS = {
    "eccentric": ph.Orbit.from_elements(MU, a=4.2e7, e=0.6, inclination=0.5),
    "low with j2": ph.Orbit.from_elements(MU, a=6.9e6, e=0.002, inclination=1.7, j2=1.08e-3, radius=6.4e6),
    "flyby": ph.Orbit.from_elements(MU, periapsis_distance=7e6, e=2.0, anomaly=-0.5),
    "parabola": ph.Orbit.from_elements(MU, periapsis_distance=7e6, e=1.0, anomaly=0.3),
    "radial": ph.Orbit(MU, (8e6, 0, 0), (3e3, 0, 0)),
}
FACES = [ph.Plate(0.03, n, (0.06, 0.02, 0.0), 0.3) for n in ((1, 0, 0), (-1, 0, 0))]


def make(kind, orbit):
    if kind == "gradient":
        return ph.torques.GravityGradient(orbit=orbit)
    if kind == "dipole":
        return ph.torques.Dipole((1e-3, 2e-3, 0), ph.MagneticField.dipole(orbit, 7.9e15, tilt=2.97, spin=7.29e-5))
    if kind == "drag":
        return ph.torques.Drag(FACES, orbit, 2.2, 3e-12, 6.7e6, 6e4, spin=7.29e-5)
    return ph.torques.SolarPressure(FACES, (1, 0.2, 0), 4.5e-6, orbit=orbit, shadow=6.3e6)


def find_effect(scene):
    """The largest change of the rates by the torques, by two runs."""
    runs = [ph.solve(scene, method="taylor", rtol=1e-15),
            ph.solve(scene.replace(torques=[ph.torques.Constant((1e-30, 0, 0))]), method="taylor", rtol=1e-15)]
    return np.abs(runs[0].omega - runs[1].omega).max()


@pytest.mark.parametrize("kind", ["gradient", "dipole", "drag", "light"])
@pytest.mark.parametrize("name", ORBITS)
def test_the_bound_holds(name, kind):
    if (name, kind) == ("radial", "light"):
        pytest.skip("a radial orbit meets the centre, which lies in the shadow")
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(0.1, 0.2, -0.1), times=np.linspace(0, 6, 4),
                     attitude=ph.Rotation.from_rotvec((0.4, 0.7, -0.2)).as_quat(), torques=[make(kind, ORBITS[name])])
    bound = ph.effect(scene)
    assert bound.kind == "bounded", bound.reason
    assert find_effect(scene) <= bound.omega * (1 + 1e-6) + 1e-15


def test_the_bound_of_a_gradient_is_sharp():
    """A body that stands in the worst attitude at the periapsis: half of the bound is there."""
    orbit = ph.Orbit.from_elements(1e-4, periapsis_distance=1.0, e=0.5)
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 1), torques=[ph.torques.GravityGradient(orbit=orbit)],
                     attitude=ph.Rotation.from_rotvec((0, np.pi / 4, 0)).as_quat(), times=[0.01])
    bound = ph.effect(scene)
    exact = 1.5e-4 * 1.5 * 0.01   # 3 mu / r^3 (I3 - I1) / 2 over the time, and over the moment 2 about that axis
    assert find_effect(scene) == pytest.approx(exact / 2, rel=2e-2)
    assert exact / 2 <= bound.omega <= 1.1 * exact


def test_weak_torques_on_orbits_leave_a_closed_form():
    orbit = ORBITS["eccentric"]
    scene = ph.Scene(inertia=(10, 20, 25), omega=(0.1, 0.02, 1.0), times=np.linspace(0, 60, 5),
                     torques=[make("gradient", ORBITS["flyby"]), make("dipole", orbit)])
    assert ph.plan(scene, accuracy=1e-12).left_out == ()
    scene = scene.replace(torques=[make("dipole", orbit), make("light", orbit)])
    motion = ph.solve(scene, accuracy=1e-3)
    assert motion.plan.method == "exact" and [record.torque for record in motion.plan.left_out] == [0, 1]
    whole = ph.solve(scene, accuracy=1e-12)
    assert np.abs(motion.omega - whole.omega).max() <= motion.error * motion.omega_scale
