"""Derivatives of motions under formulas: against central differences of 26 digits, and against torques of the list."""

import json
from pathlib import Path

import levels
import numpy as np
import pytest
from laws import mixture, pd, spring

import polhode as ph
from polhode.formula import to_body
from polhode.torques import AngularDamping, Constant, Custom, Damping, During, Formula, Gravity

TRUTH = json.loads((Path(__file__).parents[2] / "reference" / "formula_columns.json").read_text())
START, TIMES = TRUTH["start"], np.array(TRUTH["times"])
Q = np.array(START["attitude"]) / np.linalg.norm(START["attitude"])


def gradient(t, omega, attitude, p):
    u = to_body(attitude, (np.cos(p.n * t + 0.3), np.sin(p.n * t + 0.3), 0))
    return 3 * p.n**2 * np.cross(u, u * np.array((1.0, 1.5, 2.25)))


def integral(t, omega, attitude, p, s):
    return -p.kp * attitude[:3] * attitude[3] - 0.9 * omega - p.ki * s.s, {"s": attitude[:3] * attitude[3]}


LAWS = {
    "pd": (pd, {"kp": 0.7, "kd": (0.5, 0.5, 0.4)}),
    "spring": (spring, {"k": 0.6, "c": 0.05}),
    "mixture": (mixture, {"a": 1.5, "b": 0.1}),
    "gradient": (gradient, {"n": 0.4}),
    "integral": (integral, {"kp": 0.7, "ki": 0.1}),
}


def make(law, **more):
    function, parameters = LAWS[law]
    states = {"s": (0, 0, 0)} if law == "integral" else None
    return Formula(function, states=states, **parameters, **more)


def scene(torques, inertia=(1, 2, 2.5), **more):
    return ph.Scene(**dict(dict(inertia=np.array(inertia), omega=START["omega"], attitude=Q, torques=torques,
                                times=TIMES), **more))


def sizes(rows, scale):
    """The larger of abs(d omega) / scale and the angle, (times, columns)."""
    return np.maximum(np.linalg.norm(rows[..., :3], axis=-1) / scale, np.linalg.norm(rows[..., 3:], axis=-1))


def stacked(s):
    return np.moveaxis(np.concatenate([s.d_omega, s.d_attitude], axis=1), 1, 2)   # (times, columns, 6)


@pytest.mark.parametrize("case", TRUTH["cases"], ids=lambda case: f"{case['law']}-{case['inertia'][0][1]}")
@pytest.mark.parametrize("accuracy", [1e-3, 1e-6, 1e-9, 1e-12])
def test_columns_have_the_error_that_they_state(case, accuracy):
    law = case["law"]
    own = tuple(f"formula.{name}" for name in LAWS[law][1])
    groups = ("omega", "attitude", "inertia", *own, *(("states.s",) if law == "integral" else ()), "axes")
    s = ph.solve(scene([make(law)], case["inertia"]), accuracy, sensitivity=groups).sensitivity
    assert [name.removeprefix("torques.0.") for name in s.columns] == list(case["columns"])
    truth = np.moveaxis(np.array(list(case["columns"].values()), dtype=float), 0, 1)
    scale = max(np.linalg.norm(START["omega"]), np.linalg.norm(s.omega, axis=1).max())
    body = truth[..., :6]
    found = (sizes(stacked(s) - body, scale) / sizes(body, scale)).max(axis=0)
    assert (found <= s.error).all(), found / s.error
    assert (s.error <= 1.01 * accuracy + 1e-13).all()
    for k, found in enumerate(np.moveaxis(s.d_states["s"], 1, 0) if law == "integral" else ()):
        apart, size = np.abs(found - truth[..., 6 + k]).max(axis=0), np.abs(truth[..., 6 + k]).max(axis=0)
        assert (apart <= s.error * size).all()


