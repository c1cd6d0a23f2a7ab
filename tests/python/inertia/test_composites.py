"""Bodies put together, in Python and in scene files: shapes, meshes and points, each in its place."""

import mpmath as mp
import numpy as np
import pytest
from meshes import binary_stl
from meshes import box as box_mesh

import polhode as ph
from polhode._scene.bodies import body_properties
from polhode.schema import load_body, make_scene

BOX = ph.shapes.box
TURN = ph.Rotation.from_euler("ZYX", (0.4, -0.2, 1.1))


def same(a, b, tolerance=4e-16):
    np.testing.assert_allclose(a.mass, b.mass, rtol=tolerance)
    size = np.sqrt(b.inertia.moments[2] / b.mass)
    np.testing.assert_allclose(a.com, b.com, rtol=0, atol=tolerance * (size + np.linalg.norm(b.com)))
    np.testing.assert_allclose(a.inertia.matrix, b.inertia.matrix, rtol=0, atol=tolerance * b.inertia.moments[2])


def load(tmp_path, text):
    file = tmp_path / "body.toml"
    file.write_text("[body]\n" + text)
    return body_properties(load_body(file))


# ---- volumes


def turned(radius, low, high):
    """Volume of a solid round z, by washers: radius gives the outer and the inner one."""
    with mp.workdps(30):
        return mp.pi * mp.quad(lambda z: radius(z)[0] ** 2 - radius(z)[1] ** 2, [low, (low + high) / 2, high])


ROUND = {
    "sphere": ((1.7,), lambda z: (mp.sqrt(max(1.7**2 - z * z, 0)), 0), -1.7, 1.7),
    "cylinder": ((0.3, 2.0), lambda z: (0.3, 0), -1, 1),
    "cone": ((0.3, 2.0), lambda z: (0.3 * (1 - z / 2), 0), 0, 2),
    "capsule": ((0.5, 2.0), lambda z: (mp.sqrt(0.25 - max(abs(z) - 1, 0) ** 2), 0), -1.5, 1.5),
    "torus": ((3.0, 0.5), lambda z: (3 + mp.sqrt(0.25 - z * z), 3 - mp.sqrt(0.25 - z * z)), -0.5, 0.5),
}


@pytest.mark.parametrize("name", ROUND)
def test_volumes_of_round_solids(name):
    sizes, *solid = ROUND[name]
    assert ph.shapes.volume(name, *sizes) == pytest.approx(float(turned(*solid)),
                                                           rel=1e-6 if name == "capsule" else 1e-12)


def test_volumes_of_the_others():
    volume = ph.shapes.volume
    assert volume("box", (1, 2, 3)) == 48 and volume("box", half_sides=(0.5,) * 3) == 1
    assert volume("ellipsoid", (2, 2, 2)) == pytest.approx(volume("sphere", 2), rel=1e-15)
    assert volume("ellipsoid", (1, 2, 3)) == pytest.approx(6 * volume("sphere", 1), rel=1e-15)
    assert volume("capsule", 2, 0) == pytest.approx(volume("sphere", 2), rel=1e-15)
    assert volume("hollow_box", (1, 2, 3), 0.5) == pytest.approx(48 - volume("box", (0.5, 1.5, 2.5)), rel=1e-15)
    assert volume("hollow_box", (1, 2, 3), 1) == 48 and volume("hollow_box", (1, 2, 3), 0) == 0
    corners = np.array([(0, 0, 0), (3, 0.1, 0), (0.2, 2, 0), (0.3, 0.4, 1)])
    exact = abs(np.linalg.det(corners[1:] - corners[0])) / 6
    assert volume("tetrahedron", corners + 5) == pytest.approx(exact, rel=1e-14)
    assert volume("triangular_prism", [(0, 0), (3, 1), (1, 2)], 4) == 10


@pytest.mark.parametrize("call, words", [
    (("rod", 1), "shape: must be one with a volume, got rod (a thin body: give its mass)"),
    (("ball", 1), "shape: must be one of box, sphere"),
    (("sphere", -1), "radius: must be positive"),
])
def test_volumes_that_there_are_not(call, words):
    with pytest.raises(ph.InvalidInput) as refused:
        ph.shapes.volume(*call)
    assert words in str(refused.value)


# ---- from files


def test_parts_in_a_file_are_the_sums_in_python(tmp_path):
    (tmp_path / "plate.stl").write_bytes(binary_stl(box_mesh((0, 0, 0), (200, 100, 10))))
    body = load(tmp_path, """
[[body.parts]]
shape = "cylinder"
density = 2700.0
radius = 0.01
height = 0.01
position = [0.05, 0.05, 0.005]
subtract = true

[[body.parts]]
mesh = "plate.stl"
unit = "mm"
density = 2700.0

[[body.parts]]
shape = "box"
mass = 0.5
half_sides = [0.01, 0.02, 0.03]
position = [0.15, 0.05, 0.04]
euler = { sequence = "ZYX", angles = [0.4, -0.2, 1.1] }

[[body.parts]]
masses = [0.1, 0.2]
positions = [[0.0, 0.0, 0.1], [0.2, 0.0, 0.1]]
attitude = [0.0, 0.0, 0.6, 0.8]
""")
    plate = BOX(2700 * 0.2 * 0.1 * 0.01, (0.1, 0.05, 0.005)).moved(translation=(0.1, 0.05, 0.005))
    hole = ph.shapes.cylinder(2700 * np.pi * 0.01**3, 0.01, 0.01).moved(translation=(0.05, 0.05, 0.005))
    block = BOX(0.5, (0.01, 0.02, 0.03)).moved(TURN, (0.15, 0.05, 0.04))
    points = ph.MassProperties.from_points([0.1, 0.2], [(0, 0, 0.1), (0.2, 0, 0.1)]).moved((0, 0, 0.6, 0.8))
    same(body, plate + block + points - hole, 2e-15)


