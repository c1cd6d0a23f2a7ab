"""Torques: each against its formula and its potential, and the user's own in every form."""

import ctypes
import pickle

import numpy as np
import pytest
from bodies import scene

import polhode as ph
from polhode.torques import AngularDamping, Constant, Custom, Damping, Gravity, GravityGradient

SAMPLES = [Constant((1, 2, 3)), Constant((1, 2, 3), frame="space"), Gravity(2, (0.3, 0.2, 0.5)),
           GravityGradient(1e-3, phase=0.2), Damping((1, 2, 3)), Damping(np.arange(9.0).reshape(3, 3)),
           AngularDamping(0.3)]


@pytest.mark.parametrize("torque", SAMPLES, ids=repr)
def test_torques_are_values(torque):
    again = pickle.loads(pickle.dumps(torque))
    assert again == torque and hash(again) == hash(torque) and repr(again) == repr(torque)
    assert eval(repr(torque), {"polhode": ph}) == torque
    assert torque != Gravity(2.5, (0.3, 0.2, 0.5)) and torque != 3


def test_the_list_describes_every_torque():
    records = {record["name"]: record for record in ph.torques.records()}
    assert set(records) == set(ph.torques.__all__) - {"During", "Dipole", "Drag", "SolarPressure", "records"}
    for name, record in records.items():
        assert record["doc"] and (record["source"] or name in ("Custom", "Formula"))
        assert getattr(ph.torques, name).__doc__.startswith(name + "(")
        for parameter in record["parameters"]:
            assert parameter["doc"] and parameter["kind"] in ("real", "vector", "matrix", "choice", "orbit")


def acceleration(torque, omega=(0.1, 0.2, 0.3), attitude=(0, 0, 0, 1), inertia=(1, 2, 2.5), t0=0.0):
    """The torque as the motion feels it: I dw/dt + w x (I w), from two short steps."""
    attitude = np.array(attitude) / np.linalg.norm(attitude)
    h = 1e-3
    motion = ph.solve(ph.Scene(inertia=inertia, omega=omega, attitude=attitude, torques=[torque],
                               times=t0 + h * np.array([-2, -1, 1, 2]), t0=t0), rtol=1e-14)
    w = motion.omega
    rate = (w[0] - 8 * w[1] + 8 * w[2] - w[3]) / (12 * h)
    return np.array(inertia) * rate + np.cross(omega, np.array(inertia) * omega)


def matrix(q):
    x, y, z, w = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


Q = np.array([0.1, -0.7, 0.4, 0.5]) / np.linalg.norm([0.1, -0.7, 0.4, 0.5])
OMEGA = np.array([0.1, 0.2, 0.3])


@pytest.mark.parametrize(("torque", "formula"), [
    (Constant((1, 2, 3)), lambda R: np.array((1, 2, 3))),
    (Constant((1, 2, 3), "space"), lambda R: R.T @ (1, 2, 3)),
    (Gravity(2, (0.3, 0.2, 0.5)), lambda R: np.cross((0.3, 0.2, 0.5), -2 * R.T @ (0, 0, 1))),
    (GravityGradient(0.3, phase=0.7), lambda R: 0.27 * np.cross(
        R.T @ (np.cos(1.3), np.sin(1.3), 0), np.array((1, 2, 2.5)) * (R.T @ (np.cos(1.3), np.sin(1.3), 0)))),
    (Damping(np.arange(9.0).reshape(3, 3)), lambda R: -np.arange(9.0).reshape(3, 3) @ OMEGA),
    (AngularDamping(0.3), lambda R: -0.3 * np.array((1, 2, 2.5)) * OMEGA),
], ids=["body", "space", "gravity", "gradient", "damping", "angular damping"])
def test_each_torque_is_its_formula(torque, formula):
    np.testing.assert_allclose(acceleration(torque, OMEGA, Q, t0=2.0), formula(matrix(Q)), rtol=1e-9, atol=1e-10)


@pytest.mark.parametrize("torque", [Gravity(2, (0.3, 0.2, 0.5)), GravityGradient(0.3, phase=0.7)],
                         ids=["gravity", "gradient"])
def test_a_potentials_gradient_is_the_torque(torque):
    """dV = -tau_B . dtheta for a small turn dtheta in body axes."""
    def potential(turn):
        h = np.array([*np.sin(np.linalg.norm(turn) / 2) * turn / np.linalg.norm(turn),
                      np.cos(np.linalg.norm(turn) / 2)])
        x, y, z, w = Q
        a, b, c, d = h
        q = [w * a + x * d + y * c - z * b, w * b - x * c + y * d + z * a, w * c + x * b - y * a + z * d,
             w * d - x * a - y * b - z * c]
        still = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 0), attitude=q, torques=[torque], times=[2.0], t0=2.0)
        return ph.solve(still).energy[0]

    e = 1e-4
    gradient = [(potential(e * axis) - potential(-e * axis)) / (2 * e) for axis in np.eye(3)]
    np.testing.assert_allclose(acceleration(torque, OMEGA, Q, t0=2.0), -np.array(gradient), atol=1e-8)


