"""Rotors that start and stop: omega jumps by -J^-1 dh, and J omega + h is continuous."""

import numpy as np
import pytest
from measures import attitude_error, error, rates_error

import polhode as ph
from polhode import _core

BLOCK = (0.20, 0.40, 0.52)
OMEGA = (1.0, 2.0, 3.0)
TILTED = ph.InertiaTensor.from_moments(BLOCK).rotated(ph.Rotation.from_rotvec((0.3, -0.5, 0.2)))
AXIS = np.array([1.0, 2.0, 2.0]) / 3
STEPS = [ph.Rotor(AXIS, momentum=0.3, during=(2, 5)), ph.Rotor(AXIS, momentum=0.7, during=(5, 9))]


def scene(**parts):
    return ph.Scene(**{"inertia": TILTED, "omega": OMEGA, "times": np.linspace(0, 12, 121), "rotors": STEPS, **parts})


def by_hand(some, edges, momenta, rtol=1e-13):
    """Solve piece after piece with constant rotors, and add each jump."""
    J, t, rows, h = some.inertia.matrix, some.times, [], 0.0
    omega, attitude = some.omega, some.attitude
    for begin, end, momentum in zip(edges[:-1], edges[1:], momenta):
        omega = omega - np.linalg.solve(J, (momentum - h) * AXIS)
        h = momentum
        inside = t[(t >= begin) & (t < end)]
        motion = ph.solve(ph.Scene(inertia=some.inertia, omega=omega, attitude=attitude, t0=begin,
                                   times=[*inside, end], rotors=[ph.Rotor(AXIS, momentum=h)] if h else (),
                                   torques=some.torques), method="dop853", rtol=rtol)
        rows += list(zip(motion.omega[:-1], motion.attitude[:-1]))
        omega, attitude = motion.omega[-1], motion.attitude[-1]
    rows += [(omega, attitude)] * int(t[-1] == edges[-1])
    return {"omega": np.array([row[0] for row in rows]), "attitude": np.array([row[1] for row in rows])}


@pytest.mark.parametrize("torques", [(), (ph.torques.Gravity(2.0, (0.1, 0.2, 0.3)),)], ids=["free", "heavy"])
def test_a_wheel_spun_up_in_steps(torques):
    some = scene(torques=torques)
    motion = ph.solve(some, 1e-10)
    exact = by_hand(some, (0, 2, 5, 9, 12), (0, 0.3, 0.7, 0))
    models = ["euler"] * 4 if torques else ["triaxial", "euler", "euler", "triaxial"]   # short gyrostats are stepped
    assert motion.success and [piece.model for piece in motion.plan.pieces] == models
    assert [piece.torques[-1:] for piece in motion.plan.pieces[1:3]] == [("rotors",), ("rotors",)]
    assert error(motion.omega, motion.attitude, exact) < motion.error < 1e-10
    long_double = _core.reference(some, 30, 1e-20, 10**6)
    assert rates_error(motion.omega, long_double[0]) < motion.error
    if not torques:   # the motor's torque is internal
        assert set(motion.drift) == {"angular_momentum"} and motion.drift["angular_momentum"] < 1e-12
    else:
        assert set(motion.drift) == {"vertical_momentum"} and motion.drift["vertical_momentum"] < 1e-11
    assert any("continuous" in reason for reason in motion.plan.reasons)


@pytest.mark.parametrize("method", ["taylor", "rk45", "radau", "dmv8"])
def test_every_way_of_stepping_takes_the_jumps(method):
    some = scene(times=[1.0, 4.0, 8.0, 12.0])
    options = {"step": 1e-3} if method == "dmv8" else {"rtol": 1e-12}
    motion = ph.solve(some, method=method, **options)
    exact = ph.solve(some, 1e-10)
    bound = 1e-5 if method == "dmv8" else 1e-8
    assert rates_error(motion.omega, exact.omega) < bound
    assert attitude_error(motion.attitude, exact.attitude) < bound


