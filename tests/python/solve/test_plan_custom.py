"""Plans for torques of the user's own: by the number of calls, after a pilot run, the same whatever a call costs."""

import math
import time

import numpy as np
import pytest
from measures import error

import polhode as ph

HELD = (0.3, -0.2, 1.5)       # momentum of the rotor, body axes [kg m^2/s]
DIPOLE = (0.2, 0.1, 0.4)      # of the body [A m^2]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def rotor(t, omega, attitude):
    return cross(HELD, omega)


def magnet(t, omega, attitude):
    """A dipole of the body in a field that turns about space z."""
    x, y, z, s = attitude
    field = [0.03 * math.cos(0.1 * t), 0.03 * math.sin(0.1 * t), 0.02]
    v = [-x, -y, -z]
    across = [2 * part for part in cross(v, field)]
    twice = cross(v, across)
    return cross(DIPOLE, [field[i] + s * across[i] + twice[i] for i in range(3)])


def satellite(t, omega, attitude):
    return [a + b for a, b in zip(rotor(t, omega, attitude), magnet(t, omega, attitude), strict=True)]


def make(function, span, **changes):
    return ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), torques=[ph.torques.Custom(function)],
                    times=np.linspace(0, span, 11)).replace(**changes)


def count_least_calls(scene, accuracy):
    runs = [ph.solve(scene, method=name, rtol=accuracy / 100, max_steps=20_000) for name in ("rk45", "dop853", "radau")]
    return min(run.stats["derivatives"] for run in runs if run.status == "finished")


@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9, 1e-11])
@pytest.mark.parametrize(("function", "span"), [(lambda t, w, q: -0.1 * w, 5), (rotor, 20), (magnet, 20),
                                                (satellite, 20)])
def test_a_plan_takes_at_most_three_times_the_calls_of_the_best_method(function, span, accuracy):
    scene = make(function, span)
    motion = ph.solve(scene, accuracy)
    assert motion.success and motion.plan.method in ("rk45", "dop853")
    assert motion.stats["derivatives"] <= 3 * count_least_calls(scene, accuracy)


def test_the_rotor_turns_as_the_library_s_own_torque_of_the_same_form():
    x, y, z = HELD
    skew = np.array(((0, z, -y), (-z, 0, x), (y, -x, 0)))   # -C w = h x w
    known = make(rotor, 20).replace(torques=[ph.torques.Damping(skew)])
    omega, attitude, _ = ph._core.reference(known, 26, 1e-21, 100_000)
    for accuracy in (1e-3, 1e-6, 1e-9):
        motion = ph.solve(make(rotor, 20), accuracy)
        found = error(motion.omega, motion.attitude, {"omega": omega, "attitude": attitude}, motion.scene.omega)
        assert found <= motion.error <= accuracy


def test_stiff_damping_takes_the_implicit_method_and_few_calls():
    for function in (lambda t, w, q: -np.array((1e3, 1, 1)) * w, lambda t, w, q: -np.array((1e3, 1, 1)) * w * (t > 10)):
        plan = ph.plan(make(function, 20), 1e-6)
        assert plan.method == "radau" and plan.facts["stiffness"] > 5000, plan.facts
    calls = []

    def brake(t, omega, attitude):
        calls.append(t)
        return -np.array((1e3, 1, 1)) * omega

    ph.plan(make(brake, 1e9), 1e-6)
    assert len(calls) < 10_000   # whatever the span


def test_a_choice_does_not_depend_on_what_a_call_costs():
    def slow(t, omega, attitude):
        end = time.perf_counter() + 1e-4
        while time.perf_counter() < end:
            pass
        return rotor(t, omega, attitude)

    quick, dear = (ph.plan(make(function, 20), 1e-6) for function in (rotor, slow))
    assert (quick.method, quick.rtol) == (dear.method, dear.rtol)
    assert dear.facts["call_seconds"] >= 1e-4 > quick.facts["call_seconds"]
    assert dear.predicted_seconds > 3 * quick.predicted_seconds
    assert "calls your torque least" in str(dear)


def test_a_pilot_run_counts_the_turns_and_the_work():
    facts = ph.plan(make(lambda t, w, q: np.array((0.0, 0.1, 0.2)) * np.sin(40 * t), 20), 1e-6).facts
    assert 11 < facts["turns"] < 13 and facts["effort"] > 2 * facts["turns"]
