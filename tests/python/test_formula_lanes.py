"""Formulas of many bodies at once: those of the list run in the lanes of their torques."""

import numpy as np
import pytest

import polhode as ph
from polhode.torques import AngularDamping, Constant, Damping, Formula, Gravity, GravityGradient

RNG = np.random.default_rng(23)
N = 21
HALF = RNG.uniform(0.2, 1, (N, 3))
MOMENTS = HALF.sum(axis=1, keepdims=True) - HALF
SPINS = RNG.normal(size=(N, 3))
TURNS = ph.Rotation.from_rotvec(RNG.normal(size=(N, 3))).as_quat()
TIMES = np.linspace(0, 4, 5)
KNOWN = {
    "gravity": (Formula(text="cross(m, to_body([0, 0, -1]))", m=(0.3, 0.2, 0.5)), Gravity(1, (0.3, 0.2, 0.5))),
    "damping": (Formula(text="-c * omega", c=(0.1, 0.3, 0.2)), Damping((0.1, 0.3, 0.2))),
    "space": (Formula(text="to_body(f)", f=(0.1, -0.2, 0.3)), Constant((0.1, -0.2, 0.3), "space")),
    "zero": (Formula(text="cross(omega, omega)"), Constant((0, 0, 0))),
}


def scene(*torques, inertia=(1, 2, 2.5), omega=(0.4, -0.7, 1.1), **more):
    return ph.Scene(inertia=inertia, omega=omega, torques=torques, times=TIMES, **more)


def starts(rows=slice(None)):
    return {"inertia": MOMENTS[rows], "omega": SPINS[rows], "attitude": TURNS[rows]}


def assert_same(a, b):
    np.testing.assert_array_equal(a.omega, b.omega)
    np.testing.assert_array_equal(a.attitude, b.attitude)
    np.testing.assert_array_equal(a.steps, b.steps)


@pytest.mark.parametrize("method", ["taylor", "rk45"])
@pytest.mark.parametrize("name", KNOWN)
def test_a_formula_of_the_list_runs_in_its_lanes(name, method):
    own, torque = (ph.solve_many(scene(one), rtol=1e-9, method=method, **starts()) for one in KNOWN[name])
    assert own.lanes.all() and torque.lanes.all()
    assert_same(own, torque)


def test_what_is_a_torque_for_one_tensor_alone():
    """-2 (w1, w2, 2 w3) is angular damping for the moments (1, 1, 2), and damping for others."""
    own = Formula(text="-[omega.x, omega.y, 2 * omega.z]")
    moments = np.array([[1, 1, 2], [1, 1.5, 2], [1, 1, 2], [2, 2, 4 - 1e-9]])
    bodies = [scene(own, inertia=each, omega=spin) for each, spin in zip(moments, SPINS, strict=False)]
    like = [scene(AngularDamping(1.0) if i in (0, 2) else Damping((1, 1, 2)), inertia=each, omega=SPINS[i])
            for i, each in enumerate(moments)]
    assert_same(ph.solve_many(bodies, rtol=1e-9, method="taylor"), ph.solve_many(like, rtol=1e-9, method="taylor"))
    text = "3 * n^2 * cross(u, [1, 2, 2.5] * u)"
    pull = Formula(text=text, let={"u": "to_body([cos(n * t), sin(n * t), 0])"}, n=0.4)
    both = [scene(pull, inertia=I) for I in ((1, 2, 2.5), (1, 2, 2.75), (1, 2, 2.5))]
    many = ph.solve_many(both, rtol=1e-9, method="rk45")
    assert list(many.lanes) == [True, False, True]
    assert_same(ph.solve_many(both[::2], rtol=1e-9, method="rk45"),
                ph.solve_many([scene(GravityGradient(0.4))] * 2, rtol=1e-9, method="rk45"))
