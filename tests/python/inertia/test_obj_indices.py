"""OBJ files that count vertices backwards."""

import numpy as np
import pytest
from meshes import box

import polhode as ph


def relative(mesh, *, late=False, style="{v}"):
    """A file whose faces count back; `late` puts each four vertices behind the faces before."""
    vertices, faces = mesh
    lines = [f"v {x} {y} {z}" for x, y, z in vertices.tolist()] if not late else []
    if "vt" in style:
        lines += ["vt 0 0", "vt 1 0"]
    for face in faces.tolist():
        if late:
            lines += [f"v {x} {y} {z}" for x, y, z in vertices[face].tolist()]
            face, count = [0, 1, 2], 3
        else:
            count = len(vertices)
        lines.append("f " + " ".join(style.format(v=v - count, vt=-1, vn=-1) for v in face))
    return ("\n".join(lines) + "\n").encode()


@pytest.mark.parametrize("late", [False, True])
@pytest.mark.parametrize("style", ["{v}", "{v}/{vt}"])
def test_relative_indices(tmp_path, late, style):
    mesh = box((0, 0, 0), (1, 2, 3))
    file = tmp_path / "part.obj"
    file.write_bytes(relative(mesh, late=late, style=style))
    body = ph.MassProperties.from_file(file, density=2)
    assert body == ph.MassProperties.from_mesh(*mesh, density=2)


def test_a_line_that_goes_on_and_both_ways_of_counting(tmp_path):
    file = tmp_path / "part.obj"
    file.write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 -2 \\\n -3\nf 1 2 -1\nf -3 3 4\nf\t1 -1 3\n")
    assert ph.MassProperties.from_file(file, density=6).mass == 1


def test_indices_before_the_first(tmp_path):
    file = tmp_path / "part.obj"
    file.write_bytes(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n")
    with pytest.raises(ph.InvalidInput, match="a face names vertex -4, but 3 stand before it"):
        ph.mesh.read(file)


def test_the_counts_of_an_off_file_on_its_first_line(tmp_path):
    vertices, faces = box()
    rows = [" ".join(map(repr, v)) for v in vertices.tolist()]
    rows += ["3 " + " ".join(map(str, f)) for f in faces.tolist()]
    file = tmp_path / "part.off"
    file.write_bytes("\n".join(["OFF8 12 0 # all on one line", *rows, ""]).encode())
    np.testing.assert_array_equal(ph.mesh.read(file)[1], faces)
