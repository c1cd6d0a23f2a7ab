"""Scenes with rotors and no torque: the planner evaluates the gyrostat's closed form, in windows too."""

import numpy as np
import pytest
from measures import attitude_error, rates_error

import polhode as ph
from polhode import _core

BLOCK = (0.20, 0.40, 0.52)
OMEGA = (1.0, 2.0, 3.0)
TIMES = np.linspace(-4, 12, 65)
TILTED = ph.InertiaTensor.from_moments(BLOCK).rotated(ph.Rotation.from_rotvec((0.3, -0.5, 0.2)))
WHEEL = ph.Rotor((0, 0, 1), momentum=0.5)


def scene(**parts):
    return ph.Scene(**{"inertia": BLOCK, "omega": OMEGA, "times": TIMES, "rotors": [WHEEL], **parts})


@pytest.mark.parametrize("parts", [
    {}, {"inertia": TILTED}, {"inertia": (0.4, 0.4, 0.2)}, {"inertia": (0.2, 0.4, 0.4)}, {"inertia": (0.3, 0.3, 0.3)},
    {"omega": (0, 0, 2)}, {"omega": (1e-4, 5, 1e-4), "rotors": [ph.Rotor((0, 1, 0), momentum=0.1)]},
    {"rotors": [ph.Rotor((1, -2, 2), momentum=0.7), ph.Rotor((0, 1, 0), inertia=0.1, speed=-2.0)]},
    {"rotors": [ph.Rotor((1, -2, 2), inertia=0.05, speed=9.0, free=True)]},
    {"inertia": TILTED, "rotors": [ph.Rotor((0, 1, 0), inertia=0.05, speed=9.0, free=True), WHEEL]},
    {"rotors": [ph.Rotor((0, 0, 1), momentum=h) for h in (800.0, -800.0, 650.0, -649.5)]},
    {"t0": 0.1}], ids=str)
def test_every_body_with_rotors_is_evaluated(parts):
    some = scene(**parts)
    motion = ph.solve(some, 1e-11)
    assert (motion.plan.method, motion.plan.model) == ("exact", "gyrostat") and motion.success
    assert any("free gyrostat" in reason for reason in motion.plan.reasons)
    truth = _core.reference(some, 30, 1e-20, 10**6)
    assert rates_error(motion.omega, truth[0]) <= motion.error < 3e-12
    assert attitude_error(motion.attitude, truth[1]) <= motion.error
    assert set(motion.drift) == {"energy", "angular_momentum"} and max(motion.drift.values()) < 1e-13


def test_the_bound_has_the_rounding_of_the_rotors():
    """One axis of the body: the product is exact. A skew axis, a sum that cancels, a free rotor: it is not."""
    plain = ph.plan(scene()).predicted_error
    assert plain == pytest.approx(20 * 2.0**-52)
    for rotors in ([ph.Rotor((1, 2, 2), momentum=0.5)], [ph.Rotor((0, 0, 1), inertia=0.1, speed=5.0)],
                   [ph.Rotor((0, 0, 1), inertia=0.1, speed=5.0, free=True)],
                   [ph.Rotor((0, 0, 1), inertia=0.1, momentum=0.5, free=True)],   # what it leaves of the inertia
                   [ph.Rotor((0, 0, 1), momentum=h) for h in (0.1, 0.7, 0.2)]):
        error = ph.plan(scene(rotors=rotors)).predicted_error
        assert 1.2 * plain < error < (2e-11 if len(rotors) > 1 else 2e-13)
    several = [ph.Rotor(axis, momentum=0.5) for axis in np.eye(3)]
    cancelling = [ph.Rotor((0, 0, 1), momentum=h) for h in (800.0, -800.0, 650.0, -649.5)]   # exactly
    for rotors in (several, cancelling):
        assert ph.plan(scene(rotors=rotors)).predicted_error == pytest.approx(plain)


def test_a_body_at_rest_stays_at_rest():
    motion = ph.solve(scene(omega=(0, 0, 0)), 1e-12)
    assert motion.plan.model == "gyrostat" and motion.success
    assert not motion.omega.any() and np.ptp(motion.attitude, axis=0).max() < 1e-15


