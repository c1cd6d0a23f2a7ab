"""Open surfaces: where the holes are, and how much they can change."""

import json

import numpy as np
import pytest
from commands import call
from meshes import binary_stl, box, globe, inward, join, soup

import polhode as ph

TURN = ph.Rotation.from_rotvec((0.3, -1.1, 0.7)).as_matrix()


def changes(mesh, kept):
    """The report of the faces kept, and the true errors of mass, centre and tensor, measured as the report does."""
    vertices, faces = mesh
    truth = ph.MassProperties.from_mesh(vertices, faces, density=1)
    body = ph.MassProperties.from_mesh(vertices, faces[kept], density=1, check=False)
    found = ph.mesh.report(vertices, faces[kept])
    assert not found["closed"]
    return found, {
        "mass": abs(truth.mass / body.mass - 1), "centre": np.linalg.norm(truth.com - body.com),
        "inertia": np.linalg.norm(truth.inertia.matrix - body.inertia.matrix, 2) / body.inertia.moments[2]}


def potato(around, along):
    return globe(around, along, lambda x, y, z: 1 + 0.3 * x * y + 0.2 * z**3, TURN)


SOLIDS = {"box": box((-1, -2, -3), (1, 2, 3)), "far box": box((99, 98, 97), (101, 102, 103)), "coarse": potato(8, 6),
          "fine": potato(48, 24), "hollow": join(box(), inward(box((-0.5,) * 3, (0.5,) * 3)))}


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("name", SOLIDS)
@pytest.mark.filterwarnings("ignore:vertices. the mesh is")
def test_one_face_taken_out(name, scale):
    vertices, faces = SOLIDS[name]
    vertices = vertices * scale
    for face in np.linspace(0, len(faces) - 1, 12).astype(int):
        kept = np.delete(np.arange(len(faces)), face)
        found, true = changes((vertices, faces), kept)
        (hole,) = found["holes"]
        corners = vertices[faces[face]]
        assert hole["edges"] == 3 and found["open_edges"] == 3 and found["hole_count"] == 1
        sides = np.linalg.norm(corners - np.roll(corners, -1, 0), axis=1)
        centre = (sides[:, None] * (corners + np.roll(corners, -1, 0)) / 2).sum(0) / sides.sum()
        np.testing.assert_allclose(hole["centre"], centre, rtol=1e-12, atol=1e-12 * scale)
        assert hole["radius"] == pytest.approx(np.linalg.norm(corners - centre, axis=1).max(), rel=1e-9)
        for key, error in true.items():
            assert error <= found["errors"][key], (key, face)


def patch(mesh, angle):
    """The faces of a ball that are not within an angle of a direction."""
    vertices, faces = mesh
    middle = vertices[faces].mean(1)
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    return np.flatnonzero(middle @ TURN[2] < np.cos(angle))


@pytest.mark.parametrize("angle", [0.1, 0.2, 0.4, 0.8, 1.2, 1.5])
def test_caps_taken_out_up_to_half_a_ball(angle):
    """What is missing bulges out of its loop, and lies within the ball all the same."""
    mesh = globe(96, 48, turn=TURN)
    found, true = changes(mesh, patch(mesh, angle))
    assert found["hole_count"] == 1
    for key, error in true.items():
        assert error <= found["errors"][key], key
    if angle <= 0.4:
        # Small holes: the flux through the hole is what counts, and not the ball.
        assert found["errors"]["mass"] < (3 if angle <= 0.2 else 6) * true["mass"]
        assert found["errors"]["inertia"] < np.inf
    assert abs(np.dot(found["holes"][0]["centre"], TURN[2]) - np.cos(angle)) < 0.1


def test_several_holes_add_up():
    mesh = globe(48, 24, turn=TURN)
    taken = [5, 300, 156, 900, 1200]
    found, true = changes(mesh, np.delete(np.arange(len(mesh[1])), taken))
    assert found["hole_count"] == 4 and sorted(h["edges"] for h in found["holes"]) == [3, 3, 3, 4]
    radii = [hole["radius"] for hole in found["holes"]]
    assert radii == sorted(radii, reverse=True)
    for key, error in true.items():
        assert error <= found["errors"][key] < 20 * max(error, 1e-4), key


