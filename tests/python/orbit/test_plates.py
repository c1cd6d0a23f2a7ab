"""The air and the light on plates, against sums over the plates by NumPy."""

import pickle

import numpy as np
import pytest

import polhode as ph

ORBIT = ph.Orbit.from_elements(3.986e14, a=6.8e6, e=0.01, inclination=0.9, node=0.3)
AIR = dict(coefficient=2.2, density=3e-11, height_radius=6.7e6, scale_height=6e4, spin=7.29e-5)
# A box whose centre of mass is not in its middle, and a panel of two faces.
PLATES = [ph.Plate(0.03, normal, centre, 0.3, 0.2) for normal, centre in (
    ((1, 0, 0), (0.06, 0.01, 0.02)), ((-1, 0, 0), (-0.04, 0.01, 0.02)), ((0, 2, 0), (0.01, 0.06, 0.02)),
    ((0, -3, 0), (0.01, -0.04, 0.02)), ((0, 0, 1), (0.01, 0.01, 0.17)), ((0, 0, -1), (0.01, 0.01, -0.13)))]
PLATES += [ph.Plate(0.1, (0.6, 0, side), (0.3, 0.0, 0.1), 0.7, 0.1) for side in (0.8, -0.8)]
SUN = (2.0, -1.0, 0.5)
STARTS = ((0.0, (0.1, 0.2, 0.3)), (900.0, (2, -1, 0.5)), (5000.0, (0, 3, 0)))
STATES = [(t, ph.Rotation.from_rotvec(v)) for t, v in STARTS]


def drag(t, rotation, own=AIR):
    r, v = ORBIT.at(t)
    b = rotation.as_matrix().T @ (v - np.cross((0, 0, own["spin"]), r))
    rho = own["density"] * np.exp((own["height_radius"] - np.linalg.norm(r)) / own["scale_height"])
    total = np.zeros(3)
    for plate in PLATES:
        n = np.array(plate.normal) / np.linalg.norm(plate.normal)
        force = -own["coefficient"] / 2 * rho * plate.area * max(n @ b, 0) * b
        total += np.cross(plate.centre, force)
    return total


def light(t, rotation, pressure=4.5e-6):
    s = rotation.as_matrix().T @ (np.array(SUN) / np.linalg.norm(SUN))
    total = np.zeros(3)
    for plate in PLATES:
        n = np.array(plate.normal) / np.linalg.norm(plate.normal)
        c = max(n @ s, 0)
        along, across = 1 - plate.specular, 2 * (plate.specular * c + plate.diffuse / 3)
        force = -pressure * plate.area * c * (along * s + across * n)
        total += np.cross(plate.centre, force)
    return total


TORQUES = {"drag": (ph.torques.Drag(PLATES, ORBIT, **AIR), drag),
           "light": (ph.torques.SolarPressure(PLATES, SUN, 4.5e-6), light)}


@pytest.mark.parametrize("name", TORQUES)
def test_the_torque_is_the_sum_over_the_plates(name):
    torque, expected = TORQUES[name]
    for t, rotation in STATES:
        value = torque.value(t, (0, 0, 0), rotation.as_quat())
        np.testing.assert_allclose(value, expected(t, rotation), rtol=1e-11, atol=1e-14 * np.abs(value).max())


@pytest.mark.parametrize("name", TORQUES)
def test_a_body_that_tumbles_through_the_kinks(name):
    """Faces come into view and go: against DOP853 with the torque as a function of NumPy, in small steps."""
    torque, function = TORQUES[name]
    parts = dict(inertia=(2e-3, 3e-3, 4e-3), omega=(0.02, 0.01, -0.03), times=np.linspace(0, 600, 4))
    motion = ph.solve(ph.Scene(**parts, torques=[torque]), accuracy=1e-8)
    own = ph.torques.Custom(lambda t, omega, attitude: function(t, ph.Rotation.from_quat(attitude)))
    plain = ph.solve(ph.Scene(**parts, torques=[own]), method="dop853", rtol=1e-12)
    assert motion.success and motion.error <= 1e-8
    np.testing.assert_allclose(motion.omega, plain.omega, atol=3e-8 * np.abs(plain.omega).max())


@pytest.mark.parametrize("name", TORQUES)
def test_torques_on_plates_are_values(name, tmp_path):
    torque, _ = TORQUES[name]
    assert pickle.loads(pickle.dumps(torque)) == torque
    given = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 1), torques=[torque], times=[1.0])
    given.save(tmp_path / "scene.toml")
    assert ph.Scene.load(tmp_path / "scene.toml").torques == given.torques
    plate, same = PLATES[3], ph.Plate(0.03, (0, -3, 0), PLATES[3].centre, 0.3, 0.2)
    assert pickle.loads(pickle.dumps(plate)) == plate == same and hash(plate) == hash(same)


def test_a_face_away_from_the_light_feels_nothing():
    torque = ph.torques.SolarPressure(ph.Plate(1.0, (0, 0, 1), (1, 0, 0)), (0, 0, -1), 1.0)
    np.testing.assert_array_equal(torque.value(0.0, (0, 0, 0), (0, 0, 0, 1)), 0)
    np.testing.assert_allclose(torque.value(0.0, (0, 0, 0), (0, 1, 0, 0)), (0, 1, 0), atol=1e-16)


@pytest.mark.parametrize(("call", "words"), [
    (lambda: ph.Plate(-1.0, (0, 0, 1), (0, 0, 0)), "area: must be at least 0 and finite, got -1.0"),
    (lambda: ph.Plate(1.0, (0, 0, 0), (0, 0, 0)), "normal: must be not 0"),
    (lambda: ph.Plate(1.0, (0, 1), (0, 0, 0)), r"normal: must be of shape \(3,\)"),
    (lambda: ph.Plate(1.0, (0, 0, 1), (0, 0, 0), 0.7, 0.4), "together at most 1, got 0.7 and 0.4"),
    (lambda: ph.torques.Drag([], ORBIT, **AIR), "at least one plate"),
    (lambda: ph.torques.Drag([1.0], ORBIT, **AIR), "must be Plates, got float"),
    (lambda: ph.torques.Drag(PLATES, 1.0, **AIR), "Drag.orbit: must be an Orbit, got float"),
    (lambda: ph.torques.Drag(PLATES, ORBIT, **{**AIR, "scale_height": 0.0}), "scale_height: must be positive"),
    (lambda: ph.torques.Drag(PLATES, ORBIT, **{**AIR, "density": -1.0}), "density: must be at least 0"),
    (lambda: ph.torques.SolarPressure(PLATES, (0, 0, 0), 1.0), "sun: must be finite and not 0"),
    (lambda: ph.torques.SolarPressure(PLATES, SUN, np.nan), "pressure: must be at least 0 and finite"),
])
def test_wrong_plates_are_refused(call, words):
    with pytest.raises(ph.InvalidInput, match=words):
        call()