def test_next_to_the_birth_of_a_steady_turn_the_bound_is_that_of_the_inputs():
    """The steady turn on the smallest sphere that has it, found by ternary search; the period grows beyond bounds."""
    J, h, low, high = np.array([1.0, 1.6, 2.2]), np.array([0.1, 0.5, 0.3]), 1 / 2.2 + 1e-3, 1 / 1.6 - 1e-3
    for _ in range(200):
        a, b = low + (high - low) / 3, high - (high - low) / 3
        size = [np.sum((h / (1 - rate * J)) ** 2) for rate in (a, b)]
        low, high = (low, b) if size[0] < size[1] else (a, high)
    wheels = [ph.Rotor(axis, momentum=x) for axis, x in zip(np.eye(3), h, strict=True)]
    for off in (0.0, 1e-11, 1e-6, 1e-2):
        omega = (h / (1 - low * J) * (1 + off * np.array([1, -1, 1])) - h) / J
        some = ph.Scene(inertia=J, omega=omega, rotors=wheels, times=np.linspace(0, 60, 31))
        motion = ph.solve(some, 1e-10)
        assert motion.plan.model == "gyrostat" and 5e-15 < motion.error < 1e-9
        truth = _core.reference(some, 30, 1e-20, 10**6)
        assert rates_error(motion.omega, truth[0]) <= motion.error
        assert attitude_error(motion.attitude, truth[1]) <= motion.error


def test_no_rotor_is_freemotion_bit_for_bit():
    free = ph.FreeMotion(BLOCK, OMEGA).at(TIMES)
    for rotors in ([], [ph.Rotor((0, 0, 1), momentum=0.0)], [WHEEL, ph.Rotor((0, 0, 1), momentum=-0.5)]):
        motion = ph.solve(scene(rotors=rotors), 1e-12)
        assert motion.plan.model == "triaxial"
        np.testing.assert_array_equal(motion.omega, free[0])
        np.testing.assert_array_equal(motion.attitude, free[1])
    one = ph.solve(scene(), 1e-12)
    other = ph.Gyrostat(BLOCK, rotors=[WHEEL], omega=OMEGA).at(TIMES)
    np.testing.assert_array_equal(one.omega, other[0])
    np.testing.assert_array_equal(one.attitude, other[1])


@pytest.mark.parametrize("inertia", [BLOCK, TILTED], ids=["principal axes", "tilted"])
def test_a_wheel_spun_up_in_many_windows(inertia):
    """Ten commands one after another, each a piece with a closed form, against Taylor series at their finest."""
    axis, edges = (0, 1, 0), np.linspace(0, 10, 11)
    steps = [ph.Rotor(axis, momentum=0.1 * (k + 1), during=(edges[k], edges[k + 1])) for k in range(10)]
    some = scene(inertia=inertia, rotors=steps, times=np.linspace(0, 12, 97))
    motion = ph.solve(some, 1e-12, method="exact")
    assert [piece.model for piece in motion.plan.pieces] == ["gyrostat"] * 10 + ["triaxial"]
    assert motion.success and motion.stats["steps"] == 0
    stepped = ph.solve(some, method="taylor", rtol=1e-16)
    assert rates_error(motion.omega, stepped.omega) < 1e-13
    assert attitude_error(motion.attitude, stepped.attitude) < 1e-13
    truth = _core.reference(some, 30, 1e-20, 10**6)
    assert rates_error(motion.omega, truth[0]) < motion.error
    assert attitude_error(motion.attitude, truth[1]) < motion.error
    assert motion.drift["angular_momentum"] < 1e-13


def test_gyrostats_beside_stepped_pieces_carry_the_error():
    kick = ph.torques.During(ph.torques.Constant((0.05, -0.02, 0.03)), [(3, 4)])
    some = scene(torques=[kick], times=np.linspace(0, 200, 81))
    for accuracy in (1e-6, 1e-9, 1e-11):
        motion = ph.solve(some, accuracy)
        assert [piece.model for piece in motion.plan.pieces] == ["gyrostat", "euler", "gyrostat"] and motion.success
        truth = _core.reference(some, 30, 1e-20, 10**6)
        assert rates_error(motion.omega, truth[0]) <= motion.error <= accuracy
        assert attitude_error(motion.attitude, truth[1]) <= motion.error


