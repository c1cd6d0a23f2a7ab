"""`radau` takes the derivatives of formulas by the rates from the formulas themselves."""

import numpy as np
import pytest
from test_formula_series import CASES, find_errors, make
from test_formula_series import scene as true_scene

import polhode as ph
from polhode.torques import AngularDamping, Custom, Damping, Formula

FULL = [[2.0, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 3.0]]


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['law']}-{case['inertia'][0][1]}")
@pytest.mark.parametrize("accuracy", [1e-3, 1e-5, 1e-7])
def test_the_stated_error_holds_for_every_law(case, accuracy):
    rows = np.array(case["rows"], float)
    one = true_scene([make(case["law"], case["inertia"])], case["inertia"])
    motion = ph.solve(one, accuracy, method="radau")
    assert motion.success and motion.error <= accuracy
    assert max(find_errors(motion, rows)) <= motion.error


def solve(torque, inertia, **more):
    given = dict(inertia=inertia, omega=(0.3, 1.0, -0.2), torques=[torque, *more.pop("beside", [])], times=[2.0])
    return ph.solve(ph.Scene(**given, **more), method="radau", rtol=1e-6)


@pytest.mark.parametrize("inertia", [(1.0, 2.0, 2.5), (2.5, 1.0, 2.0), (2.0, 2.0, 2.5), FULL])
@pytest.mark.parametrize("more", [{}, {"rotors": [ph.Rotor((0, 0.6, 0.8), momentum=2e4)]},
                                  {"beside": [Damping((1e4, 2e4, 3e4))]}, {"beside": [AngularDamping(2e4)]}],
                         ids=["alone", "rotor", "damping", "angular"])
def test_newton_steps_converge_as_with_differences(inertia, more):
    """A wrong derivative of a stiff law costs steps or ends none. A callback has differences."""
    k = 1e4

    def lean(t, omega, attitude):
        return -k * (omega - 0.1 * attitude[:3]) - k * np.linalg.norm(omega) * omega

    formula = Formula(text="-k * (omega - 0.1 * attitude.xyz) - k * norm(omega) * omega", k=k)
    exact, differences = solve(formula, inertia, **more), solve(Custom(lean), inertia, **more)
    assert exact.success and differences.success
    assert abs(exact.stats["steps"] - differences.stats["steps"]) <= 2
    assert exact.stats["rejected"] <= differences.stats["rejected"] + 1
    assert exact.stats["derivatives"] < differences.stats["derivatives"] - 2 * differences.stats["steps"]
    np.testing.assert_allclose(exact.omega, differences.omega, atol=1e-6)
