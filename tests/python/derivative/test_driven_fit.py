"""Fits of bodies with torques and rotors to made measurements: derivatives, recovery, coverage, and what is hidden."""

import numpy as np
import pytest

import polhode as ph
from polhode import measured
from polhode._sensitivity import rotations
from polhode._sensitivity.driven_problem import DrivenProblem, DrivenState

T = ph.torques
TRUE = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(0.3, 0.2, 3.0), attitude=(0.28, 0.0, 0.0, 0.96),
                torques=[T.Gravity(2.0, (0.3, 0.2, 0.5)), T.Damping(np.diag([0.05, 0.06, 0.08]))],
                times=np.linspace(0, 8, 81))


def seen(scene, rng, sigma):
    """A gyroscope and some attitudes of a motion, with noise."""
    motion = ph.solve(scene, 1e-10)
    gyro = measured.Rates(motion.t, motion.omega + sigma * rng.normal(size=motion.omega.shape), sigma)
    q = motion.attitude[::5]
    noise = rotations.exp(sigma * rng.normal(size=(len(q), 3)))
    camera = measured.Attitudes(motion.t[::5], rotations.product(q, noise), sigma)
    return [gyro, camera]


def test_the_jacobian_is_that_of_the_residuals():
    rng = np.random.default_rng(2)
    wheel = ph.Rotor(axis=(0, 1, 0), inertia=0.05, speed=9.0, free=True)
    pulses = T.During(T.Constant((0.2, -0.1, 0.3), "body"), [(1.0, 2.5)])
    scene = TRUE.replace(torques=[*TRUE.torques, pulses], rotors=[wheel, ph.Rotor(axis=(1, 0, 0), momentum=0.3)],
                         times=np.linspace(0, 4, 9))
    groups = ("attitude", "omega", "inertia", "gravity.weight", "gravity.arm", "torques.1.matrix", "torques.2.torque",
              "rotors.0.speed", "rotors.1.momentum")
    problem = DrivenProblem(seen(scene, rng, 0.2), groups, DrivenState.of(scene, groups, np.zeros(0)))
    x = rng.normal(size=len(problem.names)) * 0.02
    found, step = problem.jac(x), 1e-5
    assert problem.names[9:14] == ("gravity.weight", "gravity.arm_x", "gravity.arm_y", "gravity.arm_z",
                                   "torques.1.matrix_xx")
    for k in range(x.size):
        unit = np.eye(x.size)[k] * step
        expected = (problem.fun(x + unit) - problem.fun(x - unit)) / (2 * step)
        np.testing.assert_allclose(found[:, k], expected, rtol=1e-6, atol=1e-6 * abs(expected).max())


def test_the_jacobian_of_motors_and_friction_is_that_of_the_residuals():
    rng = np.random.default_rng(3)
    motor = ph.Rotor(axis=(1, 0, 0), inertia=0.05, speed=4.0, free=True, torque="gain * omega.y - 0.01 * speed",
                     parameters={"gain": 0.2}, viscous=0.01)
    plain = ph.Rotor(axis=(0, 0, 1), inertia=0.04, speed=-3.0, free=True, torque=0.03, viscous=0.02)
    scene = TRUE.replace(rotors=[motor, plain], damper=ph.Damper(inertia=0.2, viscous=0.3), times=np.linspace(0, 4, 9))
    groups = ("omega", "rotors.0.viscous", "rotors.0.gain", "rotors.1.torque", "rotors.1.viscous", "rotors.1.speed",
              "damper.viscous")
    problem = DrivenProblem(seen(scene, rng, 0.2), groups, DrivenState.of(scene, groups, np.zeros(0)))
    assert problem.names[3:] == groups[1:]
    x = rng.normal(size=len(problem.names)) * 1e-3
    found, step = problem.jac(x), 1e-5
    for k in range(x.size):
        unit = np.eye(x.size)[k] * step
        expected = (problem.fun(x + unit) - problem.fun(x - unit)) / (2 * step)
        np.testing.assert_allclose(found[:, k], expected, rtol=1e-6, atol=1e-6 * abs(expected).max())


def test_the_friction_of_a_wheel_is_found():
    wheel = ph.Rotor(axis=(0, 0, 1), inertia=0.05, speed=40.0, free=True, viscous=0.02)
    scene = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(0.3, 0.2, 0.1), rotors=[wheel], times=np.linspace(0, 20, 101))
    guess = scene.replace(rotors=[ph.Rotor(axis=(0, 0, 1), inertia=0.05, speed=40.0, free=True, viscous=0.03)])
    found = ph.fit(seen(scene, np.random.default_rng(4), 1e-3), guess, fit=("omega", "attitude", "rotors.0.viscous"))
    error = found.stderr[found.problem.slices["rotors.0.viscous"]]
    assert found.success and error < 1e-3
    assert abs(found.numbers["rotors.0.viscous"] - 0.02) < 5 * error
    assert found.scene.rotors[0].viscous == found.numbers["rotors.0.viscous"]
    with pytest.raises(ph.InvalidInput, match="rotors.0.coulomb"):
        ph.fit(seen(scene, np.random.default_rng(4), 1e-3), guess, fit=("omega", "rotors.0.coulomb"))


def test_a_full_tensor_keeps_its_axes():
    J = np.array([[1.5, 0.2, -0.1], [0.2, 2.0, 0.15], [-0.1, 0.15, 2.5]])
    scene = TRUE.replace(inertia=J)
    state = DrivenState.of(scene, ("inertia",), np.zeros(0))
    np.testing.assert_allclose(np.asarray(state.make_scene(scene.times, True).inertia.matrix), J, atol=1e-14)
    problem = DrivenProblem(seen(scene, np.random.default_rng(1), 0.1), ("inertia",), state)
    found = problem.jac(np.zeros(3))
    for k, unit in enumerate(np.eye(3) * 1e-5):
        np.testing.assert_allclose(found[:, k], (problem.fun(unit) - problem.fun(-unit)) / 2e-5, rtol=1e-5, atol=1e-3)


