"""Sensors of a thrown body: scales and misalignments of a gyroscope, an accelerometer at an arm, what is observable."""

import numpy as np
import pytest

import polhode as ph
from polhode import measured
from polhode._sensitivity.problem import Problem, State, ratios_of
from polhode._sensitivity.result import covariance

INERTIA, OMEGA, START = np.array([0.3, 0.5, 0.62]), np.array([1.0, -2.0, 0.7]), np.array([0.5, -0.1, 0.7, 0.5])
ARM, MATRIX = np.array([0.1, -0.07, 0.2]), np.array([[1.02, 0.01, -0.02], [0.005, 0.97, 0.01], [0.0, -0.01, 1.01]])
T = np.linspace(0, 12, 300)


def acceleration(t, arm):
    """The second derivative of R arm by central differences, back in the body."""
    motion, h = ph.FreeMotion(INERTIA, OMEGA, START), 1e-3
    place = [ph.Rotation.from_quat(motion.at(t + k * h)[1]).apply(arm) for k in (-2, -1, 0, 1, 2)]
    second = (-place[0] + 16 * place[1] - 30 * place[2] + 16 * place[3] - place[4]) / (12 * h * h)
    return ph.Rotation.from_quat(motion.at(t)[1]).inv().apply(second)


def test_the_model_of_the_accelerometer_is_the_second_derivative_of_its_place():
    motion = ph.FreeMotion(INERTIA, OMEGA, START)
    data = measured.Acceleration(T[:9], np.zeros((9, 3)), 1.0, ARM)
    state = State(START, OMEGA, ratios_of(INERTIA), np.array([0.0, 0, 0, 1]), np.zeros(0))
    found = Problem([data], ("omega", "inertia"), state).residuals(state).reshape(9, 3)
    assert found == pytest.approx(acceleration(T[:9], ARM), abs=1e-7)
    assert motion.period > 0


@pytest.mark.parametrize("own", [dict(bias=True), dict(scale=True), dict(bias=True, scale=True, misalignment=True)])
def test_derivatives_of_sensors_with_parameters_of_their_own(own):
    rng = np.random.default_rng(3)
    data = [measured.Rates(T[:20], rng.normal(size=(20, 3)), 0.1, **own),
            measured.Acceleration(T[:15], rng.normal(size=(15, 3)), 0.2),
            measured.Acceleration(T[:5], rng.normal(size=(5, 3)), 0.2, arm=ARM)]
    count = sum(m.bias for m in data)
    state = State(START, OMEGA, ratios_of(INERTIA), np.array([0.0, 0, 0, 1]), 0.1 * rng.normal(size=count))
    problem = Problem(data, ("omega", "attitude", "inertia"), state)
    x, step = 0.05 * rng.normal(size=len(problem.names)), 1e-6
    found = problem.jac(x)
    for k in range(len(x)):
        unit = step * np.eye(len(x))[k]
        expected = (problem.fun(x + unit) - problem.fun(x - unit)) / (2 * step)
        assert found[:, k] == pytest.approx(expected, abs=1e-6 * np.abs(found).max()), problem.names[k]


def test_a_throw_gives_scales_misalignments_and_the_arm():
    rng = np.random.default_rng(5)
    motion = ph.FreeMotion(INERTIA, OMEGA, START)
    rates = motion.at(T)[0] @ MATRIX.T + (0.02, -0.01, 0.03)
    gyro = measured.Rates(T, rates + 0.001 * rng.normal(size=rates.shape), 0.001, bias=True, scale=True,
                          misalignment=True)
    arm = measured.Acceleration(T, acceleration(T, ARM) + 0.002 * rng.normal(size=(300, 3)), 0.002)
    scene = ph.Scene(inertia=tuple(INERTIA * (1, 1.02, 0.99)), omega=tuple(OMEGA + 0.02), times=T)
    found = ph.fit([gyro, arm], scene, fit=("omega", "inertia"), start="scene")
    assert found.success, found.message
    truth = dict(zip(found.parameters, found.x, strict=True))
    error = dict(zip(found.parameters, found.stderr, strict=True))
    for name, value in {"arm_x": 0.1, "arm_y": -0.07, "arm_z": 0.2, "bias_y": -0.01, "scale_y": -0.03,
                        "misalignment_xz": -0.02}.items():
        assert abs(truth[name] - value) < 5 * error[name] < 0.5, name


