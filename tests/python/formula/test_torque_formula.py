"""Formulas as torques: traced functions and texts, what is refused, and their motions against truth."""

import copy
import math
import pickle

import numpy as np
import pytest
from laws import pd
from scene_files import write_scene
from scipy.integrate import solve_ivp

import polhode as ph
from polhode.torques import AngularDamping, Constant, Custom, Damping, During, Formula, Gravity, GravityGradient

INERTIA, OMEGA, TIMES = (1.0, 2.0, 2.5), (0.4, -0.7, 1.1), np.linspace(0, 5, 11)
Q = np.array([0.1, -0.7, 0.4, 0.5]) / np.linalg.norm([0.1, -0.7, 0.4, 0.5])
PD = "-kp * attitude.xyz * attitude.w - kd * omega"


def drag(t, omega, attitude, p):
    return -p.c * np.linalg.norm(omega) * omega


def dipole(t, omega, attitude, p):
    field = np.stack([np.cos(p.n * t), np.sin(p.n * t), 0.3 * np.sin(2 * p.n * t)])
    return np.cross(p.m, ph.formula.to_body(attitude, field))


def spring(t, omega, attitude, p):
    reach = ph.formula.to_space(attitude, p.arm) - np.array([0.2, 0.1, 1.0])
    force = -p.k * (1 - p.length / np.sqrt(reach @ reach)) * reach
    return np.cross(p.arm, ph.formula.to_body(attitude, force))


def limited(t, omega, attitude, p):
    return np.clip(-p.kd * omega, -0.1, 0.1) + np.where(omega[0] > 0.2, 0.01, 0.02) * np.ones(3)


def mixed(t, omega, attitude, p):
    M = np.array([[1.0, 0.2, 0.0], [0.0, 2.0, 0.1], [0.3, 0.0, 1.0]])
    a = np.array([omega[0], np.tanh(omega[1]), np.exp(-omega[2] ** 2)])
    total = sum(omega[i] * math.pi for i in range(3))
    return M @ a + a @ M - np.outer(a, omega)[0] + np.dot(omega, attitude[:3]) * np.hypot(omega[0], 2.0) + \
        np.arctan2(omega, 3.0) + np.log(2 + np.square(omega)) + np.sign(total) * abs(omega) / 7


CASES = [(pd, dict(kp=0.2, kd=0.5)), (pd, dict(kp=0.2, kd=(0.5, 0.5, 0.4))), (drag, dict(c=0.3)),
         (dipole, dict(m=(0.1, 0.2, -0.1), n=0.7)), (spring, dict(arm=(0.3, 0.2, 0.5), k=1.5, length=0.4)),
         (limited, dict(kd=0.3)), (mixed, {})]
SMOOTH = [case for case in CASES if case[0] is not limited]


def scene(torque, **changes):
    given = {"inertia": INERTIA, "omega": OMEGA, "attitude": Q, "torques": [torque], "times": TIMES}
    return ph.Scene(**{**given, **changes})


def arrays(parameters):
    class Own:
        pass

    own = Own()
    for name, value in parameters.items():
        setattr(own, name, np.array(value) if isinstance(value, tuple) else value)
    return own


def integrate(function, parameters, inertia=INERTIA):
    """Rates and attitudes by SciPy's DOP853 at 1e-13, with the function itself."""
    p, I = arrays(parameters), np.array(inertia)

    def rates(t, y):
        w, q = y[:3], y[3:]
        unit = q / np.linalg.norm(q)
        turning = np.append(unit[3] * w + np.cross(unit[:3], w), -unit[:3] @ w) / 2
        return np.append((function(t, w, unit, p) - np.cross(w, I * w)) / I, turning)

    return solve_ivp(rates, TIMES[[0, -1]], np.append(OMEGA, Q), "DOP853", TIMES, rtol=1e-13, atol=1e-15).y.T


@pytest.mark.parametrize(("function", "parameters"), CASES, ids=lambda x: getattr(x, "__name__", ""))
def test_values_are_those_of_the_function(function, parameters):
    torque, rng = Formula(function, **parameters), np.random.default_rng(5)
    for _ in range(20):
        t, w, q = rng.uniform(-5, 5), rng.normal(size=3), rng.normal(size=4)
        q /= np.linalg.norm(q)
        want = function(t, w, q, arrays(parameters))
        np.testing.assert_allclose(torque.value(t, w, q), want, rtol=0, atol=4e-15 * max(1, np.abs(want).max()))


