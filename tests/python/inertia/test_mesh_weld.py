"""Vertices that are meant to be one and differ by rounding, as CAD programs write them."""

import io
import re

import numpy as np
import pytest
from commands import call
from meshes import binary_stl, box, globe, join, seamed, soup
from test_mesh_files import ascii_stl, obj, ply

import polhode as ph


def off(mesh):
    lines = ["OFF", f"{len(mesh[0])} {len(mesh[1])} 0", *(" ".join(map(repr, v)) for v in mesh[0].tolist()),
             *("3 " + " ".join(map(str, f)) for f in mesh[1].tolist())]
    return ("\n".join(lines) + "\n").encode()


def textured(mesh):
    """An OBJ file with a texture vertex for each corner: readers give each corner a vertex of its own."""
    text = io.StringIO()
    for v in mesh[0].tolist():
        text.write("v " + " ".join(map(repr, v)) + "\n")
    for k in range(3 * len(mesh[1])):
        text.write(f"vt {k / 1000} 0.5\n")
    for k, f in enumerate(mesh[1].tolist()):
        text.write("f " + " ".join(f"{v + 1}/{3 * k + c + 1}" for c, v in enumerate(f)) + "\n")
    return text.getvalue().encode()


SEAM = seamed()
FILES = {"ascii.stl": ascii_stl(SEAM), "binary.stl": binary_stl(SEAM), "text.ply": ply(SEAM),
         "binary.ply": ply(SEAM, "binary_little_endian"), "part.obj": obj(SEAM), "textured.obj": textured(SEAM),
         "part.off": off(SEAM)}


def apart(body, other):
    """The largest difference of two bodies, relative to mass and largest moment."""
    largest = max(body.inertia.moments)
    size = (largest / body.mass) ** 0.5
    return max(abs(body.mass / other.mass - 1), np.abs(body.com - other.com).max() / size,
               np.abs(body.inertia.matrix - other.inertia.matrix).max() / largest)


@pytest.mark.parametrize("name", FILES)
def test_seams_of_rounding_in_every_format(tmp_path, name):
    file = tmp_path / name
    file.write_bytes(FILES[name])
    with pytest.raises(ph.InvalidInput, match="open edges"):
        ph.MassProperties.from_file(file, density=1, weld=0)
    body = ph.MassProperties.from_file(file, density=1)
    assert apart(body, ph.MassProperties.from_file(file, density=1, check=False)) <= 2e-15
    assert apart(body, ph.MassProperties.from_mesh(*globe(), density=1)) <= (2e-7 if "binary.stl" in name else 4e-15)
    found = ph.mesh.report(*ph.mesh.read(file))
    assert found["closed"] and found["welded"] >= 11 and 0 < found["moved"] < 3e-16 and found["open_edges"] == 0
    exactly = ph.mesh.report(*ph.mesh.read(file), weld=0)
    assert not exactly["closed"] and exactly["welded"] == 0 and 0 < exactly["closes_at"] < 1e-15 * 1.01


@pytest.mark.parametrize("scale", [1e-12, 1.0, 1e12])
@pytest.mark.parametrize("gap, welded", [(1e-10, True), (1.9e-9, True), (2.1e-9, False), (1e-8, False)])
@pytest.mark.filterwarnings("ignore:vertices. the mesh is")
def test_the_weld_is_a_part_of_the_size(gap, welded, scale):
    """The ball is 2 long, so that the default joins what is nearer than 2e-9."""
    vertices, faces = seamed(gap=gap)
    vertices = vertices * scale
    assert ph.mesh.report(vertices, faces)["closed"] == welded
    if welded:
        found = ph.mesh.report(vertices, faces)
        assert found["moved"] == pytest.approx(gap * scale, rel=1e-5) and found["size"] == pytest.approx(2 * scale)
        return
    with pytest.raises(ph.InvalidInput) as refused:
        ph.MassProperties.from_mesh(vertices, faces, density=1)
    found = ph.mesh.report(vertices, faces)
    assert gap / 2 < found["closes_at"] <= 1.1 * gap / 2
    assert "open, but closed when vertices nearer than" in str(refused.value)
    (offered,) = re.findall(r"weld=(\S+)\)", str(refused.value))
    assert float(offered) == found["closes_at"]
    body = ph.MassProperties.from_mesh(vertices, faces, density=1, weld=found["closes_at"])
    truth = ph.MassProperties.from_mesh(globe()[0] * scale, globe()[1], density=1)
    assert apart(body, truth) <= 2 * gap


