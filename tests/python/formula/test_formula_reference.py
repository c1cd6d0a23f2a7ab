"""The reference in long double takes any smooth law: against steps without series, and torques of the list."""

import numpy as np
import pytest

import polhode as ph
from polhode import _core
from polhode.torques import AngularDamping, Formula, Gravity, GravityGradient

INERTIA = np.array([[1.2, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 1.7]])
TIMES = np.linspace(-0.1, 2.9, 7)


def scene(*torques):
    return ph.Scene(inertia=INERTIA, omega=(0.4, -0.3, 2.0), torques=torques, times=TIMES)


def reference(problem, order=28):
    return _core.reference(problem, order, 1e-22, 100_000)


OPERATIONS = {
    "products": lambda t, w, q, p: -p.a * w * (w @ w),
    "root": lambda t, w, q, p: -p.a * ph.formula.norm(w) * w,
    "quotient": lambda t, w, q, p: w / (2 + q[0] * p.a),
    "power": lambda t, w, q, p: -p.a * w * (w @ w + 1) ** 0.3,
    "exponential": lambda t, w, q, p: -p.a * w * np.exp(-w[0] * q[1]),
    "logarithm": lambda t, w, q, p: -p.a * w * np.log(2 + w[2]**2),
    "waves": lambda t, w, q, p: p.a * np.array([np.sin(3 * t + q[0]), np.cos(q[1]), np.sin(2 * t)]),
    "tanh": lambda t, w, q, p: -p.a * np.tanh(w),
    "angle": lambda t, w, q, p: p.a * np.array([np.arctan2(w[0], 3 + q[2]), 0.0, t]),
    "seen": lambda t, w, q, p: ph.formula.to_body(q, np.array([p.a, 0.0, np.cos(t)])),
}


@pytest.mark.parametrize("operation", OPERATIONS)
def test_each_operation_is_that_of_steps_without_series(operation):
    problem = scene(Formula(OPERATIONS[operation], a=0.3, recognise=False))
    found, other = reference(problem), reference(problem, 20)
    np.testing.assert_allclose(found.omega, other.omega, rtol=0, atol=2e-15)
    steps = ph.solve(problem, method="dop853", rtol=1e-13)
    np.testing.assert_allclose(found.omega, steps.omega, rtol=0, atol=2e-11)


def test_a_law_and_the_same_formula_are_one_motion():
    n, c = 0.5, 0.1

    def gradient(t, w, q, p):
        u = ph.formula.to_body(q, np.array([np.cos(n * t), np.sin(n * t), 0.0]))
        return 3 * n * n * np.cross(u, INERTIA @ u)

    pairs = [(GravityGradient(n), Formula(gradient, recognise=False)),
             (AngularDamping(c), Formula(lambda t, w, q, p: -c * (INERTIA @ w), recognise=False)),
             (Gravity(2, (0.3, 0.2, 0.5)), Formula(lambda t, w, q, p: -np.cross(
                 (0.6, 0.4, 1.0), ph.formula.to_body(q, np.array([0, 0, 1.0]))), recognise=False))]
    for law, formula in pairs:
        np.testing.assert_allclose(reference(scene(law)).omega, reference(scene(formula)).omega, rtol=0, atol=1e-15)


def test_what_has_no_such_series_is_refused():
    with pytest.raises(ph.InvalidInput, match="without switches"):
        reference(scene(Formula(lambda t, w, q, p: -np.abs(w), recognise=False)))