@pytest.mark.parametrize("seed", range(5))
def test_arm_and_damping_are_found_from_a_wrong_scene(seed):
    rng = np.random.default_rng(seed)
    q = np.array([0.2, 0.05, 0.0, 0.978])
    guess = TRUE.replace(omega=(0.2, 0.3, 2.8), attitude=q / np.linalg.norm(q),
                         torques=[T.Gravity(2.0, (0.2, 0.1, 0.6)), T.Damping(np.diag([0.03, 0.03, 0.03]))])
    found = ph.fit(seen(TRUE, rng, 0.003), guess, fit=("omega", "attitude", "gravity.arm", "damping.matrix"))
    assert found.success and 0.8 < found.chi2 / found.dof < 1.2
    assert found.unobservable == ()
    for name, truth in (("gravity.arm", (0.3, 0.2, 0.5)), ("damping.matrix", np.diag([0.05, 0.06, 0.08]).ravel())):
        error = found.stderr[found.problem.slices[name]]
        assert (abs(found.numbers[name] - truth) < 5 * error).all() and error.max() < 0.05
    np.testing.assert_allclose(found.scene.torques[0].arm, found.numbers["gravity.arm"])
    np.testing.assert_allclose(found.scene.torques[1].matrix.ravel(), found.numbers["damping.matrix"])
    assert found.predict([1.0]).spread[0] < found.predict([1.0, 30.0]).spread[1] < 0.5


def test_inertia_and_a_wheel_are_found_in_absolute_numbers():
    truth = TRUE.replace(rotors=[ph.Rotor(axis=(0, 0, 1), momentum=0.8)])
    guess = truth.replace(inertia=(1.1, 1.9, 2.6), rotors=[ph.Rotor(axis=(0, 0, 1), momentum=0.6)])
    found = ph.fit(seen(truth, np.random.default_rng(8), 0.002), guess,
                   fit=("omega", "attitude", "inertia", "rotors.0.momentum"))
    assert found.success
    np.testing.assert_allclose(found.inertia, (1.0, 2.0, 2.5), rtol=0.02)
    np.testing.assert_allclose(found.numbers["rotors.0.momentum"], 0.8, rtol=0.05)


def test_intervals_cover_the_truth():
    rng, count = np.random.default_rng(11), 60
    groups = ("omega", "attitude", "gravity.weight", "torques.1.matrix")
    scene, inside = TRUE.replace(times=np.linspace(0, 5, 26)), []
    true = np.concatenate([scene.omega, [0.0] * 3, [2.0], np.diag([0.05, 0.06, 0.08]).ravel()])
    for _ in range(count):
        found = ph.fit(seen(scene, rng, 0.01), scene, fit=groups, start="scene")
        off = found.x - true
        back = rotations.conjugate(np.asarray(scene.attitude))
        off[3:6] = rotations.log(rotations.product(found.attitude.as_quat(), back))
        inside.append(abs(off) < 1.96 * found.stderr)
    share = np.mean(inside, axis=0)
    assert share.min() > 0.85 and 0.92 < share.mean() < 0.98


def test_weight_and_arm_together_are_not_observable():
    found = ph.fit(seen(TRUE, np.random.default_rng(3), 0.01), TRUE, fit=("omega", "gravity.weight", "gravity.arm"))
    assert any("gravity.weight" in text and "gravity.arm_z" in text for text in found.unobservable)
    assert np.isinf(found.stderr[3])


def test_a_weight_alone_is_fitted_from_the_start_of_the_scene():
    guess = TRUE.replace(torques=[T.Gravity(1.7, (0.3, 0.2, 0.5)), TRUE.torques[1]])
    found = ph.fit(seen(TRUE, np.random.default_rng(3), 0.003), guess, fit=("gravity.weight",))
    assert found.success and abs(found.numbers["gravity.weight"] - 2.0) < 5 * found.stderr[0] < 0.05


def test_bounds_hold_numbers_of_torques():
    data = seen(TRUE, np.random.default_rng(3), 0.01)
    found = ph.fit(data, TRUE, fit=("omega", "gravity.weight"), bounds={"gravity.weight": (2.2, 3.0)})
    assert found.numbers["gravity.weight"] == pytest.approx(2.2)


@pytest.mark.parametrize(("fit", "message"), [("axes", "some of attitude"), ("gravity.mass", "no number"),
                                              ("torques.7.weight", "'gravity.weight'"),
                                              ("rotor.momentum", "numbers of")])
def test_wrong_names_are_refused(fit, message):
    with pytest.raises(ph.InvalidInput, match="fit: .*" + message):
        ph.fit(seen(TRUE, np.random.default_rng(3), 0.01), TRUE, fit=fit)


def test_custom_torques_and_other_starts_are_refused():
    data = seen(TRUE, np.random.default_rng(3), 0.01)
    own = TRUE.replace(torques=[T.Custom(lambda t, omega, attitude: (0.0, 0.0, 0.0))])
    with pytest.raises(ph.InvalidInput, match="without a formula"):
        ph.fit(data, own, fit="omega")
    with pytest.raises(ph.InvalidInput, match="scene: must start at t0 = 0"):
        ph.fit(data, TRUE.replace(t0=1.0), fit="omega")
