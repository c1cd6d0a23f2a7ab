"""Files that claim more than they hold, or are none: one line within a second, and little memory."""

import json
import os
import resource
import subprocess
import sys
import time

import numpy as np
import pytest

import polhode as ph
from polhode._scene.scene import scene_folder
from polhode._solve import costs
from polhode.inertia import robots

SCENE = """[body]
{body}
[start]
omega = [1.0, 2.0, 3.0]
{start}
[times]
{times}
"""
MOMENTS, TIMES = "moments = [1.0, 2.0, 2.5]", "span = 1.0\nsamples = 11"
URDF = """<robot name="r"><link name="a"><inertial><mass value="1"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><mesh filename="{}"/></geometry></visual></link></robot>"""


def scene(body=MOMENTS, start="", times=TIMES):
    return SCENE.format(body=body, start=start, times=times)


SCENES = {
    "a null character in a path": (scene('mesh = "a\\u0000.stl"\ndensity = 1.0'), "without null characters"),
    "an integer of 5000 digits": (scene(times="span = 1.0\nsamples = " + "9" * 5000), "not TOML"),
    "a real of 400 digits": (scene(times=f"span = 1{'0' * 400}\nsamples = 5"), "times.span"),
    "lists nested 5000 deep": ("a = " + "[" * 5000, "nested too deep"),
    "tables nested 5000 deep": ("a = " + "{a = " * 5000, "nested too deep"),
    "1e11 samples": (scene(times="span = 1.0\nsamples = 100000000000"), "times.samples: .* 10000000"),
    "1e20 samples": (scene(times="span = 1.0\nsamples = 99999999999999999999"), "times.samples"),
    "3e8 samples": (scene(times="span = 1.0\nsamples = 300000000"), "times.samples"),
    "an end beyond float64": (scene(start="t0 = 1e308", times="span = 1e308\nsamples = 5"), "times.span: must end"),
    "a mesh of 300 letters": (scene(f'mesh = "{"x" * 300}.stl"\ndensity = 1.0'), "File name too long"),
    "a mesh that is a folder": (scene('mesh = "folder.stl"\ndensity = 1.0'), "it is a folder"),
    "an endless mesh": (scene('mesh = "zero.stl"\ndensity = 1.0'), "a device or a pipe"),
    "a mesh that is a pipe": (scene('mesh = "pipe.stl"\ndensity = 1.0'), "a device or a pipe"),
    "a mesh with holes of 8 GB": (scene('mesh = "holes.stl"\ndensity = 1.0'), "at most 4000 MB"),
    "a part that is a pipe": (scene('[[body.parts]]\nmesh = "pipe.ply"\ndensity = 1.0'), "a device or a pipe"),
    "a hundred thousand wrong keys": (scene() + "\n".join(f"k{i} = 1" for i in range(100_000)), "and 99997 more"),
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "folder.stl").mkdir()
    (tmp_path / "zero.stl").symlink_to("/dev/zero")
    for suffix in ("stl", "ply", "toml", "urdf"):
        os.mkfifo(tmp_path / f"pipe.{suffix}")
    with open(tmp_path / "holes.stl", "wb") as file:
        file.truncate(8_000_000_000)
    return tmp_path


def run(*arguments, memory=None, **more):
    """The command in a process of its own, with at most so many bytes of memory more than it starts with."""
    limit = (lambda: resource.setrlimit(resource.RLIMIT_AS, (memory, memory))) if memory else None
    return subprocess.run([sys.executable, "-m", "polhode", *map(str, arguments)], capture_output=True, text=True,
                          timeout=60, preexec_fn=limit, **more)


@pytest.mark.parametrize("name", SCENES)
def test_a_hostile_scene_is_refused_at_once(name, folder):
    text, message = SCENES[name]
    (folder / "scene.toml").write_text(text)
    start = time.perf_counter()
    with pytest.raises(ph.InvalidInput, match=message) as refused:
        ph.Scene.load(folder / "scene.toml")
    assert time.perf_counter() - start < 1 + 20 * (len(text) > 100_000)   # a file of a megabyte takes its time
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 600


@pytest.mark.parametrize("name", ["3e8 samples", "an endless mesh", "lists nested 5000 deep"])
def test_the_command_says_one_line_and_takes_little_memory(name, folder):
    (folder / "scene.toml").write_text(SCENES[name][0])
    found = run("run", folder / "scene.toml", memory=4_000_000_000)
    assert found.returncode == 2 and found.stderr.count("\n") == 1 and "Traceback" not in found.stderr, found.stderr


def test_files_that_are_none_are_refused(folder):
    for path in ("pipe.toml", "x" * 300, "a\0b", folder / "folder.stl"):
        with pytest.raises(ph.InvalidInput, match="scene: must be"):
            ph.Scene.load(folder / path if path == "pipe.toml" else path)
        with pytest.raises(ph.InvalidInput, match="recipe: must be"):
            ph.recipe.load_recipe(folder / path if path == "pipe.toml" else path)
    with pytest.raises(ph.InvalidInput, match="a device or a pipe"):
        robots.read(folder / "pipe.urdf")
    for load in (ph.Scene.load, ph.recipe.load_recipe, ph.mesh.read, robots.read):
        for wrong in (3, None, b"S1", ["S1"]):
            with pytest.raises(ph.InvalidInput, match="must be a path"):
                load(wrong)


def test_a_recipe_claims_a_bounded_number_of_bodies(tmp_path):
    text = (scene_folder() / "recipes" / "S8.toml").read_text()
    lines = ["count = 99999999999999999999" if line.startswith("count") else line for line in text.splitlines()]
    (tmp_path / "r.toml").write_text("\n".join(lines))
    with pytest.raises(ph.InvalidInput, match="count: .* 10000000"):
        ph.recipe.load_recipe(tmp_path / "r.toml")


