"""Formulas with switches by Taylor series: against 25 digits from modes written by hand, with located switches."""

import json
from pathlib import Path

import numpy as np
import pytest
from measures import attitude_error, rates_error

import polhode as ph
from polhode.formula import friction, to_body
from polhode.torques import Constant, During, Formula

TRUTH = json.loads((Path(__file__).parents[2] / "reference" / "formula_switches.json").read_text())
START, TIMES = TRUTH["start"], np.array(TRUTH["times"])
Q = np.array(START["attitude"]) / np.linalg.norm(START["attitude"])
BLOCK = np.diag([1.0, 2.0, 2.5])


def control(t, omega, attitude, p):
    return -p.kp * attitude[:3] * attitude[3] - p.kd * omega


def clipped(t, omega, attitude, p):
    return np.clip(control(t, omega, attitude, p), -p.limit, p.limit)


def slowed(t, omega, attitude, p):
    return -0.3 * np.abs(omega) * omega


def lit(t, omega, attitude, p):
    sun = (np.cos(0.7 * t), np.sin(0.7 * t), 0)
    return np.where(np.cos(0.7 * t + 0.3) > -0.4, 0.4, 0.0) * np.cross((0.3, 0.2, 0.5), to_body(attitude, sun))


def bang(t, omega, attitude, p):
    return -0.1 * np.sign(attitude[:3] + 0.5 * omega)


def step(t, omega, attitude, p):
    return np.where(omega[0] > 0.2, -0.5, 0.3) * np.array([0, 1, 0]) - 0.1 * omega


def rubbed(t, omega, attitude, p):
    drive = 0.3 * to_body(attitude, (np.cos(t), 0, np.sin(t)))
    return drive + np.stack([friction(0.12, omega[0]), friction(0.2, omega[1]), 0.0])


LAWS = {"Clipped": (clipped, dict(kp=0.7, kd=0.5, limit=0.2)), "Slowed": (slowed, {}), "Lit": (lit, {}),
        "Bang": (bang, {}), "Step": (step, {}), "Rubbed": (rubbed, {})}


def make(law):
    function, parameters = LAWS[law]
    return Formula(function, recognise=False, **parameters)


def scene(torques, inertia=BLOCK, **more):
    given = dict(inertia=np.array(inertia), omega=START["omega"], attitude=Q, torques=torques, times=TIMES)
    return ph.Scene(**(given | more))


def find_errors(motion, rows):
    """Of the rates relative to the largest one, and of the attitude as an angle."""
    return rates_error(motion.omega, rows[:, :3], START["omega"]), attitude_error(motion.attitude, rows[:, 3:])


@pytest.mark.parametrize("case", TRUTH["cases"], ids=lambda case: f"{case['law']}-{case['inertia'][0][1]}")
def test_the_bound_holds_of_every_law(case):
    rows = np.array(case["rows"], dtype=float)
    for accuracy in (1e-2, 1e-4, 1e-6, 1e-8, 1e-9, 1e-10, 1e-12):
        motion = ph.solve(scene([make(case["law"])], case["inertia"]), accuracy)
        assert motion.plan.method == "taylor" and motion.success and motion.error_kind == "bounded"
        assert max(find_errors(motion, rows)) <= motion.error <= accuracy
        plain = ph.solve(scene([make(case["law"])], case["inertia"]), accuracy, certify=False)
        assert max(find_errors(plain, rows)) <= 10 * accuracy


@pytest.mark.parametrize("number", [0, 1])
def test_steps_of_a_hard_limiter(number):
    case = TRUTH["cases"][number]
    limited = ph.solve(scene([make("Clipped")], case["inertia"]), 1e-9)
    smooth = ph.solve(scene([Formula(control, kp=0.7, kd=0.5)], case["inertia"]), 1e-9)
    assert limited.stats["steps"] <= 1.5 * smooth.stats["steps"] + 3 * len(case["switches"])


@pytest.mark.parametrize("law", ["Clipped", "Lit", "Bang", "Step", "Rubbed"])
def test_samples_at_a_switch_and_next_to_it(law):
    for case in TRUTH["cases"]:
        if case["law"] != law:
            continue
        fine = None
        for t in np.array(case["switches"], dtype=float):
            side = np.sign(t) * np.inf
            times = [np.nextafter(t, -side), t, np.nextafter(t, side), TIMES[-1] if t > 0 else TIMES[0]]
            motion = ph.solve(scene([make(law)], case["inertia"], times=times), 1e-9)
            assert motion.error_kind == "bounded"
            # no jump of the state, and the later truth
            assert np.abs(motion.omega[:3] - motion.omega[1]).max() < 1e-12
            rows = np.array(case["rows"], dtype=float)[-1 if t > 0 else 0]
            assert np.abs(motion.omega[3] - rows[:3]).max() <= 2 * motion.error
            # a run that starts where another has switched
            again = ph.solve(scene([make(law)], case["inertia"], omega=motion.omega[1], attitude=motion.attitude[1],
                                   t0=t, times=times[3:]), 1e-9)
            fine = again if again.status == "finished" else fine
            if again.status == "finished":
                assert np.abs(again.omega[0] - rows[:3]).max() < 1e-8
        assert fine is not None