@pytest.mark.parametrize(("function", "parameters"), SMOOTH, ids=lambda x: getattr(x, "__name__", ""))
@pytest.mark.parametrize("method", [None, "rk45", "dop853", "radau"])
def test_motions_against_scipy(function, parameters, method):
    jumps = function is mixed and method is not None   # sign, which only the series' steps end at
    accuracy = 1e-10 if method in (None, "dop853") and not jumps else 1e-6
    motion = ph.solve(scene(Formula(function, **parameters)), accuracy=accuracy, method=method)
    want = integrate(function, parameters)
    assert motion.success and motion.error_kind == ("estimated" if jumps else "bounded")
    assert ("steps over the switches" in motion.message) == jumps
    size = np.abs(OMEGA).max()
    worst = max(np.abs(motion.omega - want[:, :3]).max() / size, np.abs(motion.attitude - want[:, 3:]).max())
    assert worst <= accuracy and worst <= 4 * motion.error + 1e-12


@pytest.mark.parametrize(("function", "parameters"), CASES, ids=lambda x: getattr(x, "__name__", ""))
def test_formulas_are_values(function, parameters):
    torque = Formula(function, **parameters)
    for again in (pickle.loads(pickle.dumps(torque)), copy.deepcopy(torque), eval(repr(torque), {"polhode": ph})):
        assert again == torque and hash(again) == hash(torque) and repr(again) == repr(torque)
    assert torque == Formula(function, **parameters) and torque != Formula(function, recognise=False, **parameters)
    assert torque != Formula(text="-omega") and torque != 3
    w = np.random.default_rng(2).normal(size=3)
    again = Formula(text=torque.text, let=torque.let, **torque.parameters)
    np.testing.assert_array_equal(again.value(0.3, w, Q), torque.value(0.3, w, Q))


def test_text_and_function_are_the_same_formula():
    text, function = Formula(text=PD, kp=0.2, kd=0.5), Formula(pd, kd=0.5, kp=0.2)
    assert text == function and text.parameters == {"kd": 0.5, "kp": 0.2}
    a, b = (ph.solve(scene(torque), 1e-9) for torque in (text, function))
    np.testing.assert_array_equal(a.omega, b.omega)


def test_traits_come_from_the_structure():
    assert Formula(pd, kp=1, kd=1).traits == {"uses_time": False, "uses_attitude": True, "uses_rates": True,
                                              "has_potential": False}
    assert not Formula(drag, c=1).traits["uses_attitude"] and Formula(dipole, m=(1, 0, 0), n=1).traits["uses_time"]


GRAVITY = ("weight * cross(arm, to_body([0, 0, -1]))", dict(weight=1.0, arm=(0.3, 0.2, 0.5)))


@pytest.mark.parametrize(("text", "parameters", "torque"), [
    (*GRAVITY, Gravity(1, (0.3, 0.2, 0.5))),
    ("[1, 2, 3] / 8", {}, Constant((0.125, 0.25, 0.375))),
    ("to_body(f)", dict(f=(0.1, -0.2, 0.3)), Constant((0.1, -0.2, 0.3), "space")),
    ("-c * omega", dict(c=(0.1, 0.3, 0.2)), Damping((0.1, 0.3, 0.2))),
    ("-0.25 * [omega.x, 2 * omega.y, 2.5 * omega.z]", {}, AngularDamping(0.25)),
])
@pytest.mark.parametrize("window", [None, [(1.0, 2.5)]])
def test_a_formula_that_is_a_torque_of_the_list_has_its_bits(text, parameters, torque, window):
    own = Formula(text=text, **parameters)
    pair = [one if window is None else During(one, window) for one in (own, torque)]
    found, known = (ph.solve(scene(one), accuracy=1e-9) for one in pair)
    np.testing.assert_array_equal(found.omega, known.omega)
    np.testing.assert_array_equal(found.attitude, known.attitude)
    assert found.plan.method == known.plan.method and found.error == known.error
    assert any(type(torque).__name__ + "(" in why for why in ph.plan(scene(pair[0]), 1e-9).reasons)
    other = ph.solve(scene(Formula(text=text, recognise=False, **parameters)), accuracy=1e-9)
    if window is None:
        assert other.plan.method == "taylor" and other.error_kind == "bounded"
        np.testing.assert_allclose(other.omega, known.omega, atol=2e-9)


