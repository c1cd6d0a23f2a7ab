"""A motion does not depend on the time at which the clock starts, as far as the given times are exact."""

import numpy as np
import pytest

import polhode as ph

SHIFT = 3e6   # seconds; a unit in the last place is 4.7e-10 s
SPACING = 640 * np.spacing(SHIFT)
SKIPPED = {"symplectic", "leapfrog"}   # they do not take damping


def solve(method, start, *, backward=False, dense=False):
    times = np.arange(400) * (-SPACING if backward else SPACING)
    scene = ph.Scene(inertia=[1.0, 2.0, 3.0], omega=[40.0, 500.0, 20.0], t0=start, times=start + times,
                     torques=[ph.torques.Damping(np.diag([40.0, 200.0, 300.0]))])
    adaptive = next(m for m in ph.methods() if m["name"] == method)["adaptive"]
    return ph.solve(scene, method=method, dense=dense, **({"rtol": 1e-12} if adaptive else {"step": 3.3137 * SPACING}))


@pytest.mark.parametrize("start", [SHIFT, -SHIFT])
@pytest.mark.parametrize("backward", [False, True])
@pytest.mark.parametrize("method", sorted({m["name"] for m in ph.methods()} - SKIPPED))
def test_the_start_of_the_clock_does_not_matter(method, start, backward):
    """Differences of these times are exact numbers. Steps that miss their times by rounding differ by 1e-8 and more."""
    near, far = solve(method, 0.0, backward=backward), solve(method, start, backward=backward)
    scale = np.abs(near.omega).max()
    # Steps differ by up to half a unit of the time, 2e-10 s of about 1e-6 s. The errors of methods change with them.
    error = np.abs(near.omega - solve("taylor", 0.0, backward=backward).omega).max() / scale
    assert np.abs(far.omega - near.omega).max() <= (1e-14 + 0.01 * error) * scale
    assert np.abs(far.attitude - near.attitude).max() <= 1e-13 + 0.01 * np.abs(
        near.attitude - solve("taylor", 0.0, backward=backward).attitude).max()


def test_lanes_step_the_same_times():
    times = SHIFT + np.arange(50) * SPACING
    torques = [ph.torques.Damping(np.diag([40.0, 200.0, 300.0]))]
    scenes = [ph.Scene(inertia=[1.0, 2.0, 3.0], omega=[40.0 + k, 500.0, 20.0], t0=SHIFT, times=times, torques=torques)
              for k in range(9)]
    many = ph.solve_many(scenes, method="rk45", rtol=1e-12)
    for k, scene in enumerate(scenes):
        assert np.array_equal(many.omega[k], ph.solve(scene, method="rk45", rtol=1e-12).omega)


def test_the_dense_answer_is_as_exact_between_the_samples():
    times = (np.arange(399) + 0.5) * SPACING
    near, _ = solve("dop853", 0.0, dense=True)(times)
    far, _ = solve("dop853", SHIFT, dense=True)(SHIFT + times)
    assert np.abs(far - near).max() <= 1e-11 * 500