def switched(length, inertia=BLOCK, axis=(1, 2, 2)):
    """Four speeds of a wheel, each for the same time."""
    edges = length * np.arange(5)
    wheels = [ph.Rotor(axis, momentum=0.1 * (k + 1), during=(edges[k], edges[k + 1])) for k in range(4)]
    return scene(inertia=inertia, rotors=wheels, times=np.linspace(0, edges[-1], 21))


@pytest.mark.parametrize("inertia", [BLOCK, TILTED], ids=["principal axes", "tilted"])
@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9])
def test_short_gyrostats_are_stepped_and_long_ones_are_not(inertia, accuracy):
    """The time of closed forms does not depend on the span, that of steps does."""
    short, long = (ph.solve(switched(length, inertia), accuracy) for length in (0.3, 100.0))
    assert [piece.method for piece in short.plan.pieces] == ["taylor"] * 4 and short.stats["steps"] > 0
    assert [piece.model for piece in long.plan.pieces] == ["gyrostat"] * 4 and long.stats["steps"] == 0
    for motion in (short, long):
        assert motion.success and motion.error <= accuracy
    truth = _core.reference(short.plan.scene, 30, 1e-20, 10**6)
    assert rates_error(short.omega, truth[0]) <= short.error
    assert attitude_error(short.attitude, truth[1]) <= short.error
    assert any("4 pieces are free gyrostats" in reason for reason in short.plan.reasons)
    assert "takes longer than steps in 4 of 4 pieces" in str(short.plan)
    assert not any("free gyrostats" in reason for reason in long.plan.reasons)


@pytest.mark.parametrize("certify", [True, False])
def test_the_choice_for_gyrostats_is_the_one_of_the_smaller_forecast(certify):
    for length in (0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 1000.0):
        for axis in ((0, 0, 1), (1, 2, 2)):
            some = switched(length, axis=axis)
            chosen, forms, steps = (ph.plan(some, 1e-6, certify=certify, method=method).predicted_seconds
                                    for method in (None, "exact", "taylor"))
            # The forecast of a plan has its pilot run's time in it only in part, so that near a draw either may win.
            assert chosen < 1.5 * min(forms, steps), (length, axis, chosen, forms, steps)


def test_many_digits_are_left_to_the_closed_form():
    """The rounding of the steps alone is more than 1e-13 here."""
    some = switched(1.0)
    assert ph.solve(some, 1e-13).success and not ph.solve(some, 1e-13, method="taylor").success
    assert ph.plan(some, 1e-13).method == "exact" and ph.plan(some, 1e-9).method == "taylor"


def test_gyrostats_are_judged_by_the_rates_that_the_pilot_run_finds():
    """At the start's rates, a hundredth of a rad/s, steps would take less time. A torque spins the body up first."""
    spin_up = ph.torques.During(ph.torques.Constant((0, 0.5, 10)), [(0, 10)])
    some = scene(omega=(0.01, 0, 0), rotors=[ph.Rotor((1, 2, 2), momentum=0.5, during=(10, 60))], t0=0,
                 times=np.linspace(0, 60, 21))
    assert [piece.method for piece in ph.plan(some, 1e-6).pieces] == ["exact", "taylor"]
    spun = ph.solve(some.replace(torques=[spin_up]), 1e-6)
    assert [piece.model for piece in spun.plan.pieces] == ["euler", "gyrostat"] and spun.success
    truth = _core.reference(spun.plan.scene, 30, 1e-20, 10**6)
    assert rates_error(spun.omega, truth[0]) <= spun.error
    assert attitude_error(spun.attitude, truth[1]) <= spun.error


def test_the_forecast_counts_the_closed_forms_that_bound_the_error():
    """Each rounded component of the rotors' momentum is changed alone, and the inertia of a tilted body twice."""
    def seconds(axis, inertia=BLOCK):
        some = scene(inertia=inertia, rotors=[ph.Rotor(axis, momentum=0.5)])
        return ph.plan(some, 1e-9).predicted_seconds

    plain = seconds((0, 0, 1))
    one = (seconds((1, 2, 2)) - plain) / 3
    assert one > 0.2 * plain   # a set-up is most of a plan's time
    assert seconds((0, 1, 1)) - plain == pytest.approx(2 * one)
    assert seconds((1, 2, 2), TILTED) - plain == pytest.approx(5 * one)