def test_a_formula_that_is_zero_leaves_the_free_motion():
    motion = ph.solve(scene(Formula(text="cross(omega, omega) * attitude.x")), 1e-9)
    free = ph.solve(scene(Constant((0, 0, 0))), 1e-9)
    np.testing.assert_array_equal(motion.omega, free.omega)
    assert motion.plan.method == "exact"


def rand(t, omega, attitude, p):
    return np.random.default_rng().normal() * omega


SEEN = []


def hidden(t, omega, attitude, p):
    return omega * (2.0 if isinstance(t, float) else 1.0)


def branch(t, omega, attitude, p):
    if omega[0] > 0:
        return omega
    return -omega


def written(t, omega, attitude, p):
    out = np.zeros(3)
    out[0] = omega[0]
    return out


@pytest.mark.parametrize(("function", "words"), [
    (branch, r"test_torque_formula.py, line \d+: if omega\[0\] > 0:.*np.where"),
    (written, r"line \d+: out\[0\] = omega\[0\].*np.stack"),
    (lambda t, w, q, p: math.sin(t) * w, "math.sin.*np.sin"),
    (lambda t, w, q, p: float(t) * w, r"float\(\)"),
    (lambda t, w, q, p: min(w[0], w[1]) * w, "np.minimum"),
    (lambda t, w, q, p: np.linalg.inv(np.outer(w, w)) @ w, "np.linalg.inv"),
    (lambda t, w, q, p: np.interp(t, [0, 1], [0, 1]) * w, "np.interp|float"),
    (lambda t, w, q, p: w[0] ** w[1] * w, "exponent"), (lambda t, w, q, p: w == 0, "== or !="),
    (lambda t, w, q, p: np.cosh(w), "np.cosh"), (rand, "random"), (hidden, "more than its arguments"),
    (lambda t, w, q, p: w[:2], r"shape \(2,\)"), (lambda t, w, q, p: (w, {"h": w}), "states|shape"),
    (lambda t, w, q, p: p.kz * w, "p.kz; known: none"), (lambda t, w, q, p: "abc", "str"),
    (lambda t, w, q, p: None, "shape"), (lambda t, w, q, p: w * 1j, "complex|real"),
], ids=lambda x: x if isinstance(x, str) else x.__name__)
def test_what_cannot_be_traced_names_the_line(function, words):
    with pytest.raises(ph.InvalidInput, match=words) as error:
        Formula(function)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(("arguments", "words"), [
    (dict(), "got none"), (dict(function=pd, text="omega"), "got several"), (dict(text=3), "text"),
    (dict(text="k * omega"), "k"),
    (dict(text="omega.x"), "3|component"), (dict(text="omega", let=[1]), "let"),
    (dict(text="omega", states=1), "states"),
    (dict(text="omega", recognise=1), "recognise"), (dict(text="omega", k="a"), "Formula.k"),
    (dict(text="omega", k=np.nan), "Formula.k"), (dict(text="omega", k=np.eye(3)), "rows"),
    (dict(function=3), "callable"), (dict(function=len), "callable as"),
    (dict(text="omega", omega=1.0), "omega"), (dict(text="(" * 5000 + "omega" + ")" * 5000), "10000|depth"),
    (dict(text="__import__('os')"), "column"), (dict(text="omega\x00"), "column"), (dict(text="\ud800"), "UTF-8"),
    (dict(text="omega / 0"), "0|finite"), (dict(text="1e999 * omega"), "float64"), (dict(function=pd, let={}), "let"),
])
def test_refused_arguments(arguments, words):
    with pytest.raises(ph.InvalidInput, match=words):
        Formula(**arguments)