def test_a_steady_rotation_does_not_tell_scales_and_says_so():
    scene = ph.Scene(inertia=tuple(INERTIA), omega=(0, 0, 2.0), times=T)
    rates = np.tile([0, 0, 2.0], (300, 1))
    found = ph.fit(measured.Rates(T, rates, 0.01, scale=True), scene, fit=("omega",), start="scene")
    assert any("omega_z" in text and "scale_z" in text for text in found.unobservable)
    assert np.isinf(found.stderr[found.parameters.index("scale_z")]) and not np.isnan(found.stderr).any()


def test_an_accelerometer_needs_given_principal_axes():
    data = measured.Acceleration(T, np.ones((300, 3)), 0.1)
    with pytest.raises(ph.InvalidInput, match="Acceleration needs a free body"):
        ph.fit(data, fit=("omega", "inertia", "axes"))
    with pytest.raises(ph.InvalidInput, match="arm: must be three finite"):
        measured.Acceleration(T, np.ones((300, 3)), 0.1, arm=(1, 2))


def test_errors_across_a_free_turn_are_those_of_what_is_determined():
    """Two columns of a turn that only act through their sum: what is across the difference has its own error."""
    rng = np.random.default_rng(7)
    one = rng.normal(size=50)
    line = np.array([0.6, 0.8, 0.0])
    across = np.array([-0.8, 0.6, 0.0])
    jacobian = np.outer(one, across) + np.outer(rng.normal(size=50), [0, 0, 1.0])
    cov, hidden = covariance(jacobian, ("attitude_x", "attitude_y", "attitude_z"))
    assert len(hidden) == 1 and "0.6 attitude_x" in hidden[0] and "0.8 attitude_y" in hidden[0]
    assert np.isfinite(cov).all() and line @ cov @ line == pytest.approx(0, abs=1e-12)
    assert across @ cov @ across == pytest.approx(np.linalg.inv(np.stack([one, jacobian[:, 2]], 1).T
                                                              @ np.stack([one, jacobian[:, 2]], 1))[0, 0], rel=1e-9)


def test_a_turn_about_the_line_of_sight_leaves_the_errors_of_the_rest():
    """With the Sun behind the observer a turn about the line of sight is free; the other two errors are known."""
    rng = np.random.default_rng(8)
    sight = np.array([0.6, 0.0, 0.8])
    body = dict(body=(3, 2, 1.2), sun=sight, observer=sight, law="lommel-seeliger")
    made = measured.Brightness(T, np.ones(300), 0.1, **body).model(ph.FreeMotion(INERTIA, OMEGA, START).at(T)[1])
    data = measured.Brightness(T, made + 0.02 * rng.normal(size=300), 0.02, **body)
    scene = ph.Scene(inertia=tuple(INERTIA), omega=tuple(OMEGA), attitude=START, times=T)
    found = ph.fit(data, scene, start="scene")
    assert found.success and np.isfinite(found.stderr).all()
    assert any("0.6 attitude_x +0.8 attitude_z" in text or "-0.6 attitude_x -0.8 attitude_z" in text
               for text in found.unobservable), found.unobservable


def test_windows_grow_from_a_scene_that_is_off_by_one_part_in_a_hundred():
    """Over 60 turns 1 % of the rate is 3.8 rad: with all data at once there is no way back."""
    rng = np.random.default_rng(9)
    t = np.linspace(0, 60 * 2 * np.pi / np.linalg.norm(OMEGA), 900)
    q = ph.Rotation.from_quat(ph.FreeMotion(INERTIA, OMEGA, START).at(t)[1])
    data = measured.Axis(t, q.apply(np.array([0, 0, 1.0])) + 0.02 * rng.normal(size=(900, 3)), 0.02, (0, 0, 1))
    scene = ph.Scene(inertia=tuple(INERTIA * (1, 1.01, 0.99)), omega=tuple(1.01 * OMEGA), attitude=START, times=t)
    found = ph.fit(data, scene, start="scene")
    assert found.success and found.omega == pytest.approx(OMEGA, abs=0.01)
