"""Gravity gradient on conics against 34 digits in which the orbit is integrated beside the body."""

import copy
import json
import pathlib
import pickle

import numpy as np
import pytest

import polhode as ph

CASES = {case["name"]: case for case in json.loads(
    (pathlib.Path(__file__).parents[2] / "reference" / "orbit_gradient.json").read_text())["cases"]}
ORBIT = ph.Orbit(1.0, (1, 0.2, 0), (0, 1.1, 0.3))
TIP = ph.Rotation.from_rotvec((0.2, -0.4, 0.6)).as_quat()


def make_scene(case, inertia=None, **more):
    torques = [ph.torques.GravityGradient(orbit=ph.Orbit(mu, r, v)) for mu, r, v in case["orbits"]]
    return ph.Scene(inertia=case["inertia"] if inertia is None else inertia, omega=case["omega"],
                    attitude=np.array(case["attitude"]) / np.linalg.norm(case["attitude"]), torques=torques,
                    times=case["times"], **more)


def scene(*torques, **more):
    parts = dict(inertia=(1, 2, 2.5), omega=(0.3, -0.2, 0.5), times=np.linspace(0, 4, 5))
    return ph.Scene(**{**parts, "torques": torques, **more})


def find_errors(motion, states):
    """Of the rates relative to the largest, and of the attitude as an angle."""
    states = np.array(states)
    rates = np.linalg.norm(motion.omega - states[:, :3], axis=1).max() / np.linalg.norm(states[:, :3], axis=1).max()
    q = motion.attitude * np.sign(np.sum(motion.attitude * states[:, 3:], axis=1))[:, None]
    return rates, 2 * np.linalg.norm(q - states[:, 3:], axis=1).max()


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-12])
def test_every_conic_has_the_error_that_it_states(name, accuracy):
    case = CASES[name]
    motion = ph.solve(make_scene(case), accuracy=accuracy)
    rates, angle = find_errors(motion, case["states"])
    assert motion.success
    assert motion.error_kind == "bounded" and max(rates, angle) <= motion.error <= accuracy


@pytest.mark.parametrize("method", ["taylor", "dop853", "rk45", "radau", "rk4"])
def test_every_method_takes_an_orbit(method):
    case = CASES["e 0.73"]
    motion = ph.solve(make_scene(case), method=method, **({"step": 1e-3} if method == "rk4" else {"rtol": 1e-8}))
    assert max(find_errors(motion, case["states"])) < 1e-6


def test_units_of_the_orbit_do_not_count():
    """No norm has metres beside rad/s: an orbit in other units of length has the same motion."""
    case = CASES["e 0.97"]
    found = []
    for unit in (1.0, 2.0**40, 2.0**-40):
        orbits = [(mu * unit**3, np.multiply(r, unit), np.multiply(v, unit)) for mu, r, v in case["orbits"]]
        motion = ph.solve(make_scene({**case, "orbits": orbits}), method="taylor", rtol=1e-9)
        found.append((motion.omega, motion.stats["steps"]))
    for omega, steps in found[1:]:
        np.testing.assert_allclose(omega, found[0][0], rtol=1e-12)
        assert steps == found[0][1]


def test_a_step_ends_before_the_next_periapsis():
    """A body that hardly feels the far orbit must not step over the periapsis, where the series has its poles."""
    orbit = ph.Orbit.from_elements(1.0, periapsis_distance=1.0, e=4.2, t0=1000.0)
    start = dict(inertia=(1, 1, 2), omega=(0, 0, 1e-3), attitude=TIP)
    given = scene(ph.torques.GravityGradient(orbit=orbit), times=[1010.0], **start)
    fast, sure = ph.solve(given, method="taylor", rtol=1e-10), ph.solve(given, method="dop853", rtol=1e-12)
    np.testing.assert_allclose(fast.omega, sure.omega, atol=1e-8)


def test_a_circle_is_the_torque_of_a_mean_motion():
    n = 1.3
    orbit = ph.Orbit.from_elements(n**2, a=1.0, anomaly=0.4)
    given = scene(ph.torques.GravityGradient(orbit=orbit), attitude=TIP)
    plain = given.replace(torques=[ph.torques.GravityGradient(n, 0.4)])
    a, b = ph.solve(given, accuracy=1e-12), ph.solve(plain, accuracy=1e-12)
    np.testing.assert_allclose(a.omega, b.omega, rtol=0, atol=4e-12)