def test_formulas_in_motions_windows_rotors_and_many(tmp_path):
    torque = Formula(pd, kp=0.2, kd=(0.5, 0.5, 0.4))
    rotor = ph.Rotor(axis=(0, 0, 1), momentum=0.3)
    given = scene([During(torque, [(1, 3)])][0], rotors=[rotor])
    motion = ph.solve(given, accuracy=1e-8, dense=True)
    assert len(motion.plan.pieces) == 3 and motion.success
    own = During(Custom(lambda t, w, q: torque.value(t, w, q)), [(1, 3)])
    same = ph.solve(given.replace(torques=[own]), accuracy=1e-8)
    np.testing.assert_allclose(motion.omega, same.omega, atol=1e-8)
    event = ph.Event(lambda t, omega, attitude: omega[2] - 0.9)
    assert len(ph.solve(scene(torque), 1e-8, events=[event]).events) >= 0
    motion.save(tmp_path / "m.npz")
    assert ph.load(tmp_path / "m.npz").scene == given
    many = ph.solve_many(scene(torque), omega=np.array([OMEGA, OMEGA]), accuracy=1e-8)
    np.testing.assert_array_equal(many.omega[0], ph.solve(scene(torque), accuracy=1e-8).omega)


def test_a_scene_file_holds_a_formula(tmp_path):
    file = write_scene(tmp_path / "pd.toml", omega=(0.4, -0.7, 1.1), tables="""
[[torques]]
kind = "formula"
torque = "turn - kd * omega"
let = { turn = "-kp * attitude.xyz * attitude.w" }
parameters = { kp = 0.2, kd = [0.5, 0.5, 0.4] }
""")
    assert ph.Scene.load(file).torques[0] == Formula(pd, kp=0.2, kd=(0.5, 0.5, 0.4))
    file.write_text(file.read_text().replace("kd = [", "kz = ["))
    with pytest.raises(ph.InvalidInput, match="got 'kd'"):
        ph.Scene.load(file)


def test_value_of_every_torque():
    for torque in (Constant((1, 2, 3)), Gravity(2, (0.3, 0.2, 0.5)), Damping((1, 2, 3))):
        inside = During(torque, [(0, 1)])
        np.testing.assert_array_equal(inside.value(0.5, OMEGA, Q), torque.value(0.5, OMEGA, Q))
        np.testing.assert_array_equal(inside.value(1.5, OMEGA, Q), 0)
    np.testing.assert_allclose(Damping((1, 2, 3)).value(0, OMEGA, Q), np.array([-1, -2, -3]) * OMEGA)
    np.testing.assert_allclose(AngularDamping(2).value(0, OMEGA, Q, INERTIA), -2 * np.array(INERTIA) * OMEGA)
    for torque in (AngularDamping(2), GravityGradient(1e-3)):
        with pytest.raises(ph.InvalidInput, match="inertia: must be given"):
            torque.value(0, OMEGA, Q)
    both = scene(Damping((1, 2, 3)), torques=[Damping((1, 2, 3)), AngularDamping(2), Custom(lambda t, w, q: 2 * w)])
    want = (np.array([-1, -2, -3]) - 2 * np.array(INERTIA) + 2) * OMEGA
    np.testing.assert_allclose(both.torque(0.0, OMEGA, Q), want, rtol=1e-15)


def test_helpers_take_numbers():
    R = ph.Rotation.from_quat(Q).as_matrix()
    v = np.array([1.0, -2.0, 0.5])
    np.testing.assert_allclose(ph.formula.to_body(Q, v), R.T @ v, rtol=1e-14)
    np.testing.assert_allclose(ph.formula.to_space(Q, v), R @ v, rtol=1e-14)
    assert ph.formula.norm((3, 4)) == 5 and ph.formula.norm((0, 0), smooth=2) == 2
    assert ph.formula.where(True, 1, 2) == 1 and ph.formula.clip(5, 0, 2) == 2


@pytest.mark.parametrize("gap", [0, 1e-16, 1e-12, 1e-6, 1e-3])
def test_terms_that_cancel_are_compared_with_their_rounding(gap):
    """w x (J w) of a body next to a sphere: what remains is rounding, which the function and its formula share not."""
    rng = np.random.default_rng(4)
    for k in range(60):
        axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
        J = axes @ np.diag(1 + gap * rng.normal(size=3)) @ axes.T
        J = np.diag(np.diag(J)) if k % 2 else (J + J.T) / 2
        Formula(lambda t, w, q, p, J=J: 2 * np.cross(w, J @ w))