def test_events_and_dense_output():
    some = scene(times=np.linspace(0, 12, 49))
    motion = ph.solve(some, 1e-11, dense=True, events=[ph.Event(lambda t, w, q: w[0])])
    stepped = ph.solve(some, 1e-11, method="taylor", events=[ph.Event(lambda t, w, q: w[0])])
    assert len(motion.events) == len(stepped.events) > 3
    np.testing.assert_allclose([e.t for e in motion.events], [e.t for e in stepped.events], atol=1e-9)
    between = ph.Gyrostat(BLOCK, rotors=[WHEEL], omega=OMEGA).at([3.3])
    np.testing.assert_allclose(motion([3.3])[0], between[0], rtol=1e-14)


def test_rotors_beside_damping_are_stepped():
    """Damping takes J omega, and h stays: no change of time turns this into a free motion."""
    some = scene(torques=[ph.torques.AngularDamping(0.3)], times=np.linspace(0, 5, 21))
    motion = ph.solve(some, 1e-10)
    assert motion.plan.method != "exact" and any("keep their momentum" in reason for reason in motion.plan.reasons)
    truth = _core.reference(some, 30, 1e-20, 10**6)
    assert rates_error(motion.omega, truth[0]) <= motion.error


def test_a_method_may_still_be_asked_for():
    plan = ph.plan(scene(), method="taylor")
    assert plan.method == "taylor" and not any("No closed form" in reason for reason in plan.reasons)
    assert "gyrostat" in str(ph.plan(scene()))


def test_a_wheel_along_the_pivots_axis_leaves_the_pendulum():
    """The reaction wheel pendulum: h x omega vanishes. A wheel across the axis turns the body out of its plane."""
    parts = {"inertia": (0.3, 0.5, 0.6), "omega": (1.5, 0, 0), "torques": [ph.torques.Gravity(2.0, (0, 0, -0.7))],
             "times": np.linspace(0, 9, 46)}
    plain = ph.solve(ph.Scene(**parts), 1e-12)
    motion = ph.solve(ph.Scene(**parts, rotors=[ph.Rotor((1, 0, 0), momentum=3.0)]), 1e-12)
    assert motion.plan.model == "pendulum"
    np.testing.assert_array_equal(motion.omega, plain.omega)
    across = ph.plan(ph.Scene(**parts, rotors=[ph.Rotor((0, 1, 0), momentum=3.0)]))
    assert across.method != "exact" and any("not along the axis of rotation" in reason for reason in across.reasons)
    steps = [ph.Rotor((1, 0, 0), momentum=0.3, during=(1, 3)), ph.Rotor((1, 0, 0), momentum=-0.2, during=(3, 5))]
    chain = ph.Scene(**parts, rotors=steps)
    motion = ph.solve(chain, 1e-10)
    assert [piece.model for piece in motion.plan.pieces] == ["pendulum"] * 4 and motion.success
    truth = _core.reference(chain, 30, 1e-20, 10**6)
    assert rates_error(motion.omega, truth[0]) < motion.error


@pytest.mark.parametrize("torques, rotors, start", [
    ([ph.torques.Gravity(weight=3.0, arm=(0.1, 0.2, 0.3))], [], "Gravity acts, but no closed form is known"),
    ([ph.torques.Gravity(weight=3.0, arm=(0.1, 0.2, 0.3))], [ph.Rotor((1, 2, 2), momentum=0.4)], "Gravity acts, but"),
    ([ph.torques.Damping((0.1, 0.2, 0.3))], [], "Damping acts, but no closed form is known"),
    ([ph.torques.Damping((0.1, 0.2, 0.3))], [ph.Rotor((1, 2, 2), momentum=0.4)], "Damping acts, but"),
    ([ph.torques.Damping((0.1, 0.2, 0.3)), ph.torques.Gravity(weight=3.0, arm=(0.1, 0.2, 0.3))], [],
     "No closed form is known with these torques"),
])
def test_the_plan_says_which_torque_has_no_closed_form(torques, rotors, start):
    scene = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=[1.0], torques=torques, rotors=rotors)
    assert ph.plan(scene, accuracy=1e-9).reasons[0].startswith(start)