@pytest.mark.parametrize("orbit", [ORBIT, ph.Orbit.from_elements(2.0, a=1.3, e=0.4, inclination=0.9, node=0.3,
                                                                 periapsis=0.8, j2=0.01, radius=0.5),
                                   ph.Orbit.from_elements(2.0, periapsis_distance=1.0, e=1.0, anomaly=-2.0)])
def test_the_torque_is_that_of_the_position(orbit):
    """Also of an orbit whose plane turns: the series through a step, not only its values."""
    torque, J = ph.torques.GravityGradient(orbit=orbit), np.diag([1, 2, 2.5])
    q = ph.Rotation.from_quat(TIP)
    for t in (-1.0, 0.0, 2.5):
        r = q.as_matrix().T @ orbit.at(t)[0]
        expected = 3 * orbit.mu / np.linalg.norm(r) ** 5 * np.cross(r, J @ r)
        np.testing.assert_allclose(torque.value(t, (0, 0, 0), q.as_quat(), inertia=J), expected, rtol=1e-14)
    given = scene(torque)
    fine = ph.solve(given, method="dop853", rtol=1e-12)
    np.testing.assert_allclose(ph.solve(given, method="taylor", rtol=1e-12).omega, fine.omega, atol=1e-10)


def test_a_formula_sees_an_orbit():
    def gradient(t, omega, attitude, p):
        r = ph.formula.to_body(attitude, ORBIT.at(t)[0])
        return 3 * p.mu / ph.formula.norm(r) ** 5 * np.cross(r, np.array([1, 2, 2.5]) * r)

    traced = ph.torques.Formula(gradient, mu=ORBIT.mu)
    written = ph.torques.Formula(text="3 * mu * main.inverse_distance^5 * cross(r, J * r)", J=(1, 2, 2.5), mu=ORBIT.mu,
                                 let={"r": "to_body(main.r)"}, orbits={"main": ORBIT})
    law = ph.solve(scene(ph.torques.GravityGradient(orbit=ORBIT)), accuracy=1e-12)
    for torque in (traced, written):
        motion = ph.solve(scene(torque), accuracy=1e-12)
        np.testing.assert_allclose(motion.omega, law.omega, atol=2e-12)
    assert written.orbits == {"main": ORBIT} and traced.orbits == {"orbit": ORBIT}


def test_a_formula_sees_the_velocity():
    orbit = ph.Orbit.from_elements(2.0, a=1.3, e=0.4, inclination=0.9, j2=0.01, radius=0.5)
    torque = ph.torques.Formula(lambda t, omega, attitude, p: orbit.at(t)[1])
    np.testing.assert_allclose(torque.value(0.7, (0, 0, 0), (0, 0, 0, 1)), orbit.at(0.7)[1], rtol=1e-15)
    given = scene(torque)
    np.testing.assert_allclose(ph.solve(given, method="taylor", rtol=1e-12).omega,
                               ph.solve(given, method="dop853", rtol=1e-12).omega, atol=1e-10)


@pytest.mark.parametrize("torque", [
    ph.torques.GravityGradient(orbit=ORBIT),
    ph.torques.Formula(text="main.distance * to_body(other.v)",
                       orbits={"main": ORBIT, "other": ph.Orbit.from_elements(1.0, a=2.0, e=0.1, node=0.2)}),
    ph.torques.During(ph.torques.GravityGradient(orbit=ORBIT), [(1.0, 2.0)]),
])
def test_torques_of_orbits_are_values(torque, tmp_path):
    for other in (copy.deepcopy(torque), pickle.loads(pickle.dumps(torque))):
        assert other == torque and hash(other) == hash(torque) and repr(other) == repr(torque)
    given = scene(torque)
    given.save(tmp_path / "scene.toml")
    again = ph.Scene.load(tmp_path / "scene.toml")
    assert again.torques == given.torques
    np.testing.assert_array_equal(ph.solve(again, accuracy=1e-9).omega, ph.solve(given, accuracy=1e-9).omega)


def test_torques_of_other_orbits_are_other_torques():
    other = ph.Orbit(1.0, (1, 0.2, 0), (0, 1.1, 0.3 + 1e-15))
    assert ph.torques.GravityGradient(orbit=other) != ph.torques.GravityGradient(orbit=ORBIT)
    # One after the other, so that nothing kept from the first is taken for the second.
    a = ph.solve(scene(ph.torques.GravityGradient(orbit=ORBIT)), accuracy=1e-9).omega
    faster = ph.Orbit(1.0, (1, 0.2, 0), (0, 1.2, 0.3))
    b = ph.solve(scene(ph.torques.GravityGradient(orbit=faster)), accuracy=1e-9).omega
    assert np.abs(a - b).max() > 1e-3


