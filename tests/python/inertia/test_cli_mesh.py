"""`polhode inertia` on mesh files."""

import json
import pathlib
import re

import numpy as np
import pytest
from commands import call, left
from meshes import binary_stl, box, inward, join

import polhode as ph

MESH = join(box((0, 0, 0), (200, 100, 10)), inward(box((50, 20, 2), (60, 30, 8))))


@pytest.fixture
def part(tmp_path):
    file = tmp_path / "part.stl"
    file.write_bytes(binary_stl(MESH))
    return file


def test_a_part(part):
    result = call("inertia", part, "--density", "2700", "--unit", "mm")
    assert result.exit_code == 0, result.output
    body = ph.MassProperties.from_mesh(*MESH, density=2700, unit="mm")
    for x in (body.mass, *body.com, *body.inertia.moments, *body.inertia.axes.ravel()[:2]):
        assert f"{x:.9g}"[:9] in result.stdout
    assert "cavities           1" in result.stdout and "size [m]           0.2, 0.1, 0.01" in result.stdout
    found = json.loads(call("inertia", part, "--mass", 2, "--unit", "0.001", "--json").stdout)
    assert found["mass"] == 2 and found["valid"] and found["volume"] == body.mass / 2700 and found["notes"] == []
    np.testing.assert_allclose(found["moments"], body.inertia.moments * 2 / body.mass, rtol=1e-15)


def test_what_is_said_besides(part):
    found = json.loads(call("inertia", part, "--json").stdout)
    assert found["notes"] == ["neither --density nor --mass is given: the density is 1 kg/m^3"]
    found = json.loads(call("inertia", part, "--mass", 1, "--unit", "ft", "--json").stdout)
    assert found["notes"] == []
    found = json.loads(call("inertia", part, "--mass", 1, "--unit", "20", "--json").stdout)
    assert found["notes"] == ["vertices: the mesh is 4000 m long: is that meant? --unit mm reads millimetres"]


def test_what_is_no_surface_is_a_finding(tmp_path):
    file = tmp_path / "part.stl"
    file.write_bytes(binary_stl((MESH[0], MESH[1][1:])))
    result = call("inertia", file, "--mass", 1)
    assert result.exit_code == 1 and "3 open edges" in result.stdout
    file.write_bytes(binary_stl(inward(MESH)))
    result = call("inertia", file, "--mass", 1)
    assert result.exit_code == 1 and "--flip turns them" in result.stdout
    result = call("inertia", file, "--mass", 1, "--flip")
    assert result.exit_code == 0 and "turned over" in result.stdout


@pytest.mark.parametrize("options, words", [
    (("--density", "0"), "--density: must be positive"),
    (("--mass", "nan"), "--mass: must be positive"),
    (("--mass", "1", "--density", "1"), "got both"),
    (("--unit", "yard"), "unit: must be a length in metres, or one of m, dm"),
    (("--unit", "-1"), "unit: must be positive"),
])
def test_bad_options(part, options, words, capsys):
    status, out, err = left("inertia", part, *options, capsys=capsys)
    assert status == 2 and words in err and err.count("\n") == 1 and not out


def test_options_that_would_have_no_effect(capsys):
    for option in (("--density", "2"), ("--mass", "2"), ("--unit", "mm"), ("--flip",)):
        status, _, err = left("inertia", "S1", *option, capsys=capsys)
        assert status == 2 and f"{option[0]}: must be used with a mesh file" in err


def test_a_file_that_lies(part, capsys):
    part.write_bytes(part.read_bytes()[:-3])
    status, _, err = left("inertia", part, capsys=capsys)
    assert status == 2 and "claims 24 triangles" in err and err.count("\n") == 1


# ---- the page


PAGE = (pathlib.Path(__file__).parents[3] / "docs/inertia.md").read_text()


def section(name):
    return re.search(rf"^### {name}\n(.*?)(?=^##)", PAGE, flags=re.S | re.M)[1]


def test_the_page_shows_this_part(part):
    shown = re.search(r"\$ polhode inertia part.stl (.*?)\n(.*?)```", section("Meshes"), flags=re.S)
    result = call("inertia", part, *shown[1].split())
    assert [line.rstrip() for line in result.stdout.splitlines()] == shown[2].splitlines()


def test_the_pages_examples_run():
    names = {}
    (mesh,) = re.findall(r"```python\n(.*?)```", section("Meshes"), flags=re.S)
    exec(compile(mesh, "docs/inertia.md", "exec"), names)
    assert names["wedge"].mass == 2700 and list(names["wedge"].com) == [0.25, 0.5, 0.75]
    with pytest.raises(ph.InvalidInput) as refused:
        ph.MassProperties.from_mesh(names["corners"], names["faces"][1:], density=2700)
    assert str(refused.value) in " ".join(PAGE.split())


def test_the_pages_composite_is_the_same_in_both_ways(tmp_path):
    names = {}
    (python,) = re.findall(r"```python\n(.*?)```", section("Composites"), flags=re.S)
    exec(compile(python, "docs/inertia.md", "exec"), names)
    (toml,) = re.findall(r"```toml\n(.*?)```", section("Composites"), flags=re.S)
    (tmp_path / "body.toml").write_text("[body]\n" + toml)
    (tmp_path / "plate.stl").write_bytes(binary_stl(box((-100, -50, -5), (100, 50, 5))))
    found = json.loads(call("inertia", tmp_path / "body.toml", "--json").stdout)
    part = names["part"]
    np.testing.assert_allclose(found["mass"], part.mass, rtol=1e-15)
    np.testing.assert_allclose(found["com"], part.com, rtol=0, atol=1e-16)
    np.testing.assert_allclose(found["matrix"], part.inertia.matrix, rtol=0, atol=1e-15 * part.inertia.moments[2])