KNOWN = {
    "gravity": (Gravity(2.0, (0.3, 0.2, 0.5)), "cross(weight * arm, to_body([0, 0, -1]))",
                dict(weight=2.0, arm=(0.3, 0.2, 0.5)), ("weight", "arm")),
    "space": (Constant((0.1, -0.2, 0.3), "space"), "to_body(torque)", dict(torque=(0.1, -0.2, 0.3)), ("torque",)),
    "body": (Constant((0.1, -0.2, 0.3)), "torque", dict(torque=(0.1, -0.2, 0.3)), ("torque",)),
    "angular": (Damping(0.2 * np.diag((1, 2, 2.5))), "-rate * [1, 2, 2.5] * omega", dict(rate=0.2), ()),
}


@pytest.mark.parametrize("recognise", [True, False])
@pytest.mark.parametrize("name", KNOWN)
@pytest.mark.parametrize("windows", [None, [(-0.5, 1.25), (2, 9)]])
def test_a_formula_has_the_columns_of_the_torque_that_it_is(recognise, name, windows):
    torque, text, parameters, own = KNOWN[name]
    formula = Formula(text=text, recognise=recognise, **parameters)
    if windows:
        torque, formula = During(torque, windows), During(formula, windows)
    groups = ["omega", "attitude", "inertia", "axes", *(f"torques.0.{field}" for field in own)]
    groups += ["torques.0.windows"] if windows else []
    rotors = [ph.Rotor((0, 0, 1), momentum=0.3, during=[(0, 2.5)]),
              ph.Rotor((1, 0, 0), inertia=0.2, speed=3, free=True)]
    for more in (dict(), dict(rotors=rotors)):
        a, b = (ph.solve(scene([one], **more), 1e-10, sensitivity=groups).sensitivity for one in (torque, formula))
        assert a.columns == b.columns
        np.testing.assert_allclose(b.d_omega, a.d_omega, atol=1e-9 * np.abs(a.d_omega).max())
        np.testing.assert_allclose(b.d_attitude, a.d_attitude, atol=1e-9 * np.abs(a.d_attitude).max())


def test_the_inertia_does_not_change_the_numbers_of_a_formula():
    text = "-rate * [1, 2, 2.5] * omega"   # AngularDamping while the moments are 1, 2, 2.5
    own = scene([Formula(text=text, rate=0.2)])
    assert "AngularDamping" in " ".join(ph.plan(own).reasons)
    d = ph.solve(own, 1e-9, sensitivity="inertia").sensitivity.d_omega
    fixed = ph.solve(scene([Damping(0.2 * np.diag((1, 2, 2.5)))]), 1e-9, sensitivity="inertia").sensitivity.d_omega
    grown = ph.solve(scene([AngularDamping(0.2)]), 1e-9, sensitivity="inertia").sensitivity.d_omega
    np.testing.assert_allclose(d, fixed, atol=1e-8)
    assert np.abs(d - grown).max() > 1e-3


def test_potentials_sums_and_switches():
    both = [Formula(potential="weight * to_space(arm).z", weight=2.0, arm=(0.3, 0.2, 0.5)), make("pd")]
    same = [Gravity(2.0, (0.3, 0.2, 0.5)), make("pd", recognise=False)]
    groups = ("omega", "torques.0.weight", "torques.0.arm", "torques.1.kp", "torques.1.kd")
    a, b = (ph.solve(scene(torques), 1e-10, sensitivity=groups).sensitivity for torques in (both, same))
    np.testing.assert_allclose(a.d_omega, b.d_omega, atol=1e-9)
    assert a.columns == b.columns and a.columns[-4:] == ("torques.1.kp", *(f"torques.1.kd_{c}" for c in "xyz"))


def test_every_instruction_set_has_right_columns():
    code = ("import sys, polhode as ph, numpy as np, test_formula_columns as t\n"
            "s = ph.solve(t.scene([t.make('spring')], [[1.2, .2, -.1], [.2, 2, .3], [-.1, .3, 1.7]]), 1e-10, "
            "sensitivity=('omega', 'inertia', 'formula.k')).sensitivity\n"
            "sys.stdout.buffer.write(np.concatenate([s.d_omega, s.d_attitude]).tobytes())")
    found = {level: np.frombuffer(text) for level, text in levels.outputs(code, levels.LEVELS).items()}
    np.testing.assert_allclose(found["avx2"], found["baseline"], rtol=1e-9, atol=1e-10)
    np.testing.assert_array_equal(found["avx2"], found["avx512"])


