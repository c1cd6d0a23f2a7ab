"""Scene files: every one of ours loads as written, and a wrong one is named with its key and the reason in one line."""

import copy
import json
import tomllib
from pathlib import Path

import numpy as np
import pytest

import polhode as ph
from polhode.recipe import load_recipe
from polhode.schema import make_scene, scene_model

ROOT = Path(__file__).parents[3]
FILES = sorted((ROOT / "scenes").glob("*.toml"))
GOOD = {"body": {"moments": [1.0, 2.0, 2.5]}, "start": {"omega": [1.0, 2.0, 3.0]}, "times": {"span": 1.0, "samples": 3}}


def changed(path, value):
    """GOOD with one key set, or taken away by None; the path's last part is the key."""
    data = copy.deepcopy(GOOD)
    *tables, key = path.split(".")
    table = data
    for name in tables:
        table = table.setdefault(name, {})
    if value is None:
        del table[key]
    else:
        table[key] = value
    return data


@pytest.mark.parametrize("file", FILES, ids=lambda p: p.stem)
def test_our_scenes_load_as_written(file):
    data = tomllib.loads(file.read_text())
    scene = ph.Scene.load(file)
    assert scene == ph.Scene.load(file.stem)
    assert scene.name == data["name"] == file.stem
    moments = data["body"]["moments"] if "moments" in data["body"] else data["body"]["pieces"][0]["inertia"][0]
    np.testing.assert_array_equal(np.diag(scene.inertia.matrix), moments)
    start = data["start"].get("omega") or np.radians(data["start"]["omega_deg"])
    np.testing.assert_array_equal(scene.omega, start)
    np.testing.assert_array_equal(scene.times, np.linspace(0, data["times"]["span"], data["times"]["samples"]))
    kinds = {"gravity": ph.torques.Gravity, "gravity_gradient": ph.torques.GravityGradient,
             "constant": ph.torques.Constant, "damping": ph.torques.Damping}
    if "orbits" in data:   # each a formula or a gradient of its own, and that of light within its windows
        assert len(scene.torques) == len(data["torques"])
        return
    assert [type(t) for t in scene.torques] == [kinds[t["kind"]] for t in data.get("torques", [])]


def test_names_work_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert ph.Scene.load("S1").name == "S1"


