"""Derivatives through loops, against central differences of by_hand.run in 40 digits (make_slopes.py)."""

import json
import pathlib

import loops
import numpy as np
import pytest

import polhode as ph

TRUTH = json.loads(pathlib.Path(__file__).with_name("slopes.json").read_text())
START = {"inertia": (1.0, 2.0, 2.5), "omega": (0.2, -0.3, 0.1), "attitude": (0.5, 0.1, -0.1, np.sqrt(0.73))}


def group_of(column):
    return column.rpartition("_")[0] if column.partition("_")[0] in ("omega", "attitude", "inertia") else ".".join(
        part.partition("_")[0] for part in column.split("."))


def differentiate(scene, columns, accuracy=1e-9):
    groups = list(dict.fromkeys(group_of(column) for column in columns))
    return ph.solve(scene, accuracy, sensitivity=groups)


def test_every_loop_with_slopes_has_its_truth():
    assert {name: set(by) for name, by in TRUTH.items()} == {n: set(c["by"]) for n, c in loops.SLOPES.items()}


@pytest.mark.parametrize("name", loops.SLOPES)
def test_a_column_has_the_error_that_it_states(name):
    loop = loops.SLOPES[name]
    motion = differentiate(loops.make_scene(loop), loop["by"])
    found = motion.sensitivity
    assert motion.success and not found.uncertain and (found.error <= 1e-9).all(), motion.message
    for column in loop["by"]:
        truth = np.array([[float(x) for x in row] for row in TRUTH[name][column]])
        d_omega, d_attitude = found.column(column)
        apart = np.maximum(np.linalg.norm(d_omega - truth[:, :3], axis=1) / motion.omega_scale,
                           np.linalg.norm(d_attitude - truth[:, 3:], axis=1))
        size = np.maximum(np.linalg.norm(truth[:, :3], axis=1) / motion.omega_scale,
                          np.linalg.norm(truth[:, 3:], axis=1))
        error = found.error[found.columns.index(column)]
        assert (apart <= error * size + 1e-14 * size.max()).all(), (column, apart, size, error)


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def test_noise_is_data():
    """Two gains apart, the same draws: the difference of two motions is the column."""
    measure = ph.Measure(omega_noise=1e-3, attitude_noise=1e-3, seed=5)

    def run(kp, **more):
        law = ph.Controller(0.1, pd, parameters={"kp": kp, "kd": 3.0}, measure=measure, delay=0.05)
        return ph.solve(ph.Scene(**START, controllers=[law], times=np.linspace(0, 2, 5)), 1e-11, **more)

    column = run(2.0, sensitivity="controllers.0.kp").sensitivity.d_omega[..., 0]
    h = 1e-4
    np.testing.assert_allclose((run(2 + h).omega - run(2 - h).omega) / (2 * h), column, rtol=0, atol=1e-7)


def test_a_branch_that_is_not_certain_is_named():
    def bang(t, m, s, p):
        return -p.u * np.where(m.omega > p.edge, 1.0, -1.0)

    # omega z is 0.3 to rounding at tick 0
    law = ph.Controller(0.25, bang, parameters={"u": 1e-3, "edge": (0.0, 0.0, 0.3)})
    scene = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(0.1, 0.2, 0.3), controllers=[law], times=(0.0, 1.0))
    motion = ph.solve(scene, 1e-6, sensitivity="omega")
    assert "not certain at tick 0" in motion.sensitivity.uncertain and "not certain" in motion.message
    assert np.isinf(motion.sensitivity.error).all()


def test_a_rate_that_is_0_and_stays_has_a_certain_branch():
    def dead_band(t, m, s, p):
        return np.where(m.omega > 0, -p.u, np.where(m.omega < 0, p.u, 0.0))

    law = ph.Controller(0.25, dead_band, parameters={"u": 1e-3})
    still = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(0.0, 0.0, 0.3), controllers=[law], times=(0.0, 1.0))
    found = ph.solve(still, 1e-6, sensitivity="controllers.0.u").sensitivity
    assert not found.uncertain
    np.testing.assert_allclose(found.d_omega[-1, :, 0], (0, 0, -1.0 / 2.5), rtol=0, atol=1e-12)
    assert ph.solve(still, 1e-6, sensitivity="omega").sensitivity.uncertain   # by omega x it has none