@pytest.mark.parametrize("name", ["x" * 300, "package://" + "y" * 5000, "a\0b", "../" * 2000, "file://%00"])
def test_a_robot_with_a_mesh_name_that_is_none(name, tmp_path):
    (tmp_path / "r.urdf").write_text(URDF.format(name.replace("\0", "&#9;")))
    robot = robots.read(tmp_path / "r.urdf")
    assert "not found" in robot.links[0].notes[0] or "not compared" in robot.links[0].notes[0]


@pytest.mark.parametrize("uri", ["../secret.bin", "zero.bin", "pipe.bin", "gone.bin", "%2e%2e/secret.bin", "/dev/zero"])
def test_a_gltf_file_names_data_in_its_own_folder_alone(uri, tmp_path):
    pytest.importorskip("trimesh", reason="needs trimesh")
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "secret.bin").write_bytes(b"secret" * 100)
    (inside / "zero.bin").symlink_to("/dev/zero")
    os.mkfifo(inside / "pipe.bin")
    content = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 100, "uri": uri}]}
    (inside / "a.gltf").write_text(json.dumps(content))
    with pytest.raises(ph.InvalidInput, match="cannot be read as GLTF") as refused:
        ph.mesh.read(inside / "a.gltf")
    assert "secretsecret" not in str(refused.value)


@pytest.mark.parametrize("content", [
    '{"factors": {"rk45": 1' + "0" * 400 + "}}", "[" * 100_000, '{"factors": {"rk45": 1' + "0" * 5000 + "}}", "\udcff",
    '{"factors": 3}', "", "null", "device", "folder",
], ids=range(9))
def test_a_damaged_file_of_costs_is_ignored(content, tmp_path, monkeypatch):
    file = tmp_path / "costs.json"
    if content == "device":
        file.symlink_to("/dev/zero")
    elif content == "folder":
        file.mkdir()
    else:
        file.write_bytes(content.encode(errors="surrogateescape"))
    monkeypatch.setenv("POLHODE_CACHE", str(tmp_path))
    factors, text = costs._read()
    assert factors == {} and ("damaged" in text or "cannot be read" in text)


def test_a_glb_file_that_lies_about_its_json_is_refused(tmp_path):
    """A chunk that is longer than the rest of the file, by less than its header."""
    body = json.dumps({"asset": {"version": "2.0"}}).encode()
    for more in (1, 19, 20, 21, 39, 10_000):
        data = (b"glTF" + np.array([2, 20 + len(body), len(body) + more], "<u4").tobytes() + b"JSON" + body)
        (tmp_path / "a.glb").write_bytes(data)
        with pytest.raises(ph.InvalidInput, match=f"with {len(body) + more} of them JSON"):
            ph.mesh.read(tmp_path / "a.glb")


@pytest.mark.parametrize("count", ["9" * 5000, "9" * 19, "-1", "x" * 5000, "\u0663"])
def test_a_ply_file_claims_a_count_in_one_line(count, tmp_path):
    (tmp_path / "a.ply").write_text(f"ply\nformat ascii 1.0\nelement vertex {count}\nend_header\n")
    with pytest.raises(ph.InvalidInput, match="claims .* of element vertex, but has") as refused:
        ph.mesh.read(tmp_path / "a.ply")
    assert len(str(refused.value)) < 600


TABLES = {
    "a cell of 200 000 letters": (
        "t,omega_x,omega_y,omega_z\n" + "x" * 200_000 + ",1,2,3\n", "must be a table of text"),
    "a cell of 100 000 letters": (
        "t,omega_x,omega_y,omega_z\n" + "x" * 100_000 + ",1,2,3\n", "must be numbers, got 'xxx"),
    "a million names": ("n," * 1_000_000 + "t\n" + "1," * 1_000_000 + "1\n" + "1\n" * 50_000, "must name a sensor"),
    "bytes": ("\udcff\udcfe\0", "must be text in UTF-8"), "nothing": ("", "must have a header and rows"),
}


@pytest.mark.parametrize("name", TABLES)
def test_a_table_of_measurements_that_is_none(name, tmp_path):
    """Short rows beside one of a million cells would fill 400 GB, if each had its place in a table."""
    from polhode._sensitivity import table

    text, message = TABLES[name]
    (tmp_path / "a.csv").write_bytes(text.encode(errors="surrogateescape"))
    with pytest.raises(ph.InvalidInput, match=message) as refused:
        table.read(tmp_path / "a.csv", None, {"omega": 0.1})
    assert "\n" not in str(refused.value) and len(str(refused.value)) < 600


@pytest.mark.parametrize("content", ["[" * 100_000, "[]", "null", '{"family": []}', "pipe", "zero", "\udcff"],
                         ids=range(7))
def test_an_earlier_result_of_the_atlas_that_is_none_is_not_kept(content, tmp_path):
    from polhode.atlas.results import read_family

    path = tmp_path / "a.json"
    if content == "pipe":
        os.mkfifo(path)
    elif content == "zero":
        path.symlink_to("/dev/zero")
    else:
        path.write_bytes(content.encode(errors="surrogateescape"))
    assert read_family(path) is None


def test_a_pipe_that_takes_the_place_of_a_file_does_not_hang(tmp_path, monkeypatch):
    from polhode import _files

    os.mkfifo(tmp_path / "a")
    monkeypatch.setattr(_files, "size_of", lambda path, most: 1)   # the look found a file
    with pytest.raises(ph.InvalidInput, match="a device or a pipe"):
        _files.read(tmp_path / "a", 100)