def test_holes_that_share_a_vertex_are_two():
    mesh = box((0, 0, 0), (1, 1, 1))
    taken = [0, 2]   # of the bottom and the top: no vertex in common
    found = ph.mesh.report(mesh[0], np.delete(mesh[1], taken, 0))
    assert [hole["edges"] for hole in found["holes"]] == [3, 3]
    faces = mesh[1].tolist()
    pair = next((i, j) for i in range(12) for j in range(i) if len(set(faces[i]) & set(faces[j])) == 1)
    found = ph.mesh.report(mesh[0], np.delete(mesh[1], pair, 0))
    assert sorted(hole["edges"] for hole in found["holes"]) == [3, 3]


def test_a_stl_file_with_a_hole_and_seams():
    """Seams are welded first: their gaps are no holes."""
    vertices, faces = soup(globe(24, 12))
    rng = np.random.default_rng(3)
    vertices = vertices + 1e-12 * rng.uniform(-1, 1, vertices.shape)
    body = ph.MassProperties.from_mesh(vertices, faces, density=1)
    found = ph.mesh.report(vertices, faces[1:])
    assert found["hole_count"] == 1 and found["welded"] > 1000
    part = ph.MassProperties.from_mesh(vertices, faces[1:], density=1, check=False)
    assert abs(body.mass / part.mass - 1) <= found["errors"]["mass"] < 0.02


def test_parts_that_touch_along_an_edge_change_nothing():
    """The flux through nothing is 0, and the integrals are right."""
    touching = soup(join(box(), box((1, 1, -1), (2, 2, 1))))
    found = ph.mesh.report(*touching)
    assert not found["closed"] and found["crowded_edges"] == 1 and found["hole_count"] == 0 and found["holes"] == []
    assert found["errors"] == {"mass": 0, "centre": 0, "inertia": 0} and found["closes_at"] is None
    turned = box()[1].copy()
    turned[4] = turned[4, ::-1]
    found = ph.mesh.report(box()[0], turned)
    assert found["turned_edges"] == 3 and found["hole_count"] == 2   # out of one face, into its copy
    truth, body = (ph.MassProperties.from_mesh(box()[0], f, density=1, check=False) for f in (box()[1], turned))
    assert abs(truth.mass / body.mass - 1) <= found["errors"]["mass"]


def test_holes_that_are_too_large_have_no_bound():
    vertices, faces = box()
    found = ph.mesh.report(vertices, faces[:4])
    assert found["errors"]["centre"] == np.inf and found["errors"]["inertia"] == np.inf
    plane = np.array([(0, 0, 0), (1.0, 0, 0), (0, 1, 0)]), np.array([[0, 1, 2]])
    found = ph.mesh.report(*plane)
    assert found["errors"]["mass"] == np.inf and found["open_edges"] == 3
    strays = join(box(), inward(box((2, 2, 2), (2.5, 2.5, 2.5))))
    found = ph.mesh.report(*strays)
    assert found["closed"] and found["strays"] == 1 and found["cavities"] == 1


def test_the_command_line_says_where(tmp_path):
    file = tmp_path / "part.stl"
    vertices, faces = globe(48, 24, turn=TURN)
    file.write_bytes(binary_stl((1000 * vertices, faces[1:])))
    result = call("inertia", file, "--density", "1", "--unit", "mm")
    words = " ".join(result.stdout.split())
    assert result.exit_code == 1 and "3 open edges" in words and "a hole of 3 edges about (" in words
    assert "left open, the mass of a density is within 0.042 %" in words
    found = json.loads(call("inertia", file, "--density", "1", "--unit", "mm", "--json").stdout)
    assert not found["valid"] and found["hole_count"] == 1 and found["errors"]["mass"] < 0.003
    file.write_bytes(binary_stl((vertices, faces[:10])))
    found = json.loads(call("inertia", file, "--density", "1", "--json").stdout)
    assert found["errors"]["inertia"] is None