def test_dense_output_and_events():
    for law in ("Clipped", "Bang", "Rubbed"):
        whole = ph.solve(scene([make(law)]), 1e-9, dense=True)
        omega, attitude = whole(TIMES)
        np.testing.assert_allclose(omega, whole.omega, rtol=0, atol=1e-14)
        np.testing.assert_allclose(attitude, whole.attitude, rtol=0, atol=1e-14)
        reference = ph.solve(scene([make(law)], times=np.linspace(-1.5, 8, 500)), 1e-11)
        omega, _ = whole(np.linspace(-1.5, 8, 500))
        np.testing.assert_allclose(omega, reference.omega, rtol=0, atol=1e-8)


def test_windows_that_end_next_to_a_switch():
    t = float(TRUTH["cases"][0]["switches"][2])
    for edge in (np.nextafter(t, 0), t, np.nextafter(t, 9), t + 1e-9):
        torques = [During(make("Clipped"), [(-1.0, edge)]), Constant((0.1, 0.0, 0.05))]
        fine = ph.solve(scene(torques), method="dop853", rtol=1e-13)
        motion = ph.solve(scene(torques), 1e-9)
        assert motion.error_kind == "bounded"
        assert max(find_errors(motion, np.hstack([fine.omega, fine.attitude]))) <= motion.error + 2e-11


def test_friction_that_holds_and_lets_go():
    """About one axis: the torque t / 10 and a load of 0.2. It holds until t = 2, then w' = (t - 2) / 10."""
    def law(t, omega, attitude, p):
        return np.stack([0.1 * t + friction(0.2, omega[0]), 0.0, 0.0])
    times = [0.0, 1.0, 2.0, np.nextafter(2.0, 3), 4.0]
    held = ph.solve(ph.Scene(inertia=BLOCK, omega=(0, 0, 0), torques=[Formula(law)], times=times), 1e-9)
    assert held.success and held.error_kind == "bounded"
    np.testing.assert_allclose(held.omega[:, 0], [0, 0, 0, 0, 0.2], rtol=0, atol=1e-12)
    # from 0.3 rad/s it stops where 0.3 - 0.2 t + t^2 / 20 = 0: after 4 s, or never
    moving = ph.solve(ph.Scene(inertia=BLOCK, omega=(0.15, 0, 0), torques=[Formula(law)], times=[1.0, 1.5, 5.0]), 1e-9)
    np.testing.assert_allclose(moving.omega[:, 0], [0, 0, 0.45], rtol=0, atol=1e-9)
    text = Formula(text="[0.1 * t + friction(0.2, omega.x), 0, 0]")
    again = ph.solve(ph.Scene(inertia=BLOCK, omega=(0, 0, 0), torques=[text], times=times), 1e-9)
    np.testing.assert_array_equal(again.omega, held.omega)
    np.testing.assert_array_equal(friction(0.2, np.array([1.0, -1.0, 0.0])), [-0.2, 0.2, 0.2])


def test_friction_holds_a_rate_that_depends_on_time():
    """A belt that speeds up carries the body: w = t / 10 from 6/7 s on, until a torque is more than the load."""
    belt = Formula(text="[0, 0, friction(0.5, omega.z - 0.1 * t) - where(t > 5, 0.6, 0)]")
    times = np.linspace(0, 8, 17)
    motion = ph.solve(ph.Scene(inertia=(1, 2, 2), omega=(0, 0, 0.3), torques=[belt], times=times), 1e-9)
    slips = 0.3 / 0.35   # 0.3 - 0.25 t = 0.1 t
    w = np.where(times < slips, 0.3 - 0.25 * times, np.where(times < 5, 0.1 * times, 0.5 - 0.05 * (times - 5)))
    assert motion.success and motion.error_kind == "bounded"
    np.testing.assert_allclose(motion.omega[:, 2], w, rtol=0, atol=0.5 * motion.error + 1e-15)


def test_sliding_says_where_it_begins():
    law = Formula(text="-0.5 * [sign(omega.x), 0, 0]")
    start = dict(inertia=BLOCK, omega=(0.25, 0, 0), torques=[law])
    motion = ph.solve(ph.Scene(**start, times=[0.25, 0.5, 1.0]), 1e-9)
    assert motion.status == "sliding" and not motion.success
    assert "t = 0.5 s" in motion.message and "friction(load, rate)" in motion.message
    np.testing.assert_allclose(motion.omega[:, 0], [0.125, 0.0], rtol=0, atol=1e-12)
    assert motion.error_kind == "bounded"
    # backwards it never slides
    assert ph.solve(ph.Scene(**start, times=[-1.0]), 1e-9).success


def test_continuous_switches_may_start_on_their_surface():
    for text in ("-0.3 * [abs(omega.x) * omega.x, abs(omega.y) * omega.y, 0]",
                 "[clip(-omega.x, 0, 1) + 0.1 * sin(t), clip(-omega.y, 0, 1), 0]",
                 "[max(t, 0), min(-t, 0.1) + abs(sin(t)), 0]"):
        law = Formula(text=text)
        for end in (6.0, -6.0):
            motion = ph.solve(ph.Scene(inertia=BLOCK, omega=(0, 0, 0), torques=[law], times=[end]), 1e-9)
            assert motion.success and motion.error_kind == "bounded"
            fine = ph.solve(ph.Scene(inertia=BLOCK, omega=(0, 0, 0), torques=[law], times=[end]), method="rk45",
                            rtol=1e-12, atol=1e-13)
            if fine.success:
                np.testing.assert_allclose(motion.omega, fine.omega, rtol=0, atol=1e-8)
