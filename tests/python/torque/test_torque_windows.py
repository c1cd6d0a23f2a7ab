"""A torque during windows of time: the value itself, at its door and in scene files."""

import math
import pickle

import numpy as np
import pytest
from bodies import BLOCK
from scene_files import write_scene

import polhode as ph
from polhode.torques import Constant, Custom, Damping, During, Gravity, GravityGradient

FIRING = Constant((0.05, -0.02, 0.03))
INF = math.inf


def scene(*torques):
    return ph.Scene(inertia=BLOCK, omega=(0.1, 0.2, 0.3), torques=torques, times=np.linspace(0, 60, 61), name="fired")


def nothing(t, omega, attitude):
    return (0.0, 0.0, 0.0)


@pytest.mark.parametrize("torque", [FIRING, Gravity(2, (0.3, 0.2, 0.5)), GravityGradient(1e-3), Damping((1, 2, 3)),
                                    Custom(nothing)], ids=lambda torque: type(torque).__name__)
def test_it_is_a_value(torque):
    one = During(torque, [(30, 40), (0, 10)])
    again = pickle.loads(pickle.dumps(one))
    assert again == one and hash(again) == hash(one) and repr(again) == repr(one)
    assert one.windows == ((0.0, 10.0), (30.0, 40.0)) and one.torque == torque
    assert one != During(torque, [(0, 10)]) and one != torque and one != During(Constant((9, 9, 9)), one.windows)
    assert one.traits == {**torque.traits, "uses_time": True}
    assert During(torque, (0, 10)) == During(torque, [[0, 10]])
    assert During(torque, np.array([(0, 5), (5, 10)])) == During(torque, (0, 10))
    held = scene(one)
    if not isinstance(torque, Custom):
        assert eval(repr(one), {"polhode": ph}) == one and pickle.loads(pickle.dumps(held)) == held != scene(torque)


@pytest.mark.parametrize(("windows", "words"), [
    ([(10, 0)], "got [10, 0] (begin and end are swapped)"), ([(5, 5)], "got [5, 5] (the window is empty"),
    ([(0, 10), (5, 15)], "apart from each other, got [0, 10] and [5, 15] (give two torques"),
    ([(0, np.nan)], "got [0, nan]"),
    ([(np.nan, 1)], "got [nan, 1]"), ([(0, 1, 2)], "pairs (begin, end), got shape (1, 3)"), ("soon", "During.windows"),
    ([(INF, INF)], "got [inf, inf]"), ([0, 1, 2, 3], "pairs"), (None, "During.windows"),
])
def test_bad_windows_are_refused(windows, words):
    with pytest.raises(ph.InvalidInput, match=r"During\.windows: must be") as error:
        During(FIRING, windows)
    assert words in str(error.value)


def test_what_is_no_torque_is_refused():
    with pytest.raises(ph.InvalidInput, match="During.torque: must be a torque without windows, got During"):
        During(During(FIRING, [(0, 1)]), [(0, 1)])
    with pytest.raises(ph.InvalidInput, match="During.torque: must be a torque of polhode.torques"):
        During(lambda t, w, q: (0, 0, 1), [(0, 1)])


FIRED = """
[[torques]]
kind = "constant"
torque = [0.05, -0.02, 0.03]
during = {windows}
[[torques]]
kind = "damping"
diagonal = [0.1, 0.1, 0.1]
"""


def write_windows(folder, windows):
    return write_scene(folder / "fired.toml", FIRED.format(windows=windows), moments=(0.20, 0.40, 0.52),
                       omega=(0.1, 0.2, 0.3), times="span = 60.0\nsamples = 61")


def test_a_scene_file_has_windows(tmp_path):
    file = write_windows(tmp_path, "[[0, 10], [30.0, inf]]")
    assert ph.Scene.load(file) == scene(During(FIRING, [(0, 10), (30, INF)]), Damping((0.1, 0.1, 0.1)))
    assert ph.Scene.load(write_windows(tmp_path, "[]")).torques[0] == During(FIRING, [])


@pytest.mark.parametrize(("windows", "words"), [
    ("[[10, 0]]", "During.windows: must be pairs of a begin and a later end"), ("[[0, nan]]", "During.windows"),
    ("[[0, 1, 2]]", "torques.0.constant.during.0: must have at most 2 items"),
    ('"soon"', "torques.0.constant.during: must be a list"),
    ("[[0, 10], [5, 7]]", "apart from each other"),
])
def test_bad_windows_in_a_file(tmp_path, windows, words):
    file = write_windows(tmp_path, windows)
    with pytest.raises(ph.InvalidInput) as error:
        ph.Scene.load(file)
    assert words in str(error.value) and str(error.value).startswith("fired.toml") and "\n" not in str(error.value)


def test_the_schema_names_the_key():
    from polhode.schema import scene_model

    models = {name: one["properties"] for name, one in scene_model().model_json_schema()["$defs"].items()
              if "properties" in one}
    torques = {name for name, keys in models.items() if "kind" in keys} - {"Field"}
    assert len(torques) > 8 and {name for name, keys in models.items() if "during" in keys} == torques | {"Rotor"}