def test_parameters_of_a_formula_are_fitted():
    t = np.linspace(0.1, 20, 120)
    rng = np.random.default_rng(11)
    truth = scene([make("pd")], times=t, omega=(0.3, 1.0, -0.2))
    motion = ph.solve(truth, 1e-10)
    data = [ph.measured.Rates(t, motion.omega + 1e-3 * rng.normal(size=(120, 3)), 1e-3),
            ph.measured.Attitudes(t, motion.attitude, 1e-3)]
    wrong = truth.replace(torques=[Formula(pd, kp=0.5, kd=(0.4, 0.6, 0.5))])
    result = ph.fit(data, wrong, fit=("omega", "torques.0.kp", "formula.kd"), seed=1)
    assert result.success
    found = result.scene.torques[0].parameters
    error = result.stderr[result.problem.slices["torques.0.kp"]][0]
    assert abs(found["kp"] - 0.7) < 5 * error < 0.02
    assert np.abs(np.subtract(found["kd"], (0.5, 0.5, 0.4))).max() < 0.02
    assert isinstance(result.scene.torques[0], Formula) and result.scene.torques[0].text == make("pd").text


def test_numbers_are_replaced_by_name():
    law = make("pd")
    other = law.with_parameters(kd=(1, 2, 3))
    assert other.parameters == {"kd": (1.0, 2.0, 3.0), "kp": 0.7} and other.text == law.text and law != other
    assert law.with_parameters() == law and other.with_parameters(kd=(0.5, 0.5, 0.4)) == law
    for wrong, words in ((dict(kz=1), "kz"), (dict(kd=1), "3 numbers"), (dict(kp=(1, 2)), "1 number"),
                         (dict(kp=np.nan), "kp"), (dict(kp="a"), "kp")):
        with pytest.raises(ph.InvalidInput, match=words):
            law.with_parameters(**wrong)


def test_lyapunov_exponents_of_formulas():
    gravity, text = Gravity(1.0, (0.1, 0.2, 0.5)), "cross(m, to_body([0, 0, -1]))"
    own = Formula(text=text, recognise=False, m=(0.1, 0.2, 0.5))
    a, b = (ph.lyapunov(scene([torque], times=[60.0])) for torque in (gravity, own))
    assert abs(a.exponent - b.exponent) < 1e-6 * max(1, abs(a.exponent))


def test_what_has_no_columns_is_refused_in_words():
    with pytest.raises(ph.InvalidInput, match="kp.*kd|kd.*kp"):
        ph.solve(scene([make("pd")]), 1e-6, sensitivity="torques.0.ki")
    with pytest.raises(ph.InvalidInput, match="formula"):
        ph.solve(scene([make("pd"), Custom(lambda t, w, q: (0, 0, 0))]), 1e-6, sensitivity="omega")
    with pytest.raises(ph.InvalidInput, match="of Formula, which has kd, kp"):
        ph.fit(ph.measured.Rates(TIMES, np.ones((2, 3)), 1), scene([make("pd")]), fit=("torques.0.ki",))


def test_states_across_a_rotor_that_stops():
    """A column at a window's end against differences of whole motions."""
    def solved(start=0.02, kp=0.7, end=1.25, sensitivity=None):
        law = Formula(integral, states={"s": (start, 0, 0)}, kp=kp, ki=0.1)
        rotor = ph.Rotor((0, 0.6, 0.8), momentum=0.3, during=[(-1, end)])
        return ph.solve(scene([law], times=[0.5, 3.0], rotors=[rotor]), 1e-12, sensitivity=sensitivity)

    s = solved(sensitivity=("states.s", "torques.0.kp", "rotors.0.during")).sensitivity
    assert s.columns[:4] == ("states.s_x", "states.s_y", "states.s_z", "torques.0.kp")
    assert s.d_states["s"].shape == (2, 3, len(s.columns)) and s.error.max() < 1e-9
    for name, which in (("start", "states.s_x"), ("kp", "torques.0.kp"), ("end", "rotors.0.during_0_end")):
        value = {"start": 0.02, "kp": 0.7, "end": 1.25}[name]
        up, down = (solved(**{name: value + by}) for by in (1e-5, -1e-5))
        k = s.columns.index(which)
        np.testing.assert_allclose(s.d_omega[..., k], (up.omega - down.omega) / 2e-5, atol=2e-7)
        np.testing.assert_allclose(s.d_states["s"][..., k], (up.states["s"] - down.states["s"]) / 2e-5, atol=2e-7)