def test_the_welded_surface_is_what_is_integrated():
    """A wide gap, far from the origin: the sums over an open surface would depend on the reference point."""
    vertices, faces = seamed(gap=1e-3)
    here = ph.MassProperties.from_mesh(vertices, faces, density=1, weld=1e-3)
    there = ph.MassProperties.from_mesh(vertices + 4.0, faces, density=1, weld=1e-3)
    assert abs(here.mass / there.mass - 1) < 1e-14
    assert apart(here, ph.MassProperties.from_mesh(*globe(), density=1)) < 1e-14


def test_neither_the_order_of_vertices_nor_that_of_faces_matters():
    vertices, faces = soup(seamed(gap=1e-10))
    body, found = ph.MassProperties.from_mesh(vertices, faces, density=1), ph.mesh.report(vertices, faces)
    rng = np.random.default_rng(5)
    for _ in range(10):
        order = rng.permutation(len(vertices))
        back = np.argsort(order)
        other = vertices[order], back[faces][rng.permutation(len(faces))]
        assert ph.mesh.report(*other)["welded"] == found["welded"]
        # The first of a group may be another, 1e-10 away.
        assert apart(ph.MassProperties.from_mesh(*other, density=1), body) < 1e-10


def test_chains_are_one_group_in_any_order():
    """Each vertex is near the next alone: whichever comes first, the hole closes."""
    corners, faces = box()
    shifts = np.arange(5) * 1.5e-9
    for order in ([0, 1, 2, 3, 4], [4, 2, 0, 3, 1], [2, 4, 0, 1, 3]):
        vertices, own = [*map(tuple, corners)], faces.copy()
        places = {k: len(vertices) + i for i, k in enumerate(order)}
        vertices += [tuple(corners[0] + (shifts[k], 0, 0)) for k in order]
        for k, (face, corner) in enumerate(np.argwhere(own == 0)[:5]):
            own[face, corner] = places[k]
        found = ph.mesh.report(vertices, own)
        assert found["closed"] and found["moved"] <= 4 * 1.5e-9 * 1.001


def test_what_is_closed_is_left_alone():
    """A sliver thinner than the weld is no seam."""
    thin = box((5, 0, 0), (6, 1, 1e-10))
    assert ph.mesh.report(*thin)["welded"] == 0
    assert ph.MassProperties.from_mesh(*thin, density=1).mass == pytest.approx(1e-10, rel=1e-14)
    both = join(thin, seamed())
    found = ph.mesh.report(*both)
    assert found["closed"] and found["degenerate"] == 0
    body = ph.MassProperties.from_mesh(*both, density=1)
    assert body.mass == pytest.approx(1e-10 + ph.MassProperties.from_mesh(*globe(), density=1).mass, rel=1e-14)


@pytest.mark.parametrize("weld", [-1e-9, np.nan, np.inf, 1e-16, 0.02, 5.0])
def test_bad_welds(weld):
    for call_it in (lambda: ph.MassProperties.from_mesh(*SEAM, density=1, weld=weld),
                    lambda: ph.mesh.report(*SEAM, weld=weld)):
        with pytest.raises(ph.InvalidInput, match="^weld: must be "):
            call_it()


def test_many_loose_vertices_take_time_in_proportion():
    """Every vertex is loose, and half a million pairs lie in one corner of the grid; pairwise it would take hours."""
    vertices, faces = soup(globe(200, 100))
    rng = np.random.default_rng(1)
    vertices = vertices + 1e-10 * rng.uniform(-1, 1, vertices.shape)
    found = ph.mesh.report(vertices, faces)
    assert found["closed"] and found["welded"] == len(vertices) - len(globe(200, 100)[0])
    cloud = rng.uniform(0, 1e-6, (60000, 3))
    far = np.concatenate([cloud, [(1.0, 1, 1), (2, 1, 1), (1, 2, 1)]])
    loose = np.arange(len(far)).reshape(-1, 3)
    assert not ph.mesh.report(far, loose)["closed"]


def test_the_command_line(tmp_path):
    file = tmp_path / "part.stl"
    file.write_bytes(FILES["ascii.stl"])
    result = call("inertia", file, "--density", "1")
    assert result.exit_code == 0
    words = " ".join(result.stdout.split())
    assert "vertices of open edges took the place of another, 3e-16 m away at most" in words
    file.write_bytes(ascii_stl(seamed(gap=1e-6)))
    result = call("inertia", file, "--density", "1")
    words = " ".join(result.stdout.split())
    assert result.exit_code == 1 and "open, but closed when vertices nearer than 1" in words and "--weld 5" in words
    assert call("inertia", file, "--density", "1", "--weld", "1e-6").exit_code == 0
    assert call("inertia", "S1", "--weld", "1e-6").exit_code == 2