def test_windows_beside_controllers_have_columns():
    law = ph.Controller(0.1, pd, parameters={"kp": 2.0, "kd": 3.0})
    push = ph.torques.During(ph.torques.Constant((0.1, -0.2, 0.05)), [(0.33, 0.71)])

    def run(torque, **more):
        return ph.solve(ph.Scene(**START, controllers=[law], torques=[torque], times=(0.5, 1.0, 2.0)), 1e-11, **more)

    found = run(push, sensitivity=("torques.0.torque", "controllers.0.kd")).sensitivity
    more, less = (run(ph.torques.During(ph.torques.Constant((0.1 + h, -0.2, 0.05)), [(0.33, 0.71)])).omega
                  for h in (1e-4, -1e-4))
    np.testing.assert_allclose((more - less) / 2e-4, found.d_omega[..., 0], rtol=0, atol=1e-7)


@pytest.mark.parametrize(("make", "group", "words"), [
    (lambda: ph.Controller(0.25, lambda t, m, s, p: -m.omega, trace=False), "omega", "trace=False"),
    (lambda: ph.Controller(0.25, pd, parameters={"kp": 1, "kd": 1}), "controllers.0.period", "a parameter or a state"),
    (lambda: ph.Controller(0.25, pd, parameters={"kp": 1, "kd": 1}), "controllers.1.kp", "of which the scene has 1"),
    (lambda: ph.Controller(0.25, lambda t, m, s, p: -p.k * m.speed, output="rotor_torque", parameters={"k": 0.1}),
     "rotors.0.inertia", "measures the speeds of rotors"),
    (lambda: ph.Controller(0.25, lambda t, m, s, p: -p.k * m.omega, output="rotor_momentum", parameters={"k": 0.1}),
     "inertia", "inverse of the inertia"),
])
def test_what_has_no_column_is_refused_in_a_sentence(make, group, words):
    controller = make()
    free = controller.output == "rotor_torque"
    axes = [] if controller.output == "torque" else np.eye(3)
    rotors = [ph.Rotor(axis, inertia=0.02, speed=0.0, free=free) for axis in axes]
    with pytest.raises(ph.InvalidInput, match=words) as refusal:
        ph.solve(ph.Scene(**START, rotors=rotors, controllers=[controller], times=(0.0, 1.0)), sensitivity=group)
    assert "\n" not in str(refusal.value)


def test_gains_are_fitted():
    """Rates of a PD loop give its gains, within their standard errors."""
    rng = np.random.default_rng(3)
    law = ph.Controller(0.1, pd, parameters={"kp": 2.0, "kd": 3.0})
    scene = ph.Scene(**START, controllers=[law], times=np.linspace(0.05, 4, 40))
    motion = ph.solve(scene, 1e-11)
    data = ph.measured.Rates(motion.t, motion.omega + rng.normal(scale=1e-4, size=motion.omega.shape), sigma=1e-4)
    guess = scene.replace(controllers=[law.replace(parameters={"kp": 1.5, "kd": 2.5})])
    found = ph.fit(data, guess, ("controllers.0.kp", "controllers.0.kd"))
    assert found.success
    assert found.parameters == ("controllers.0.kp", "controllers.0.kd")
    apart = found.x - (2.0, 3.0)
    assert (np.abs(apart) < 5 * found.stderr).all() and (np.abs(apart) < 0.02).all()
    assert found.scene.controllers[0].parameters["kp"] == found.x[0]


def test_a_damped_loop_has_no_growth():
    """A sphere that is damped at each tick: omega is multiplied by 1 - k T / J, the angle stays."""
    J, k, T = 2.0, 0.9, 0.5
    law = ph.Controller(T, lambda t, m, s, p: -p.k * m.omega, parameters={"k": k})
    scene = ph.Scene(inertia=(J, J, J), omega=(0.0, 0.0, 0.4), controllers=[law], times=(0.0, 50.0))
    found = ph.lyapunov(scene)
    assert abs(found.exponent) < 0.05   # the attitude's neighbours stay where they are


def test_a_long_span_leaves_no_range():
    """Columns of a loop whose rates fall by e^-2000 are scaled: nothing becomes 0 or NaN."""
    law = ph.Controller(0.5, pd, parameters={"kp": 2.0, "kd": 1.5})
    found = ph.lyapunov(ph.Scene(**START, controllers=[law], times=(0.0, 2000.0)), accuracy=1e-6)
    assert np.isfinite(found.log_growth).all() and found.exponent < -0.1
