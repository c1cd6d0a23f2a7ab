"""The homework (docs/seed.md) on runs of the solver: Euler's and Lagrange's equations, the pole, L^2 and T."""

import numpy as np
import pytest

import polhode as ph


def tilted_top(**changes):
    """An unsymmetric heavy body at z-x-z angles (0.3, 1.1, 0.2), which stays away from theta = 0."""
    a, b, c = 0.3, 1.1, 0.2
    start = [np.sin(b / 2) * np.cos((a - c) / 2), np.sin(b / 2) * np.sin((a - c) / 2),
             np.cos(b / 2) * np.sin((a + c) / 2), np.cos(b / 2) * np.cos((a + c) / 2)]  # fmt: skip
    parts = {"inertia": [1.0, 2.0, 2.5], "omega": [0.4, 0.3, 3.0], "attitude": start,
             "torques": [ph.torques.Gravity(2.0, [0.3, 0.2, 0.5]), ph.torques.Damping(np.diag([0.02, 0.01, 0.03]))],
             "times": np.linspace(0.0, 5.0, 51)}  # fmt: skip
    return ph.Scene(**{**parts, **changes})


def test_both_formulations_agree():
    """Problem 1: Lagrange's equations in the angles and Euler's with a quaternion, to 1e-12."""
    euler, lagrange = (ph.solve(tilted_top(), rtol=1e-14, atol=1e-16, formulation=f) for f in ("euler", "lagrangian"))
    assert euler.success and lagrange.success
    assert "lagrang" in lagrange.plan.model.lower() and "lagrang" not in euler.plan.model.lower()
    sizes = np.linalg.norm(euler.omega, axis=1)
    assert np.linalg.norm(euler.omega - lagrange.omega, axis=1).max() < 1e-12 * sizes.max()
    same = np.minimum(np.abs(euler.attitude - lagrange.attitude), np.abs(euler.attitude + lagrange.attitude))
    assert same.max() < 5e-13
    assert np.ptp(euler.attitude[:, 2]) > 0.5, "it does turn"


def passing_the_pole(distance):
    """A free body that starts this far from theta = 0 and comes back as near: scene, and its closed form."""
    moments, omega, times = [0.4, 0.4, 0.2], [0.0, 2.0, 4.0], np.linspace(0.0, 20.0, 201)
    start = [np.sin(distance / 2), 0.0, 0.0, np.cos(distance / 2)]
    scene = ph.Scene(inertia=moments, omega=omega, attitude=start, times=times)
    return scene, ph.FreeMotion(moments, omega, start).at(times)[1]


def attitude_error(motion, truth):
    signs = (motion.attitude - truth, motion.attitude + truth)
    return 2 * np.minimum(*(np.linalg.norm(d, axis=1) for d in signs)).max()


def test_lagranges_angles_fail_at_the_pole_and_say_so():
    with pytest.raises(ph.InvalidInput, match="theta"):
        ph.solve(tilted_top(attitude=[0.0, 0.0, 0.0, 1.0]), formulation="lagrangian")

    steps = {}
    for distance in (0.5, 1e-4):
        scene, truth = passing_the_pole(distance)
        euler, lagrange = (ph.solve(scene, rtol=1e-10, atol=1e-12, formulation=f) for f in ("euler", "lagrangian"))
        assert attitude_error(euler, truth) < 3e-9, "a quaternion does not see the pole"
        steps[distance] = lagrange.stats["steps"]
    assert steps[1e-4] > 3 * steps[0.5]
    assert attitude_error(lagrange, truth) > 1e-8
    assert not lagrange.success and "drifted" in lagrange.message


def test_generalised_forces_of_the_library():
    """Q_psi is the torque's z' component; Q_phi and Q_theta are those about space's z and the line of nodes."""
    torque, angles = [0.7, -1.2, 0.4], [0.3, 1.1, -0.6]
    (_, th, ps) = angles
    q = ph.generalised_forces(torque, angles)
    assert q[2] == torque[2]
    space_z = [np.sin(th) * np.sin(ps), np.sin(th) * np.cos(ps), np.cos(th)]
    about_node = torque[0] * np.cos(ps) - torque[1] * np.sin(ps)
    np.testing.assert_allclose(q[:2], [np.dot(torque, space_z), about_node], rtol=1e-15)


def test_the_solver_keeps_both_invariants():
    """Problem 3 on a run of the solver, whose drift shrinks with the tolerance."""
    free = ph.Scene(inertia=[0.2, 0.4, 0.52], omega=[1.0, 2.0, 3.0], times=np.linspace(0.0, 20.0, 41))
    drifts = []
    for rtol in (1e-6, 1e-9, 1e-12):
        omega = ph.solve(free, rtol=rtol, atol=0.0, method="rk45").omega
        square, energy = np.sum((omega * [0.2, 0.4, 0.52]) ** 2, axis=1), np.sum(omega**2 * [0.2, 0.4, 0.52], axis=1)
        drifts.append(max(np.ptp(square) / square[0], np.ptp(energy) / energy[0]))
    assert drifts[0] > 1e-9, "a tolerance of 1e-6 must show"
    assert drifts[1] < 1e-2 * drifts[0] and drifts[2] < 1e-10
