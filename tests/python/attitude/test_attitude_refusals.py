"""What is no attitude is refused: as InvalidInput (a ValueError) that names the argument and what was found."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation as SciPy

import polhode as ph

R = ph.Rotation
one = R.identity()
nan, inf = math.nan, math.inf


def refused(call, match):
    with pytest.raises(ph.InvalidInput, match=match) as caught:
        call()
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize(
    "bad", ["", "ZXZX", "ZZX", "XYY", "zXz", "ABC", "12", "Q", "XX", "xY", 5, None, ["z", "x"], b"ZXZ"]
)
def test_unknown_sequences(bad):
    refused(lambda: R.from_euler(bad, [0.1, 0.2, 0.3]), "sequence: must be")
    for call in (one.as_euler, one.gimbal_lock):
        refused(lambda call=call: call(bad), "sequence: must be three axes")
    for call in (ph.body_rates, ph.euler_rates):
        refused(lambda call=call: call(bad, [0.1, 0.2, 0.3], [1, 2, 3]), "sequence: must be three axes")


@pytest.mark.parametrize("short", ["z", "xy"])
def test_angles_are_read_from_three_axes(short):
    refused(lambda: one.as_euler(short), "three axes")


WIDTHS = {
    "quat": (R.from_quat, (4,)),
    "matrix": (R.from_matrix, (3, 3)),
    "rotvec": (R.from_rotvec, (3,)),
    "angles": (lambda a: R.from_euler("ZXZ", a), (3,)),
    "vectors": (one.apply, (3,)),
    "angle_rates": (lambda a: ph.body_rates("ZYX", [0, 0, 0], a), (3,)),
    "omega": (lambda a: ph.euler_rates("ZYX", [0, 0, 0], a), (3,)),
}


@pytest.mark.parametrize("name", WIDTHS)
def test_wrong_shapes_and_kinds(name):
    call, tail = WIDTHS[name]
    for shape in ((), (2,), (5,), (3, 2), (*tail[:-1], tail[-1] + 1), (7, *tail[:-1], tail[-1] - 1)):
        refused(lambda shape=shape: call(np.zeros(shape)), f"{name}: must be an array of shape")
    good = np.eye(3) if name == "matrix" else np.eye(4)[3][-tail[0] :]
    for bad in (None, "text", object(), good.astype(complex), good.astype(str), [[1, 2], [3]], {"a": 1}, lambda: 1):
        refused(lambda bad=bad: call(bad), f"{name}: must be an array of real numbers")


@pytest.mark.parametrize("name", WIDTHS)
@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_nan_and_inf(name, value):
    call, tail = WIDTHS[name]
    good = np.eye(3) if name == "matrix" else np.array([0.0, 0.0, 0.0, 1.0])[-tail[0] :]
    rows = np.tile(good, (150,) + (1,) * len(tail))
    for row, entry in ((0, 0), (70, -1), (149, 1)):
        bad = rows.copy()
        bad.reshape(150, -1)[row, entry] = value
        where = row * good.size + (entry % good.size)
        refused(lambda bad=bad: call(bad), rf"{name}: must be finite, got {value} at flat index {where}")
    bad = good.copy()
    bad.reshape(-1)[1] = value
    refused(lambda: call(bad), f"{name}: must be finite")


def test_quaternions_far_from_unit():
    refused(lambda: R.from_quat([0, 0, 0, 0]), r"quat: must be a unit quaternion .* within 1e-6, got norm 0")
    refused(lambda: R.from_quat([0, 0, 0, 2]), "norm 2")
    refused(lambda: R.from_quat([0, 0, 0, 1 + 1.1e-6]), "norm 1.0000011")
    refused(lambda: R.from_quat([1e-200, 0, 0, 0]), "norm 1e-200")
    refused(lambda: R.from_quat([1e200, 0, 0, 0]), r"norm 1e\+200")
    refused(lambda: R.from_quat([[0, 0, 0, 1], [0, 0, 0, 1], [0, 1, 0, 1]]), r"quat\[2\]")
    for near in (1 - 9e-7, 1 + 9e-7):
        assert R.from_quat([0, 0, 0, near]).as_quat()[3] == pytest.approx(1, abs=2.3e-16)


def test_matrices_that_are_no_rotations():
    eye = np.eye(3)
    refused(lambda: R.from_matrix(np.diag([1, 1, -1])), "determinant -1 .a left-handed frame")
    refused(lambda: R.from_matrix(-eye), "determinant -1")
    refused(lambda: R.from_matrix(eye[[1, 0, 2]]), "left-handed")
    refused(lambda: R.from_matrix(np.zeros((3, 3))), "determinant 0 .dependent columns")
    refused(lambda: R.from_matrix(2 * eye), "a deviation of 3")
    refused(lambda: R.from_matrix(eye + np.eye(3, k=1) * 1e-5), "deviation of 1e-05")
    refused(lambda: R.from_matrix(1e200 * eye), "matrix: must be a rotation matrix")
    refused(lambda: R.from_matrix(1e-200 * eye), "matrix: must be a rotation matrix")
    refused(lambda: R.from_matrix([eye, -eye]), r"matrix\[1\]")


def test_operands_that_do_not_fit():
    three, two = R.identity(3), R.identity(2)
    refused(lambda: three * two, r"the right rotations: must be .*got \(2,\) to \(3,\)")
    refused(lambda: three.apply(np.zeros((2, 3))), "vectors: must be as many as the rotations")
    refused(lambda: three.approx_equal(two), "rotations: must be")
    refused(lambda: ph.body_rates("ZYX", np.zeros((2, 3)), np.zeros((3, 3))), "angle_rates: must be as many as angles")
    refused(lambda: one.approx_equal("north"), "quat: must be")
    for other in (2.0, [0, 0, 0, 1], np.array([0, 0, 0, 1.0]), "z", None):
        with pytest.raises(TypeError):
            one * other
        with pytest.raises(TypeError):
            other * one


def test_counts_and_powers():
    for bad in (-1, 2.5, "3"):
        refused(lambda bad=bad: R.identity(bad), "num: must be whole numbers")
        refused(lambda bad=bad: R.random(bad), "num: must be whole numbers")
    refused(lambda: R.identity(shape=(2, -1)), "shape: must be whole numbers")
    refused(lambda: R.random(2, shape=(2,)), "num: must be left out where shape is given")
    for bad in (nan, inf, [1, nan], "x"):
        refused(lambda bad=bad: one**bad, "exponent: must be")


def test_an_empty_array_is_no_error():
    for call, tail in WIDTHS.values():
        call(np.zeros((0, *tail)))


def test_a_refused_array_leaves_nothing_behind():
    turns = SciPy.random(3, rng=1).as_quat()
    turns[1] *= 2
    kept = turns.copy()
    refused(lambda: R.from_quat(turns), r"quat\[1\]")
    assert (turns == kept).all()
