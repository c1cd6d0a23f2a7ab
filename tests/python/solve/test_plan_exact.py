"""Scenes that have a closed form are evaluated: no steps, the model told, and the error within what is claimed."""

import numpy as np
import pytest
from bodies import BLOCK, PARTS, TILTED, scene
from measures import attitude_error, error, rates_error, truth

import polhode as ph

TIMES = np.linspace(0, 30, 31)


@pytest.mark.parametrize(("name", "model"), [("S1", "triaxial"), ("S2", "triaxial"), ("S3", "symmetric"),
                                             ("S4", "heavy_top")])
def test_scenes_with_a_closed_form_against_stored_truth(name, model):
    motion = ph.solve(scene(name), accuracy=1e-13)
    assert (motion.plan.model, motion.plan.method, motion.plan.state) == (model, "exact", "omega, attitude")
    assert motion.stats["steps"] == 0
    # The bound of a top has 2^-56 for each radian, of its frequencies.
    assert motion.success and motion.error_kind == "bounded" and motion.error < (2e-14 if name == "S4" else 1e-14)
    assert error(motion.omega, motion.attitude, truth(name)) < motion.error


@pytest.mark.parametrize(("inertia", "omega", "model"), [
    (BLOCK, (0, 0, 0), "rest"), ((2, 2, 2), (1, 2, 3), "spherical"), (BLOCK, (0, 4, 0), "steady"),
    ((1, 1, 2), (1, 0, 3), "symmetric"), ((1, 2, 2), (1, 0, 3), "symmetric"), (BLOCK, (1, 2, 3), "triaxial"),
    # I1 (I2 - I1) w1^2 = I3 (I3 - I2) w3^2 to the last bit
    ((1, 2, 2.5), (np.sqrt(1.25), 1, 1), "triaxial"), ((2, 3, 4), (np.sqrt(2), 1, 1), "triaxial"),
    ((3, 4, 6), (2, 1, 1), "separatrix"),
])
def test_the_least_free_model_is_named(inertia, omega, model):
    motion = ph.solve(ph.Scene(inertia=inertia, omega=omega, times=TIMES))
    assert motion.plan.model == model and motion.plan.method == "exact"
    omega, attitude = ph.FreeMotion(inertia, omega).at(TIMES)
    np.testing.assert_array_equal(motion.omega, omega)
    np.testing.assert_array_equal(motion.attitude, attitude)


@pytest.mark.parametrize("torque", [
    ph.torques.Gravity(0, (1, 2, 3)), ph.torques.Gravity(3, (0, 0, 0)), ph.torques.Constant((0, 0, 0)),
    ph.torques.Constant((0, 0, 0), frame="space"), ph.torques.Damping((0, 0, 0)), ph.torques.GravityGradient(0)],
                         ids=repr)
def test_torques_that_vanish_are_left_out(torque):
    motion = ph.solve(scene("S1", torques=[torque], times=TIMES))
    assert motion.plan.method == "exact" and motion.plan.model == "triaxial"
    gravity = ph.solve(scene("S4", torques=[*PARTS["S4"]["torques"], torque], times=TIMES))
    assert gravity.plan.model == "heavy_top"


def test_the_gradient_of_gravity_leaves_a_sphere_alone():
    motion = ph.solve(ph.Scene(inertia=(2, 2, 2), omega=(1, 2, 3), torques=[ph.torques.GravityGradient(0.1)],
                               times=TIMES))
    assert motion.plan.model == "spherical"


@pytest.mark.parametrize(("inertia", "arm", "exact"), [
    ((1, 1, 0.5), (0, 0, 1), True), ((1, 1, 0.5), (0, 0, -1), True), ((1, 1, 0.5), (0, 1e-9, 1), False),
    ((0.5, 1, 1), (1, 0, 0), True), ((1, 0.5, 1), (0, 2, 0), True), ((1, 0.5, 1), (0, 0, 2), False),
    ((1, 1 + 1e-15, 0.5), (0, 0, 1), False), ((1, 1, 1), (0, 0, 1), True), ((1, 1, 1), (1, 0, 0), False)])
def test_lagranges_top_is_taken_only_where_it_is_one(inertia, arm, exact):
    one = ph.Scene(inertia=inertia, omega=(0.3, 0.2, 4), attitude=TILTED, torques=[ph.torques.Gravity(2, arm)],
                   times=TIMES / 10)
    motion = ph.solve(one, accuracy=1e-8)
    assert (motion.plan.method == "exact") == exact
    stepped = ph.solve(one, rtol=1e-12, method="rk45")
    assert rates_error(motion.omega, stepped.omega) < 1e-7 and attitude_error(motion.attitude, stepped.attitude) < 1e-7


def test_what_weight_times_arm_loses_is_in_the_bound():
    exact_product = ph.solve(scene("S4", torques=[ph.torques.Gravity(2, (0, 0, 1))], times=[1e4]))
    rounded = ph.solve(scene("S4", torques=[ph.torques.Gravity(9.81, (0, 0, 0.2038735983690112))], times=[1e4]))
    assert exact_product.error < 1e-12 and 1e-13 < rounded.error - exact_product.error < 1e-10


