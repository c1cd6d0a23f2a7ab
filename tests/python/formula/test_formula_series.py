"""Motions under formulas by Taylor series: against 26 digits from laws written by hand on mpmath numbers."""

import json
from pathlib import Path

import numpy as np
import pytest
from laws import dipole, drag, mixture, pd, spring
from measures import attitude_error, rates_error

import polhode as ph
from polhode.formula import to_body
from polhode.torques import Formula, Gravity

TRUTH = json.loads((Path(__file__).parents[2] / "reference" / "formula_motion.json").read_text())
START, TIMES = TRUTH["start"], np.array(TRUTH["times"])
Q = np.array(START["attitude"]) / np.linalg.norm(START["attitude"])
BLOCK, FULL = (np.array(TRUTH["cases"][i]["inertia"]) for i in (0, 1))


def heavy(t, omega, attitude, p):
    return -np.cross(p.moment, to_body(attitude, (0, 0, 1)))


def gradient(t, omega, attitude, p):
    angle = p.n * t + p.phase
    u = to_body(attitude, (np.cos(angle), np.sin(angle), 0))
    return 3 * p.n**2 * np.cross(u, [u @ np.array(p.inertia[3 * i : 3 * i + 3]) for i in range(3)])


def saturated(t, omega, attitude, p):
    return p.limit * np.tanh((-p.kp * attitude[:3] * attitude[3] - p.kd * omega) / p.limit)


LAWS = {
    "heavy": (heavy, dict(moment=(0.3, -0.2, 0.7))),
    "gradient": (gradient, dict(n=0.4, phase=0.3)),
    "pd": (pd, dict(kp=0.7, kd=(0.5, 0.5, 0.4))),
    "saturated": (saturated, dict(kp=0.7, kd=0.5, limit=0.3)),
    "drag": (drag, dict(c=0.08)),
    "spring": (spring, dict(k=0.6, c=0.05)),
    "dipole": (dipole, dict(moment=(0.2, 0.1, -0.3), n=0.9)),
    "mixture": (mixture, dict(a=1.5, b=0.1)),
}


def make(law, inertia):
    function, parameters = LAWS[law]
    if law == "gradient":
        parameters = dict(parameters, inertia=tuple(np.ravel(inertia)))
    return Formula(function, recognise=False, **parameters)


def scene(torques, inertia=BLOCK, **more):
    return ph.Scene(**dict(inertia=np.array(inertia), omega=START["omega"], attitude=Q, torques=torques,
                           times=TIMES), **more)


def find_errors(motion, rows):
    """Of the rates relative to the largest one, and of the attitude as an angle."""
    return rates_error(motion.omega, rows[:, :3], START["omega"]), attitude_error(motion.attitude, rows[:, 3:])


CASES = [case for case in TRUTH["cases"] if case["law"] in LAWS]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['law']}-{case['inertia'][0][1]}")
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_bound_holds_of_every_law(case, accuracy):
    rows = np.array(case["rows"], dtype=float)
    motion = ph.solve(scene([make(case["law"], case["inertia"])], case["inertia"]), accuracy, method="taylor")
    assert motion.success and motion.error_kind == "bounded" and motion.error <= accuracy
    errors = find_errors(motion, rows)
    assert max(errors) <= motion.error
    plain = ph.solve(scene([make(case["law"], case["inertia"])], case["inertia"]), accuracy, method="taylor",
                     certify=False)
    assert max(find_errors(plain, rows)) <= 10 * accuracy


def test_the_plan_takes_series():
    for law in LAWS:
        assert ph.plan(scene([make(law, BLOCK)]), 1e-9).method == "taylor", law


def test_a_torque_of_the_list_beside_a_formula_and_rotors():
    both = [Gravity(0.5, (0.3, 0.2, 0.5)), make("pd", BLOCK)]
    rotors = [ph.Rotor(axis=(0, 0.6, 0.8), momentum=0.4)]
    for inertia in (BLOCK, FULL):
        fine = ph.solve(scene(both, inertia, rotors=rotors), method="dop853", rtol=1e-13)
        for accuracy in (1e-4, 1e-8, 1e-11):
            motion = ph.solve(scene(both, inertia, rotors=rotors), accuracy)
            assert motion.plan.method == "taylor" and motion.error_kind == "bounded"
            assert max(find_errors(motion, np.hstack([fine.omega, fine.attitude]))) <= motion.error + 1e-12


@pytest.mark.parametrize("edge", [np.nextafter(0.75, 0), 0.75, np.nextafter(0.75, 1)])
def test_windows_of_formulas_next_to_a_sample(edge):
    window = ph.torques.During(make("pd", BLOCK), [(-1.0, edge)])
    fine = ph.solve(scene([window, Gravity(0.5, (0.3, 0.2, 0.5))]), method="dop853", rtol=1e-13)
    motion = ph.solve(scene([window, Gravity(0.5, (0.3, 0.2, 0.5))]), 1e-9)
    assert motion.error_kind == "bounded"
    assert max(find_errors(motion, np.hstack([fine.omega, fine.attitude]))) <= motion.error + 1e-12


def test_dense_output_events_and_halves_of_the_outputs():
    torques = [make("dipole", BLOCK)]
    whole = ph.solve(scene(torques), 1e-9, dense=True)
    omega, attitude = whole(TIMES)
    np.testing.assert_allclose(omega, whole.omega, rtol=0, atol=1e-14)
    np.testing.assert_allclose(attitude, whole.attitude, rtol=0, atol=1e-14)
    for want in ("omega", "attitude"):
        half = ph.solve(scene(torques, want=(want,)), 1e-9)
        np.testing.assert_array_equal(getattr(half, want), getattr(whole, want))
        assert half.error <= 1e-9


def test_a_singular_start_is_refused():
    with pytest.raises(ValueError, match="finite"):
        ph.solve(ph.Scene(inertia=BLOCK, omega=(0, 0, 0), torques=[Formula(text="omega / norm(omega)")], times=[1.0]))
