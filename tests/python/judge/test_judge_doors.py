"""Bad input of `ph.judge`: refused by one sentence, or a finding where the data are at fault."""

import json

import numpy as np
import pytest

import polhode as ph
from polhode._judge.codes import CODES, LEVELS

I = (1.0, 2.0, 2.5)
T = np.linspace(0, 6, 100)
W, Q = ph.FreeMotion(I, (1, 0.5, 2)).at(T)


@pytest.mark.parametrize(
    "change, words",
    [
        ({"attitude": None, "omega": None}, "attitude: must be given, or omega, or both; got neither"),
        ({"omega": W[:50]}, "omega: must have a row for each of the 100 times, got 50"),
        ({"omega": W[:, :2]}, r"omega: must be of shape \(n, 3\), got \(100, 2\)"),
        ({"attitude": W}, "attitude: three numbers a sample are Euler angles"),
        ({"attitude": "north"}, "attitude: must be an array of numbers, got str|attitude: must be of shape"),
        ({"order": "zyxw"}, "order: must be 'xyzw' or 'wxyz', got 'zyxw'"),
        ({"frame": "earth"}, "frame: must be 'body' or 'space', got 'earth'"),
        ({"euler": "XXY"}, "euler: must be one of the 24 sequences"),
        ({"tolerance": -1}, "tolerance: must be a number from 0 up, got -1"),
        ({"inertia": I, "scene": 5}, "inertia: must be left out with scene"),
        ({"inertia": None, "scene": 5}, "scene: must be a polhode.Scene, got int"),
        ({"inertia": (1, 2, 9)}, "triangle|sum of the two others|no body"),
        ({"t": T[:1], "omega": W[:1], "attitude": Q[:1]}, "t: must have at least 2 times, got 1"),
    ],
)
def test_bad_arguments_are_refused(change, words):
    arguments = {"t": T, "attitude": Q, "omega": W, "inertia": I, **change}
    with pytest.raises(ph.InvalidInput, match=words):
        ph.judge(**arguments)


def spoil(array, row, value):
    array = array.copy()
    array[row] = value
    return array


@pytest.mark.parametrize(
    "change, cause, where",
    [
        ({"omega": spoil(W, 5, np.nan)}, "finite", (5,)),
        ({"attitude": spoil(Q, 7, np.inf)}, "finite", (7,)),
        ({"t": spoil(T, 9, T[8])}, "time", (9,)),
        ({"t": T[::-1]}, "time", None),
        ({"attitude": spoil(Q, 3, 0.0)}, "no rotation", (3,)),
        ({"attitude": ph.Rotation.from_quat(Q).as_matrix() * [1, 1, -1]}, "no rotation", None),
        ({"attitude": 1.2 * Q}, "no rotation", None),
        ({"attitude": np.random.default_rng(1).permutation(Q)}, "inconsistent", None),
    ],
)
def test_faults_of_the_data_are_findings(change, cause, where):
    found = ph.judge(**{"t": T, "attitude": Q, "omega": W, "inertia": I, **change})
    assert found.findings[0].cause == cause and found.level == "error"
    assert where is None or found.findings[0].where == where


def test_a_judgement_is_json():
    found = ph.judge(T, Q, W + [0.1, 0, 0], inertia=I)
    content = json.loads(json.dumps(found.to_dict(), allow_nan=False))
    assert content["fine"] is False and content["level"] == "warning"
    finding = content["findings"][0]
    assert finding["code"] == "PJ110" and finding["cause"] == "bias" and finding["size"][0] == pytest.approx(0.1)
    assert found.line().startswith("100 samples") and "[PJ110]" in found.line() and "bias" in str(found)


def test_codes_and_causes_are_unique_and_ordered():
    assert len({code.cause for code in CODES.values()}) == len(CODES) == 43
    first = {"0": "error", "1": "warning", "2": "remark"}
    assert all(code.level == first[code.name[2]] and code.level in LEVELS for code in CODES.values())


def test_input_arrays_are_not_changed():
    t, q, w = T * 1000, np.roll(Q, 1, axis=1), np.degrees(W)
    copies = t.copy(), q.copy(), w.copy()
    ph.judge(t, q, w, inertia=I)
    assert all(np.array_equal(a, b) for a, b in zip((t, q, w), copies))
