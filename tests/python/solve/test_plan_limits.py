"""Plans end soon, whatever the scene; what is not finite is no success."""

import math
import time
import warnings

import numpy as np
import pytest

import polhode as ph

DAMPED_PENDULUM = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), times=[1e8],
                           torques=[ph.torques.Damping((1, 1, 1)), ph.torques.Gravity(2, (.3, .2, .5))])


@pytest.mark.parametrize("span", [1e6, 1e8, 1e16])
def test_a_plan_is_back_soon_whatever_the_span(span):
    scene = DAMPED_PENDULUM.replace(times=[span])
    begin = time.perf_counter()
    ph.plan(scene, accuracy=1e-6)
    motion = ph.solve(scene, accuracy=1e-6, max_steps=100)
    assert time.perf_counter() - begin < 2 and motion.status == "max_steps" and not motion.success


def test_a_plan_of_many_pieces_is_back_soon():
    ends = np.arange(1, 400)
    scene = DAMPED_PENDULUM.replace(times=[400e6], torques=[
        ph.torques.Damping((1, 1, 1)), ph.torques.During(ph.torques.Gravity(2, (.3, .2, .5)),
                                                         np.stack([ends, ends + 0.5], axis=1) * 1e6)])
    begin = time.perf_counter()
    assert len(ph.plan(scene, accuracy=1e-6).pieces) > 400 and time.perf_counter() - begin < 2


@pytest.mark.parametrize("damping", [1e150, 1e300])
def test_stiffness_beyond_whole_numbers_is_planned(damping):
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), torques=[ph.torques.Damping((damping, 1, 1))],
                     times=[0, 1.])
    assert ph.plan(scene, 1e-6).method == "radau"
    motion = ph.solve(scene, accuracy=1e-6, max_steps=2000)
    assert not motion.success or np.isfinite(motion.omega).all()


@pytest.mark.parametrize("moments", [(1, 1, 1e-160), (1, 1, 1e-155), (1e-155, 1, 1), (3, 1e-155, 3)])
def test_a_needle_beyond_the_closed_form_is_refused(moments):
    scene = ph.Scene(inertia=moments, omega=(1, 2, 3), times=[1.7])
    for act in (lambda: ph.solve(scene, accuracy=1e-6), lambda: ph.plan(scene),
                lambda: ph.FreeMotion(moments, (1, 2, 3)).at(1.)):
        with pytest.raises(ph.InvalidInput, match="must be moments within the range of float64"):
            act()
    for inertia in (moments, ph.InertiaTensor.from_moments(moments)):
        with pytest.warns(RuntimeWarning, match="^1 rows are NaN"):
            omega, attitude = ph.free_motion(inertia, (1, 2, 3), (0, 0, 0, 1), 1.)
        assert np.isnan(omega).all() and np.isnan(attitude).all()
    with pytest.warns(RuntimeWarning, match="^1 rows are NaN"):
        omega, _ = ph.free_motion([moments, (1, 1, 1)], (1, 2, 3), (0, 0, 0, 1), 1.)
    np.testing.assert_allclose(omega[1], (1, 2, 3), rtol=1e-15)


def test_a_needle_within_the_closed_form_is_as_the_limit():
    """Two equal moments: omega's part across the axis turns at the rate (1 - I3 / I1) w3, which is w3 to rounding."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        omega, _ = ph.free_motion((1, 1, 1e-153), (1, 2, 3), (0, 0, 0, 1), 1.7)
    turn = -3 * 1.7   # w1' = w2 w3 for I3 = 0
    c, s = math.cos(turn), math.sin(turn)
    assert np.abs(omega - (c * 1 - s * 2, s * 1 + c * 2, 3)).max() < 4e-15


def test_samples_that_are_not_finite_are_no_success():
    scene = ph.Scene(inertia=(1, 1, 1e-160), omega=(1, 2, 3), times=[1.7],
                     torques=[ph.torques.Gravity(1, (0.1, 0, 1))])
    motion = ph.solve(scene, accuracy=1e-6, max_steps=1000)
    assert not motion.success and not motion.error <= 1
    many = ph.solve_many(scene, omega=[(1, 2, 3)], accuracy=1e-6, max_steps=1000)
    assert not np.asarray(many.success).any()


def test_the_error_of_omega_is_relative_to_the_largest_rate_of_start_and_samples():
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(.2, .3, -.3), times=[540.],
                     torques=[ph.torques.Damping((.08, .6, 5.))])
    for accuracy in (1e-3, 1e-9):
        motion = ph.solve(scene, accuracy)
        exact, _, _ = ph._core.reference(scene, 26, 1e-21, 400_000)
        assert motion.omega_scale == pytest.approx(np.linalg.norm(scene.omega), rel=1e-15)
        assert motion.success and np.linalg.norm(motion.omega - exact) / motion.omega_scale <= motion.error <= accuracy
    assert np.linalg.norm(exact) < 1e-18   # the sample alone would be no measure
    faster = ph.solve(scene.replace(times=[-3.]), 1e-9)
    assert faster.omega_scale == pytest.approx(np.linalg.norm(faster.omega), rel=1e-15)