def test_torques_add_up():
    parts = [Constant((0.1, 0, 0)), Constant((0, 0.2, 0), "space"), Gravity(2, (0.3, 0.2, 0.5)),
             Damping((0.1, 0.2, 0.3))]
    total = sum(acceleration(one, OMEGA, Q) for one in parts)
    times = np.linspace(0, 1e-3, 3)
    motion = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=OMEGA, attitude=Q, torques=parts, times=times), rtol=1e-14)
    rate = (-3 * motion.omega[0] + 4 * motion.omega[1] - motion.omega[2]) / 1e-3
    np.testing.assert_allclose(np.array((1, 2, 2.5)) * rate + np.cross(OMEGA, np.array((1, 2, 2.5)) * OMEGA), total,
                               atol=1e-5)
    summed = ph.solve(scene("S9", torques=[Constant((0.01, 0, 0)), Constant((0, -0.02, 0.03))]), rtol=1e-10)
    np.testing.assert_allclose(summed.omega, ph.solve(scene("S9"), rtol=1e-10).omega, rtol=1e-9)


# ---- the user's own


def gravity(t, omega, attitude):
    x, y, z, w = attitude
    vertical = np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])
    return np.cross((0.3, 0.2, 0.5), -2 * vertical)


def height(t, attitude):
    x, y, z, w = attitude
    return 2 * np.dot((0.3, 0.2, 0.5), [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


def test_a_python_callable_is_the_same_torque():
    mine = ph.solve(scene("S5", torques=[Custom(gravity, uses_time=False, uses_rates=False, potential=height)]),
                    rtol=1e-9)
    built_in = ph.solve(scene("S5"), rtol=1e-9)
    np.testing.assert_allclose(mine.omega, built_in.omega, atol=1e-11)
    assert mine.drift["energy"] == pytest.approx(built_in.drift["energy"], rel=1e-2)


def test_a_ctypes_pointer_is_called_without_python():
    signature = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.POINTER(ctypes.c_double)] * 3, ctypes.c_void_p)

    @signature
    def spin_up(t, omega, attitude, torque, data):
        torque[0], torque[1], torque[2] = 0.01, -0.02, 0.03

    mine = ph.solve(scene("S9", torques=[Custom(spin_up)]), rtol=1e-9)
    np.testing.assert_array_equal(mine.omega, ph.solve(scene("S9"), rtol=1e-9).omega)


def test_a_numba_cfunc():
    numba = pytest.importorskip("numba")
    from numba import carray, types

    pointer = types.CPointer(types.float64)

    @numba.cfunc(types.void(types.float64, pointer, pointer, pointer, types.voidptr))
    def damping(t, omega, attitude, torque, data):
        w, tau = carray(omega, 3), carray(torque, 3)
        tau[0], tau[1], tau[2] = -50 * w[0], -0.01 * w[1], -0.01 * w[2]

    mine = ph.solve(scene("S7", torques=[Custom(damping)]), rtol=1e-9)
    np.testing.assert_allclose(mine.omega, ph.solve(scene("S7"), rtol=1e-9).omega, atol=1e-13)


def test_what_a_callable_raises_comes_through():
    class Mine(Exception):
        pass

    def broken(t, omega, attitude):
        if t > 1:
            raise Mine("out of fuel")
        return (0, 0, 0)

    with pytest.raises(Mine, match="out of fuel"):
        ph.solve(scene("S9", torques=[Custom(broken)]))
    with pytest.raises(Mine):
        ph.solve(scene("S9"), events=[lambda t, w, q: broken(t, w, q)[0] + 1])
    assert ph.solve(scene("S9")).status == "finished"


@pytest.mark.parametrize("answer", [(1, 2), 3.0, None, "abc", (1, 2, np.nan), (1, np.inf, 0), [[1, 2, 3]], (1j, 0, 0)])
def test_wrong_answers_of_a_callable_are_named(answer):
    with pytest.raises(ph.InvalidInput, match="torque's function"):
        ph.solve(scene("S9", torques=[Custom(lambda t, omega, attitude: answer)]))


def test_a_compiled_nan_is_named():
    signature = ctypes.CFUNCTYPE(None, ctypes.c_double, *[ctypes.POINTER(ctypes.c_double)] * 3, ctypes.c_void_p)
    silent = signature(lambda *args: None)
    with pytest.raises(ph.InvalidInput, match="nan in component 0"):
        ph.solve(scene("S9", torques=[Custom(silent)]))


@pytest.mark.parametrize(("make", "match"), [
    (lambda: Gravity(2), "arm"), (lambda: Gravity(2, (1, 2)), "arm"), (lambda: Gravity(np.nan, (0, 0, 1)), "weight"),
    (lambda: Gravity(2, (0, 0, 1), 5), "called as"), (lambda: Gravity(2, arm=(0, 0, 1), lever=3), "lever"),
    (lambda: Gravity(2, (0, 0, 1), weight=2), "twice|called as"), (lambda: Constant((1, 2, 3), frame="world"), "frame"),
    (lambda: Constant((1, 2, 3), frame=3), "frame"), (lambda: Damping([[1, 2], [3, 4]]), "matrix"),
    (lambda: GravityGradient("fast"), "mean_motion"), (lambda: Custom(3), "callable"),
    (lambda: Custom(gravity, potential=3), "potential"), (lambda: Custom(gravity, data=3), "data"),
])
def test_bad_torques_are_refused(make, match):
    with pytest.raises(ph.InvalidInput, match=match):
        make()


def test_a_custom_torque_is_a_value():
    torque = Custom(gravity, uses_time=False, potential=height)
    again = pickle.loads(pickle.dumps(torque))
    assert again == torque and hash(again) == hash(torque)
    assert again.traits == {"uses_time": False, "uses_attitude": True, "uses_rates": True, "has_potential": True}