def test_the_start_of_a_state_is_fitted():
    t = np.linspace(0.1, 20, 100)
    law = Formula(integral, states={"s": (0.5, -0.3, 0.2)}, kp=0.7, ki=0.4)
    truth = scene([law], times=t)
    data = ph.measured.Rates(t, ph.solve(truth, 1e-10).omega, 1e-4)
    guess = truth.replace(torques=[law.with_starts(s=(0, 0, 0))])
    found = ph.fit(data, guess, fit=("omega", "states.s", "torques.0.ki"), seed=1)
    assert found.success
    np.testing.assert_allclose(found.scene.states["s"], (0.5, -0.3, 0.2), atol=1e-3)
    np.testing.assert_allclose(found.numbers["states.s"], found.scene.states["s"])
    with pytest.raises(ph.InvalidInput, match="state.* s"):
        ph.fit(data, guess, fit=("states.h",))


def clipped(t, omega, attitude, p):
    return np.clip(-p.kp * attitude[:3] * attitude[3] - p.kd * omega, -p.limit, p.limit)


def dead_zone(t, omega, attitude, p):
    return np.where(np.abs(omega) > p.band, -p.k * omega, 0.1 * np.sin(t))


def bang(t, omega, attitude, p):
    return -p.k * np.sign(omega[0] + 0.3 * attitude[0] - p.shift) * np.array((1, 0.2, 0))


def wheels(t, omega, attitude, p, s):
    push = clipped(t, omega, attitude, p)
    return push - np.cross(omega, s.h), {"h": -push}


SWITCHED = {
    "clipped": (clipped, {"kp": 0.7, "kd": 0.5, "limit": 0.2}), "dead zone": (dead_zone, {"band": 0.37, "k": 0.3}),
    "bang": (bang, {"k": 0.1, "shift": 0.05}), "wheels": (wheels, {"kp": 0.7, "kd": 0.5, "limit": 0.2}),
    "two": (bang, {"k": 0.1, "shift": 0.05}),
}


@pytest.mark.parametrize("law", SWITCHED)
@pytest.mark.parametrize("inertia", [(1, 2, 2.5), [[1.2, 0.2, -0.1], [0.2, 2.0, 0.3], [-0.1, 0.3, 1.7]]])
@pytest.mark.parametrize("times", [(0.7, 2.0, 4.0), (-0.5, -1.5)])
def test_columns_across_switches_are_differences_of_motions(law, inertia, times):
    function, parameters = SWITCHED[law]

    def solved(sensitivity=None, rate=0.4, start=0.1, **changed):
        own = Formula(function, states={"h": (start, 0, 0)} if law == "wheels" else None, **{**parameters, **changed})
        more = [Formula(dead_zone, band=0.2, k=-0.1)] if law == "two" else []
        given = scene([*more, own], inertia, times=times, omega=(rate, 1.0, -0.7))
        return ph.solve(given, 1e-12, sensitivity=sensitivity)

    last = 1 if law == "two" else 0
    columns = {"rate": "omega_x", **{name: f"torques.{last}.{name}" for name in parameters}}
    if law == "wheels":
        columns["start"] = "states.h_x"
    groups = ("omega", *(f"torques.{last}.{name}" for name in parameters), *(["states.h"] if law == "wheels" else []))
    motion = solved(groups)
    s = motion.sensitivity
    assert motion.success and s.error.max() < 1e-9
    middle = {"rate": 0.4, "start": 0.1, **parameters}
    for name, column in columns.items():
        up, down = (solved(**{name: middle[name] + by}) for by in (1e-5, -1e-5))
        k = s.columns.index(column)
        np.testing.assert_allclose(s.d_omega[..., k], (up.omega - down.omega) / 2e-5, atol=3e-7)
        for state, found in s.d_states.items():
            np.testing.assert_allclose(found[..., k], (up.states[state] - down.states[state]) / 2e-5, atol=3e-7)