def test_one_mesh_in_a_file(tmp_path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "b.stl").write_bytes(binary_stl(box_mesh((-1, -2, -3), (1, 2, 3))))
    same(load(tmp_path, 'mesh = "parts/b.stl"\nmass = 48.0\n'), BOX(48, (1, 2, 3)))
    same(load(tmp_path, 'mesh = "parts/b.stl"\ndensity = 2.0\nunit = 0.5\n'), BOX(12, (0.5, 1, 1.5)))
    same(load(tmp_path, 'shape = "box"\ndensity = 2.0\nhalf_sides = [1.0, 2.0, 3.0]\n'), BOX(96, (1, 2, 3)))
    same(load(tmp_path, 'shape = "box"\ndensity = 0.5\nhalf_sides = [1.0, 2.0, 3.0]\n'), BOX(24, (1, 2, 3)))
    scene = tmp_path / "scene.toml"
    scene.write_text('[body]\nmesh = "parts/b.stl"\nmass = 48.0\nabout = [0.0, 0.0, 3.0]\n[start]\nomega = [1.0, 2.0, '
                     '3.0]\n'
                     "[times]\nspan = 1.0\nsamples = 3\n")
    expected = BOX(48, (1, 2, 3)).about((0, 0, 3))
    np.testing.assert_allclose(ph.Scene.load(scene).inertia.matrix, expected.matrix, rtol=1e-15)


SPHERE = {"shape": "sphere", "mass": 1.0, "radius": 1.0}


@pytest.mark.parametrize("body, words", [
    ({"parts": []}, "body.parts: must be one part or more, got none"),
    ({"parts": [{**SPHERE, "subtract": True}]}, "body.parts.0: must have a part to be taken out of"),
    ({"parts": [SPHERE, {**SPHERE, "mass": 2.0, "subtract": True}]},
     "body.parts.1: difference: must be a body of positive mass"),
    ({"parts": [SPHERE], "shape": "box"}, "give one of moments, matrix, shape, mesh, parts; got shape and parts"),
    ({"parts": [{**SPHERE, "radius": -1.0}]}, "body.parts.0: radius: must be positive"),
    ({"parts": [{**SPHERE, "shape": "ball"}]}, "body.parts.0.shape: must be one of box"),
    ({"parts": [{**SPHERE, "density": 2.0}]}, "body.parts.0: give one of mass, density; got mass and density"),
    ({"parts": [{"shape": "sphere", "density": -2.0, "radius": 1.0}]},
     "body.parts.0: density: must be positive, got -2"),
    ({"parts": [{"shape": "rod", "density": 2.0, "length": 1.0}]}, "body.parts.0: shape: must be one with a volume"),
    ({"parts": [{"mass": 1.0}]}, "body.parts.0: give one of shape, mesh, masses; got none of them"),
    ({"parts": [{"masses": [1.0]}]}, "body.parts.0: masses: give their positions too"),
    ({"parts": [{"masses": [1.0], "positions": [[0.0, 0.0, 0.0]], "radius": 2.0}]},
     "unknown key 'radius' beside masses"),
    ({"parts": [{"masses": [1.0, -1.0], "positions": [[0.0, 0.0, 0.0]] * 2}]},
     "body.parts.0: masses[1]: must be positive"),
    ({"parts": [{"mesh": "gone.stl", "density": 1.0}]}, "gone.stl: cannot be read"),
    ({"parts": [{"mesh": "gone.stl"}]}, "body.parts.0: give one of mass, density; got none of them"),
    ({"mesh": "gone.stl", "density": 1.0, "radius": 1.0}, "body: unknown key 'radius' beside a mesh"),
    ({"parts": [SPHERE], "physical": False}, "body: unknown key 'physical' beside parts"),
    ({"parts": [{**SPHERE, "attitude": [0.0, 0.0, 0.0, 1.0], "euler": {"sequence": "ZXZ", "angles": [0.0, 0.0, 0.0]}}]},
     "body.parts.0: give attitude or euler, not both"),
])
def test_a_wrong_part_is_named(body, words):
    with pytest.raises(ph.InvalidInput) as refused:
        make_scene({"body": body, "start": {"omega": [1.0, 2.0, 3.0]}, "times": {"span": 1.0, "samples": 3}},
                   "mine.toml")
    text = str(refused.value)
    assert text.startswith("mine.toml: ") and words in text and "\n" not in text, text