def test_a_full_tensor_is_bounded_by_what_its_principal_axes_lose():
    q = np.array([0.1, -0.4, 0.3, 0.7])
    R = ph.Rotation.from_quat(q / np.linalg.norm(q)).as_matrix()
    times = np.linspace(0, 1000, 101)
    tensor = R.T @ np.diag(BLOCK) @ R
    motion = ph.solve(ph.Scene(inertia=(tensor + tensor.T) / 2, omega=R.T @ (1, 2, 3), times=times), accuracy=1e-9)
    omega, _ = ph.FreeMotion(BLOCK, (1, 2, 3)).at(times)
    assert 1e-13 < motion.error < 1e-9 and motion.success
    assert rates_error(motion.omega @ R.T, omega) < motion.error
    L = motion.angular_momentum
    np.testing.assert_allclose(L, np.broadcast_to(L[0], L.shape), rtol=0, atol=1e-13 * np.abs(L).max())


def test_times_in_any_order_and_another_start():
    times = np.array([3.0, -2.0, 0.0, 7.5, 7.5])
    motion = ph.solve(scene("S1", times=times + 0.1, t0=0.1), dense=True)
    np.testing.assert_array_equal(motion.t, times + 0.1)
    omega, attitude = ph.FreeMotion(BLOCK, (1, 2, 3)).at(times)
    assert rates_error(motion.omega, omega) < 1e-14 and attitude_error(motion.attitude, attitude) < 1e-14
    assert motion.error > ph.solve(scene("S1", times=times)).error      # t - t0 is rounded
    np.testing.assert_allclose(motion(3.1)[0], motion.omega[0], rtol=1e-14)
    for t in (-2.0, 7.7, np.nan):
        with pytest.raises(ph.InvalidInput, match="time between"):
            motion(t)


def test_events_of_a_closed_form():
    flips = ph.FreeMotion(BLOCK, (0.01, 5, 0.01)).flip_times(0, 60)
    one = scene("S2", omega=(0.01, 5, 0.01), times=np.linspace(0, 60, 7))
    motion = ph.solve(one, events=[lambda t, omega, attitude: omega[1]])
    assert motion.plan.method == "exact" and len(flips) > 5
    np.testing.assert_allclose([hit.t for hit in motion.events], flips, rtol=1e-13)
    ended = ph.solve(one, events=[ph.Event(lambda t, omega, attitude: omega[1], terminal=True)], dense=True)
    assert ended.status == "event" and ended.success and len(ended.t) < 7
    assert abs(ended(flips[0])[0][1]) < 1e-12


def test_more_than_float64_holds_is_said():
    motion = ph.solve(scene("S1", times=TIMES), accuracy=1e-15)
    assert not motion.success and motion.error_kind == "limit" and motion.status == "finished"
    assert "4.4" in motion.message and "1e-15" in motion.message


def test_exact_is_a_method_where_it_holds():
    assert ph.solve(scene("S1"), method="exact").plan.model == "triaxial"
    with pytest.raises(ph.InvalidInput, match="closed form.*closest two moments differ by 20 %"):
        ph.solve(scene("S5"), method="exact")
    for options in ({"rtol": 1e-6}, {"atol": 1e-6}, {"step": 0.1}, {"formulation": "lagrangian"}):
        with pytest.raises(ph.InvalidInput, match="exact"):
            ph.solve(scene("S1"), method="exact", **options)


def test_progress_ends_a_long_evaluation():
    motion = ph.solve(scene("S1", times=np.linspace(0, 1, 300_001)), progress=lambda reached, last: False)
    assert motion.status == "stopped" and not motion.success and len(motion.t) == len(motion.omega) == 100_000


@pytest.mark.parametrize("power", [-150, 12, 150])
def test_models_do_not_depend_on_units(power):
    s = 2.0**power
    for name in ("S1", "S3", "S4"):
        parts = PARTS[name]
        torques = [ph.torques.Gravity(2 * s, (0, 0, 1))] if name == "S4" else []
        scaled = ph.solve(scene(name, inertia=np.array(parts["inertia"]) * s, torques=torques))
        plain = ph.solve(scene(name))
        assert scaled.plan.model == plain.plan.model and scaled.error == plain.error
        np.testing.assert_array_equal(scaled.omega, plain.omega)


@pytest.mark.parametrize(("inertia", "why"), [
    ((1, 1, 0.5), "the centre of mass is off the axis"), ((0.5, 1, 1), "the centre of mass is off the axis"),
    ((1, 1.2, 1.3), "the closest two moments differ by 7.7 %"),
])
def test_the_plan_says_why_a_body_is_no_symmetric_top(inertia, why):
    scene = ph.Scene(inertia=inertia, omega=(0, 0.1, 6), times=[1.0], torques=[ph.torques.Gravity(2, (0.1, 0.2, 1))])
    top = next(one for one in ph.plan(scene).candidates if one.name == "heavy_top")
    assert top.why_not.startswith(why)