RUBBED = {"load": 0.35, "a": 0.6, "v": 0.1, "h": 0.2}


def rubbed(omega=START["omega"], **numbers):
    """Friction about two axes, one of them on a moving belt, and a state: each holds and lets go, also both at once."""
    def law(t, omega, attitude, p, s):
        u = to_body(attitude, (0, 0, 1))
        rest = ph.formula.friction(0.3, omega[0]) + 0.4 * np.sin(0.9 * t)
        belt = ph.formula.friction(p.load, omega[2] - p.v) + p.a * np.sin(1.3 * t) + 0.05 * u[0]
        return np.stack([rest, 0.1 * np.cos(t), belt]) - 0.02 * omega * (1 + s.h), {"h": p.a * u[1] - 0.2 * s.h}

    numbers = {**RUBBED, **numbers}
    formula = Formula(law, states={"h": numbers.pop("h")}, **numbers)
    return ph.Scene(inertia=[[1, 0.1, 0.05], [0.1, 2, -0.1], [0.05, -0.1, 2.5]], omega=omega, attitude=Q,
                    torques=[formula], times=np.linspace(0, 9, 10))


def differences(make, by=1e-5):
    up, down = (ph.solve(make(sign * by), 1e-12) for sign in (1, -1))
    return [(a - b) / (2 * by) for a, b in ((up.omega, down.omega), (up.states["h"], down.states["h"]))]


def test_friction_that_holds_and_lets_go_has_columns():
    start = np.array((0.4, 0.3, 0.2))
    motion = ph.solve(rubbed(start), 1e-9, sensitivity=("omega", *(f"torques.0.{name}" for name in ("load", "a", "v")),
                                                         "states.h"))
    s = motion.sensitivity
    held = np.abs(motion.omega[:, 0]) < 1e-15
    assert held.any() and not held.all() and motion.error_kind == "bounded"
    np.testing.assert_array_less(np.abs(s.d_omega[held, 0]), 1e-12)   # what holds has no derivative
    for k, name in enumerate(("x", "y", "z", "load", "a", "v", "h")):
        if k < 3:
            omega, h = differences(lambda by: rubbed(start + by * np.eye(3)[k]))
        else:
            omega, h = differences(lambda by: rubbed(start, **{name: RUBBED[name] + by}))
        np.testing.assert_allclose(s.d_omega[..., k], omega, rtol=0, atol=3e-9, err_msg=name)
        np.testing.assert_allclose(s.d_states["h"][..., k], h, rtol=0, atol=6e-9, err_msg=name)


def test_friction_that_holds_from_the_start():
    """About one axis at rest: it lets go at 0.1 t = load. Then w = (t - 10 load)^2 / 20, and dw/dload = 10 load - t."""
    def law(t, omega, attitude, p):
        return np.stack([0.1 * t + ph.formula.friction(p.load, omega[0]), 0.0, 0.0])

    at_rest = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 0), torques=[Formula(law, load=0.2)], times=[1.0, 4.0])
    s = ph.solve(at_rest, 1e-9, sensitivity=("omega", "torques.0.load")).sensitivity
    np.testing.assert_allclose(s.d_omega[:, 0], [[0, 0, 0, 0], [0, 0, 0, -2]], rtol=0, atol=1e-9)


def test_what_switches_leave_without_columns_is_said():
    def rub(t, omega, attitude, p):
        return ph.formula.friction(0.1, p.k * omega[2] - 0.1) * np.array((0, 0, 1)) - 0.01 * omega

    with pytest.raises(ph.InvalidInput, match="friction"):
        ph.solve(scene([Formula(rub, k=1.0)]), 1e-6, sensitivity="torques.0.k")
    windows = During(Constant((0.1, 0, 0)), [(0.1, 0.2)])
    with pytest.raises(ph.InvalidInput, match="friction"):
        ph.solve(scene([Formula(rub, k=1.0), windows]), 1e-6, sensitivity="torques.1.windows")
