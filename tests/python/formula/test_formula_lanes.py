"""Formulas of many bodies at once: in the lanes of their torques, or in lanes of their own."""


import levels
import numpy as np
import pytest
from test_formula_series import CASES, FULL, LAWS, START, find_errors, make
from test_formula_series import scene as true_scene

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


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['law']}-{case['inertia'][0][1]}")
@pytest.mark.parametrize("rtol", [1e-4, 1e-8, 1e-12])
def test_lanes_of_every_law_against_truth(case, rtol):
    torque = make(case["law"], case["inertia"])
    bodies = [true_scene([torque], case["inertia"]).replace(omega=(1 + 0.1 * i) * np.array(START["omega"]))
              for i in range(10)]
    many = ph.solve_many(bodies, rtol=rtol, method="taylor")
    assert many.lanes.all() and set(many.status) == {"finished"}

    class First:
        omega, attitude = many.omega[0], many.attitude[0]

    assert max(find_errors(First, np.array(case["rows"], dtype=float))) <= 10 * rtol
    alone = ph.solve(bodies[7], rtol=1e-14, method="taylor")
    assert np.abs(many.omega[7] - alone.omega).max() <= 20 * rtol


def law(name, i=0):
    """The law with numbers of its own for body i."""
    function, parameters = LAWS[name]
    if name == "gradient":
        parameters = dict(parameters, inertia=tuple(np.ravel(FULL)))
    grown = {key: tuple(np.array(v) * (1 + 0.02 * i)) if isinstance(v, tuple) else v * (1 + 0.02 * i)
             for key, v in parameters.items()}
    return Formula(function, recognise=False, **grown)


@pytest.mark.parametrize("name", LAWS)
def test_bodies_have_numbers_of_their_own(name):
    """In any order and company, with any number of threads, each body has the bits it has alone."""
    bodies = [scene(law(name, i % 5), Gravity(0.1 * (i % 3), (0, 0.1, 0.3)), inertia=MOMENTS[i] if i % 2 else FULL,
                    omega=SPINS[i], attitude=TURNS[i], rotors=[ph.Rotor(axis=(0, 0, 1), momentum=0.1 * (i % 4))])
              for i in range(N)]
    many = ph.solve_many(bodies, rtol=1e-10, method="taylor")
    assert many.lanes.all() and set(many.status) == {"finished"}
    for i in (0, 7, 13):
        alone = ph.solve(bodies[i], rtol=1e-14, method="taylor")
        assert np.abs(many.omega[i] - alone.omega).max() <= 1e-8
        one = ph.solve_many(bodies[i : i + 1], rtol=1e-10, method="taylor")
        np.testing.assert_array_equal(one.attitude[0], many.attitude[i])
    order = RNG.permutation(N)
    mixed = ph.solve_many([bodies[i] for i in order], rtol=1e-10, method="taylor", threads=2)
    np.testing.assert_array_equal(mixed.omega, many.omega[order])


def test_one_scene_and_its_starts():
    own = scene(law("saturated"))
    many = ph.solve_many(own, rtol=1e-9, method="taylor", **starts())
    each = [own.replace(inertia=MOMENTS[i], omega=SPINS[i], attitude=TURNS[i]) for i in range(N)]
    assert_same(many, ph.solve_many(each, rtol=1e-9, method="taylor"))


def test_a_body_that_fails_leaves_the_others_alone():
    grows = Formula(text="3 * norm(omega) * omega", recognise=False)   # to infinity in a finite time
    good = scene(law("drag"))
    many = ph.solve_many([good, scene(grows), good.replace(omega=(1, 1, 1))], rtol=1e-9, method="taylor",
                         max_steps=500)
    assert list(many.status)[::2] == ["finished"] * 2 and many.status[1] != "finished" and many.t_reached[1] < 1
    np.testing.assert_array_equal(many.omega[0], ph.solve_many([good], rtol=1e-9, method="taylor").omega[0])


def test_states_and_switches_are_solved_alone():
    wheel = Formula(lambda t, w, q, p, s: (-0.1 * w - s.h, {"h": 0.2 * w - s.h}), states={"h": (0.1, 0.0, 0.2)})
    bodies = [scene(wheel), scene(wheel, omega=(1, 0, 0.2))]
    many = ph.solve_many(bodies, rtol=1e-9, method="taylor")
    assert not many.lanes.any()
    np.testing.assert_array_equal(many.omega[1], ph.solve(bodies[1], rtol=1e-9, method="taylor").omega)
    many = ph.solve_many([scene(Formula(text="-clip(omega, -0.5, 0.5)"))] * 2, rtol=1e-9, method="rk45")
    assert not many.lanes.any() and many.success.all()


PRINT = """
import hashlib
from test_formula_lanes import *
for name in LAWS:
    for rtol in (1e-5, 1e-12):
        many = ph.solve_many(scene(law(name)), rtol=rtol, method="taylor", **starts())
        print(hashlib.sha256(many.omega.tobytes() + many.attitude.tobytes()).hexdigest())
"""


def test_avx2_and_avx512_give_the_same_bits():
    found = levels.outputs(PRINT)
    assert len(found["avx2"].splitlines()) == 2 * len(LAWS) and found["avx2"] == found["avx512"]