def test_a_scene_file_names_its_orbits(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("""
[body]
matrix = [[1, 0, 0], [0, 2, 0], [0, 0, 2.5]]
[start]
omega = [0.3, -0.2, 0.5]
[times]
values = [0.0, 1.0]
[orbits.main]
mu = 1.0
a = 2.0
e = 0.1
[orbits.sun]
mu = 1.0
r0 = [3.0, 0.0, 0.0]
v0 = [0.0, 0.2, 0.0]
[[torques]]
kind = "gravity_gradient"
orbit = "main"
[[torques]]
kind = "formula"
torque = "to_body(sun.r)"
[[torques]]
kind = "gravity_gradient"
mean_motion = 0.5
""")
    first, second, third = ph.Scene.load(path).torques
    assert first.orbit == ph.Orbit.from_elements(1.0, a=2.0, e=0.1)
    assert second.orbits == {"sun": ph.Orbit(1.0, (3, 0, 0), (0, 0.2, 0))}
    assert third == ph.torques.GravityGradient(0.5)


@pytest.mark.parametrize(("change", "words"), [
    (('orbit = "main"', 'orbit = "moon"'), "must name a table of \\[orbits\\], got 'moon'; there are main, sun"),
    (('orbit = "main"', 'orbit = "main"\nphase = 1.0'), "must have mean_motion and phase, or orbit; got"),
    (("a = 2.0\n", "a = -2.0\n"), "orbits.main: a: must be positive"),
    (("a = 2.0\n", "a = 2.0\naa = 1.0\n"), "unknown key"),
])
def test_wrong_scene_files_are_refused(change, words, tmp_path):
    test_a_scene_file_names_its_orbits(tmp_path)
    path = tmp_path / "scene.toml"
    path.write_text(path.read_text().replace(*change))
    with pytest.raises(ph.InvalidInput, match=words):
        ph.Scene.load(path)


@pytest.mark.parametrize(("call", "words"), [
    (lambda: ph.torques.GravityGradient(0.1, orbit=ORBIT), "mean_motion and phase, or orbit alone, got both"),
    (lambda: ph.torques.GravityGradient(orbit=3.0), "must be an Orbit, got float"),
    (lambda: ph.torques.GravityGradient(orbit=ph.Orbit.table([0, 1], np.eye(3)[:2], np.eye(3)[:2])), "a table"),
    (lambda: ph.torques.Formula(text="moon.r", orbits={"main": ORBIT}), "a known name"),
    (lambda: ph.torques.Formula(text="main.x", orbits={"main": ORBIT}), "r, v, distance or inverse_distance"),
    (lambda: ph.torques.Formula(lambda t, omega, attitude, p: ORBIT.at(t + 1.0)[0]), "the time t itself"),
    (lambda: ph.torques.Formula(lambda t, omega, attitude, p: omega, orbits={"a": ORBIT}), "left out for a function"),
])
def test_wrong_torques_are_refused(call, words):
    with pytest.raises(ph.InvalidInput, match=words):
        call()


def test_a_proof_is_refused_with_its_reason():
    with pytest.raises(ph.InvalidInput, match="orbit"):
        ph.solve(scene(ph.torques.GravityGradient(orbit=ORBIT)), accuracy=1e-6, certify="proof")


def test_many_bodies_on_one_orbit_run_in_lanes():
    rng = np.random.default_rng(5)
    given = scene(ph.torques.GravityGradient(orbit=ORBIT))
    omega = rng.normal(size=(13, 3))
    many = ph.solve_many(given, omega=omega, rtol=1e-10)
    for i in (0, 7, 12):
        one = ph.solve(given.replace(omega=omega[i]), method="taylor", rtol=1e-12)
        np.testing.assert_allclose(many.omega[i], one.omega, atol=1e-8)


def test_columns_of_a_start():
    given = scene(ph.torques.GravityGradient(orbit=ORBIT))
    columns = ph.solve(given, accuracy=1e-9, sensitivity="omega").sensitivity
    step = 1e-5
    for axis in range(3):
        ends = [ph.solve(given.replace(omega=given.omega + s * step * np.eye(3)[axis]), accuracy=1e-13).omega
                for s in (1, -1)]
        np.testing.assert_allclose(columns.d_omega[:, :, axis], (ends[0] - ends[1]) / (2 * step), atol=1e-7)