def test_a_file_without_a_name_has_its_stem(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('[body]\nmoments = [1, 2, 2.5]\n[start]\nomega = [1, 2, 3]\n[times]\nvalues = [3, 1.5]\n')
    scene = ph.Scene.load(file)
    assert scene.name == "mine" and scene.times.tolist() == [3.0, 1.5]


def test_degrees_and_the_start_time():
    data = changed("start", {"omega_deg": [180.0, 0.0, 90.0], "t0": 5.0})
    scene = make_scene(data)
    np.testing.assert_allclose(scene.omega, [np.pi, 0, np.pi / 2], rtol=1e-15)
    assert scene.t0 == 5 and scene.times.tolist() == [5.0, 5.5, 6.0]


def test_euler_angles():
    for angles in ({"angles": [0.0, 0.5, 0.0]}, {"angles_deg": np.degrees([0.0, 0.5, 0.0]).tolist()}):
        scene = make_scene(changed("start.euler", {"sequence": "ZXZ", **angles}))
        np.testing.assert_allclose(scene.attitude, [np.sin(0.25), 0, 0, np.cos(0.25)], atol=2e-16)


def test_shapes_about_their_centre_or_another_point():
    box = {"shape": "box", "mass": 12.0, "half_sides": [0.3, 0.2, 0.1]}
    np.testing.assert_allclose(make_scene(changed("body", box)).inertia.moments, [0.2, 0.4, 0.52], rtol=1e-15)
    about = make_scene(changed("body", box | {"about": [0.0, 0.0, 0.1]})).inertia
    np.testing.assert_allclose(np.diag(about.matrix), [0.32, 0.52, 0.52], rtol=1e-15)


def test_damping_by_diagonal_or_matrix():
    one = make_scene(changed("torques", [{"kind": "damping", "diagonal": [1.0, 2.0, 3.0]}]))
    other = make_scene(changed("torques", [{"kind": "damping", "matrix": np.diag([1.0, 2.0, 3.0]).tolist()}]))
    assert one.torques == other.torques


@pytest.mark.parametrize(("path", "value", "words"), [
    ("start.omgea", [1, 2, 3], "start.omgea: unknown key, did you mean 'omega'?"),
    ("bdy", {}, "bdy: unknown key, did you mean 'body'?"),
    ("body", None, "body: missing"),
    ("times", 3, "times: must be a table; got 3"),
    ("start.omega", None, "start: give one of omega, omega_deg; got none of them"),
    ("start.omega_deg", [1.0, 2.0, 3.0], "start: give one of omega, omega_deg; got omega and omega_deg"),
    ("start.omega", "fast", "start.omega: must be a list; got 'fast'"),
    ("start.omega", [1, 2], "start.omega: must have at least 3 items, not 2; got [1, 2]"),
    ("start.omega", [1, 2, "3"], "start.omega.2: must be a number; got '3'"),
    ("start.omega", [True, 2, 3], "start.omega.0: must be a number; got True"),
    ("start.omega", [1, 2, float("nan")], "start.omega.2: must be a finite number; got nan"),
    ("start.attitude", [0, 0, 0, 2.0], "attitude: must be a unit quaternion"),
    ("start.euler", {"sequence": "ZXZ"}, "start.euler: give one of angles, angles_deg; got none of them"),
    ("body.shape", "box", "body: give one of moments, matrix, shape, mesh, parts; got moments and shape"),
    ("body.colour", "red", "body: unknown key 'colour' beside moments or a matrix"),
    ("body.moments", [1.0, 1.0, 3.0], "a deficit of 33.33 %"),
    ("body", {"shape": "bx"}, "body.shape: must be one of box, sphere"),
    ("body", {"shape": "table"}, "body.shape: must be one of box, sphere"),
    ("body", {"shape": "box"}, "body: box(mass, half_sides): missing a required argument: 'mass'"),
    ("body", {"shape": "sphere", "mass": 1.0, "radius": 1.0, "physical": False}, "key 'physical' beside a shape"),
    ("torques", [{"kind": "wind"}], "torques.0.kind: must be one of 'constant', 'gravity'"),
    ("torques", [{}], "torques.0: missing the key 'kind'"),
    ("torques", [{"kind": "gravity", "weight": 2.0}], "torques.0.gravity.arm: missing"),
    ("torques", [{"kind": "damping"}], "torques: damping: give matrix or diagonal, one of them"),
    ("torques", [{"kind": "constant", "torque": [1, 2, 3], "frame": "moon"}], "must be 'body' or 'space'; got 'moon'"),
    ("times.samples", 0, "times.samples: must be greater than or equal to 1; got 0"),
    ("times.samples", 2.5, "times.samples: must be an integer; got 2.5"),
    ("times.values", [1.0], "times: give span and samples, or values; got samples, span, values"),
    ("want", ["omega", "spin"], "want.1: must be 'omega' or 'attitude'; got 'spin'"),
])  # fmt: skip
def test_a_wrong_key_is_named_with_the_reason(path, value, words):
    with pytest.raises(ph.InvalidInput) as error:
        make_scene(changed(path, value), "mine.toml")
    text = str(error.value)
    assert text.startswith("mine.toml: ") and words in text and "\n" not in text


def test_many_wrong_keys_stay_one_line():
    with pytest.raises(ph.InvalidInput, match=r"\(and 3 more\)$"):
        make_scene({"a": 1, "b": 2, "c": 3})


@pytest.mark.parametrize(("content", "words"), [
    (b"omega = [1, 2", "not TOML"), (b"\xff\xfe", "not TOML"),
    (None, "must be a file, or one of N2, S1, S10, S11, S13, S14, S15"),
])  # fmt: skip
def test_files_that_cannot_be_read(tmp_path, content, words):
    file = tmp_path / "x.toml"
    if content is not None:
        file.write_bytes(content)
    with pytest.raises(ph.InvalidInput, match=words) as error:
        ph.Scene.load(file)
    assert "\n" not in str(error.value)


def test_the_json_schema_names_every_torque_and_its_parameters():
    text = json.dumps(scene_model().model_json_schema())
    for record in ph.torques.records():
        if record["key"] != "custom":
            assert f'"const": "{record["key"]}"' in text
            assert all(f'"{parameter["name"]}"' in text for parameter in record["parameters"])


def test_the_recipe_draws_what_its_file_says():
    recipe = load_recipe("S8")
    assert recipe == load_recipe(ROOT / "scenes/recipes/S8.toml") and recipe.count == 100000
    bodies = recipe.draw(1000)
    rng = np.random.default_rng(8)
    half_sides, omega = rng.uniform(0.1, 1.0, (1000, 3)), rng.normal(0.0, 1.0, (1000, 3))
    np.testing.assert_array_equal(bodies.half_sides, half_sides)
    np.testing.assert_array_equal(bodies.omega, omega)
    np.testing.assert_array_equal(bodies.t, rng.uniform(0.0, 1000.0, 1000))
    for i in (0, 500, 999):
        box = ph.shapes.box(1.0, half_sides[i]).inertia
        np.testing.assert_allclose(bodies.moments[i], np.diag(box.matrix), rtol=1e-15)
    assert len(recipe.draw().t) == 100000


@pytest.mark.parametrize(("old", "new", "words"), [
    ("seed = 8", "seeds = 8", "seed: missing; seeds: unknown key"),
    ("count = 100000", "count = 0", "count: must be greater than or equal to 1; got 0"),
    ('shape = "box"', 'shape = "cone"', "body.shape: must be 'box'; got 'cone'"),
    ("[0.1, 1.0]", "[1.0, 0.1]", "body.half_sides: uniform: must be [low, high], got [1, 0.1]"),
    ("[0.1, 1.0]", "[-1.0, 1.0]", "half sides must be positive, got -1"),
    ("normal = [0.0, 1.0]", "normal = [0.0, -1.0]", "start.omega: normal: must be [mean, deviation]"),
    ("uniform = [0.0, 1000.0]", "uniform = [0.0]", "times.uniform: must have at least 2 items"),
])  # fmt: skip
def test_wrong_recipes(tmp_path, old, new, words):
    text = (ROOT / "scenes/recipes/S8.toml").read_text()
    assert old in text
    file = tmp_path / "mine.toml"
    file.write_text(text.replace(old, new))
    with pytest.raises(ph.InvalidInput) as error:
        load_recipe(file)
    assert words in str(error.value) and "\n" not in str(error.value)


def test_an_unknown_recipe_names_the_ones_there_are():
    with pytest.raises(ph.InvalidInput, match="one of S8; got 'S1'"):
        load_recipe("S1")