def test_the_jump_is_that_of_the_inertia():
    """Samples a moment before and at a begin, at an end, and at the last time."""
    wheel = ph.Rotor(AXIS, momentum=0.3, during=[(2, 5), (9, 20)])
    jump = -np.linalg.solve(TILTED.matrix, 0.3 * AXIS)
    times = np.array([2 - 1e-9, 2.0, 5 - 1e-9, 5.0, 9 - 1e-9, 9.0])
    for accuracy in ({"accuracy": 1e-11}, {"rtol": 1e-12}):
        omega = ph.solve(scene(rotors=[wheel], times=times), **accuracy).omega
        for i, sign in ((0, 1), (2, -1), (4, 1)):
            np.testing.assert_allclose(omega[i + 1] - omega[i], sign * jump, atol=1e-7)
    motion = ph.solve(scene(rotors=[ph.Rotor(AXIS, inertia=0.1, speed=3.0, during=[(2, 5), (9, 20)])], times=times))
    assert motion.rotor_speed[:, 0].tolist() == [0, 3, 3, 0, 0, 3]
    np.testing.assert_allclose(motion.angular_momentum, np.tile(TILTED.matrix @ OMEGA, (6, 1)), atol=1e-8)


def test_backwards_and_from_within_a_window():
    """The start's omega holds at t0, with the rotors that rotate then."""
    there = ph.solve(scene(times=[0.0, 3.0, 5.0, 7.0, 12.0]), 1e-11)
    for i, t0 in ((1, 3.0), (2, 5.0), (4, 12.0)):
        again = scene(omega=there.omega[i], attitude=there.attitude[i], t0=t0, times=there.t)
        motion = ph.solve(again, 1e-11)
        assert rates_error(motion.omega[i], there.omega[i]) < 1e-15
        assert rates_error(motion.omega, there.omega) < 1e-10
        assert attitude_error(motion.attitude, there.attitude) < 1e-10
        backwards = _core.reference(again, 30, 1e-20, 10**6)
        assert rates_error(motion.omega, backwards[0]) < 1e-12


def test_windows_outside_the_span_cut_nothing():
    always = ph.solve(scene(rotors=[ph.Rotor(AXIS, momentum=0.3, during=(-1, 99))]), 1e-10)
    assert not always.plan.pieces
    assert rates_error(always.omega, ph.solve(scene(rotors=[ph.Rotor(AXIS, momentum=0.3)]), 1e-10).omega) == 0
    never = ph.solve(scene(rotors=[ph.Rotor(AXIS, momentum=0.3, during=(50, 99))]), 1e-10)
    assert never.plan.model == "triaxial"


def test_a_rotor_and_a_thruster_share_an_edge():
    firing = ph.torques.During(ph.torques.Constant((0.1, -0.2, 0.3)), (2, 5))
    some = scene(rotors=[ph.Rotor(AXIS, momentum=0.3, during=(2, 5))], torques=[firing])
    motion = ph.solve(some, 1e-10)
    assert motion.success and len(motion.plan.pieces) == 3
    assert rates_error(motion.omega, _core.reference(some, 30, 1e-20, 10**6)[0]) < motion.error


def test_free_rotors_keep_their_momentum_over_the_pieces():
    free = ph.Rotor((0, 1, 0), inertia=0.05, speed=9.0, free=True)
    some = scene(inertia=BLOCK, rotors=[free, *STEPS])
    motion = ph.solve(some, 1e-10)
    assert rates_error(motion.omega, _core.reference(some, 30, 1e-20, 10**6)[0]) < motion.error
    momentum = 0.05 * (motion.rotor_speed[:, 0] + motion.omega[:, 1])
    np.testing.assert_allclose(momentum, 0.05 * (9.0 + OMEGA[1]), rtol=1e-12)
    assert motion.drift["angular_momentum"] < 1e-12


def test_dense_output_and_many_bodies_have_the_jumps():
    some = scene()
    motion = ph.solve(some, 1e-10, dense=True)
    omega, _ = motion([1.95, 2.05, 8.0])
    assert rates_error(omega, ph.solve(some.replace(times=[1.95, 2.05, 8.0]), 1e-10).omega) < 1e-9
    many = ph.solve_many([some, some], rtol=1e-11, method="taylor")
    assert not many.lanes.any() and rates_error(many.omega[1], motion.omega) < 1e-8
