"""Meshes from files: what each format holds, and files that are cut short, lie or are something else."""

import json
import struct
import tracemalloc

import numpy as np
import pytest
from meshes import binary_stl, box, inward, join, soup

import polhode as ph

MESH = join(box((0, 0, 0), (1, 2, 3)), inward(box((0.25, 0.5, 0.5), (0.75, 1.5, 2.5))))
BODY = ph.MassProperties.from_mesh(*MESH, density=2700)


def ascii_stl(mesh):
    lines = ["solid part"]
    for corners in mesh[0][mesh[1]].tolist():
        lines += ["facet normal 0 0 0", " outer loop", *(" vertex " + " ".join(map(repr, c)) for c in corners),
                  " endloop", "endfacet"]
    return ("\n".join([*lines, "endsolid part"]) + "\n").encode()


def obj(mesh):
    lines = ["mtllib nothing.mtl", "o part", *("v " + " ".join(map(repr, v)) for v in mesh[0].tolist()),
             *("f " + " ".join(f"{i + 1}//1" for i in f) for f in mesh[1].tolist())]
    lines.insert(2, "vn 0 0 1")
    return "\n".join(lines).encode()


def ply(mesh, style="ascii", vertices=None):
    head = (f"ply\nformat {style} 1.0\nelement vertex {len(mesh[0]) if vertices is None else vertices}\n"
            "property double x\nproperty double y\nproperty double z\n"
            f"element face {len(mesh[1])}\nproperty list uchar int vertex_indices\nend_header\n").encode()
    if style == "ascii":
        rows = [*(" ".join(map(repr, v)) for v in mesh[0].tolist()),
                *("3 " + " ".join(map(str, f)) for f in mesh[1].tolist())]
        return head + ("\n".join(rows) + "\n").encode()
    return head + mesh[0].astype("<f8").tobytes() + b"".join(b"\3" + f.astype("<i4").tobytes() for f in mesh[1])


def gltf(mesh, **changes):
    """Two nodes that share a mesh: one as it is, one mirrored and a hundred away."""
    import base64

    data = mesh[0].astype("<f4").tobytes() + mesh[1].astype("<u4").tobytes()
    content = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0}, {"mesh": 0, "translation": [100, 0, 0], "scale": [-1, 1, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(mesh[0]), "type": "VEC3"},
                      {"bufferView": 1, "componentType": 5125, "count": mesh[1].size, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 12 * len(mesh[0])},
                        {"buffer": 0, "byteOffset": 12 * len(mesh[0]), "byteLength": 4 * mesh[1].size}],
        "buffers": [{"byteLength": len(data),
                     "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}],
    }
    return json.dumps({**content, **changes}).encode()


FILES = {
    "binary.stl": binary_stl(MESH), "solid.stl": binary_stl(MESH, head=b"solid but binary"),
    "text.STL": ascii_stl(MESH),
    "part.obj": obj(MESH), "text.ply": ply(MESH), "binary.ply": ply(MESH, "binary_little_endian"),
}


@pytest.mark.parametrize("name", FILES)
def test_every_format_gives_the_same_body(tmp_path, name):
    file = tmp_path / name
    file.write_bytes(FILES[name])
    body = ph.MassProperties.from_file(file, density=2700)
    assert body.mass == BODY.mass
    np.testing.assert_allclose(body.com, BODY.com, rtol=1e-15)
    np.testing.assert_allclose(body.inertia.matrix, BODY.inertia.matrix, atol=4e-16 * BODY.inertia.moments[2])
    small = ph.MassProperties.from_file(str(file), mass=2, unit="mm")
    np.testing.assert_allclose(small.inertia.matrix, BODY.inertia.matrix * 2e-6 / BODY.mass, rtol=1e-14, atol=1e-20)


def test_gltf_places_what_it_holds(tmp_path):
    file = tmp_path / "two.gltf"
    file.write_bytes(gltf(MESH))
    body = ph.MassProperties.from_file(file, density=2700)
    mirrored = ph.MassProperties(BODY.mass, BODY.com * (-1, 1, 1) + (100, 0, 0), BODY.inertia)
    expected = BODY + mirrored
    assert body.mass == expected.mass
    np.testing.assert_allclose(body.com, expected.com, rtol=1e-15)
    np.testing.assert_allclose(body.inertia.matrix, expected.inertia.matrix, atol=1e-15 * expected.inertia.moments[2])


def test_points_and_lines_of_a_gltf_have_no_volume(tmp_path):
    """Primitives of the modes 0 to 3, beside the triangles."""
    triangles = {"attributes": {"POSITION": 0}, "indices": 1}
    for mode in range(4):
        file = tmp_path / f"mode{mode}.gltf"
        file.write_bytes(gltf(MESH, meshes=[{"primitives": [triangles, {"attributes": {"POSITION": 0}, "mode": mode}]}],
                              nodes=[{"mesh": 0}, {}]))
        assert ph.MassProperties.from_file(file, density=2700).mass == BODY.mass


def trimesh_judges(mesh):
    import trimesh

    return trimesh.Trimesh(*mesh, process=False)


def test_trimesh_agrees_near_the_origin():
    judge = trimesh_judges(MESH)
    judge.density = 2700
    np.testing.assert_allclose(BODY.mass, judge.mass, rtol=1e-14)
    np.testing.assert_allclose(BODY.com, judge.center_mass, rtol=1e-13)
    np.testing.assert_allclose(BODY.inertia.matrix, judge.moment_inertia, atol=1e-13 * BODY.inertia.moments[2])


WRONG = {
    "short.stl": (b"\x01" * 83, "84 bytes or more, got 83"),
    "cut.stl": (FILES["binary.stl"][:-7], "claims 24 triangles, which take 1284 bytes, but has 1277 bytes, room for "
                                          "23"),
    "lies.stl": (binary_stl(MESH, 40_000_000)[:100],
                 "claims 40000000 triangles, which take 2000000084 bytes, but has 100"),
    "less.stl": (binary_stl(MESH, 3), "claims 3 triangles, which take 234 bytes, but has 1284"),
    "none.stl": (binary_stl(MESH, 0)[:84], "one triangle or more, got none"),
    "empty.stl": (b"", "got 0"),
    "cuttext.stl": (FILES["text.STL"][:700], "cut short?"),
    "nosolid.stl": (b"solid nothing\nendsolid nothing\n", "one triangle or more, got none"),
    "words.stl": (FILES["text.STL"].replace(b"vertex 1.0", b"vertex one", 1), "no number"),
    "nan.stl": (FILES["text.STL"].replace(b"vertex 1.0", b"vertex nan", 1), "vertices: must be finite"),
    "open.stl": (binary_stl((MESH[0], MESH[1][1:])), "faces: must be a closed surface"),
    "lies.ply": (ply(MESH, "binary_little_endian", 250_000_000)[:400], "claims 250000000 of element vertex, but has"),
    "minus.ply": (ply(MESH, vertices=-1), "claims -1 of element vertex"),
    "cut.ply": (FILES["binary.ply"][:-50], ""),
    "cutbefore.ply": (FILES["text.ply"][:60], "PLY header"),
    "index.ply": (FILES["text.ply"].replace(b"3 0 2 1", b"3 0 2 99", 1), ""),
    "index.obj": (FILES["part.obj"].replace(b"f 1//1 3//1", b"f 1//1 9999//1", 1), ""),
    "words.obj": (b"v one two three\nf 1 2 3\n", ""),
    "nothing.obj": (b"# nothing\n", ""),
    "no.gltf": (b"{", "holds no glTF"),
    "list.gltf": (b"[]", "holds no glTF"),
    "deep.gltf": (b"[" * 100_000, "holds no glTF"),
    "lies.gltf": (gltf(MESH, accessors=[{"componentType": 5126, "count": 10**9, "type": "VEC3"}] * 2),
                  "claims 1000000000"),
    "sparse.gltf": (gltf(MESH, accessors=[{"bufferView": 0, "componentType": 5126, "count": 16, "type": "VEC3",
                                           "sparse": {}}]),
                    "sparse accessors, which are not read"),
    "mesh9.gltf": (gltf(MESH, nodes=[{"mesh": 0}, {"mesh": 9}]), "node 1 names mesh 9"),
    "child.gltf": (gltf(MESH, nodes=[{"mesh": 0, "children": [0]}, {"mesh": 0}]), "no tree of nodes"),
    "twice.gltf": (gltf(MESH, nodes=[{"children": [1, 2]}, {"children": [2]}, {"mesh": 0}]), "no tree of nodes"),
    "ring.gltf": (gltf(MESH, nodes=[{"mesh": 0, "children": [1]}, {"mesh": 0, "children": [0]}]), "which has a parent"),
    "draco.gltf": (gltf(MESH, extensionsRequired=["KHR_draco_mesh_compression"]), "needs KHR_draco_mesh_compression"),
    "fan.gltf": (gltf(MESH, meshes=[{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "mode": 6}]}]),
                 "mode 6"),
    "count.gltf": (gltf(MESH, accessors=[{"bufferView": 0, "componentType": 5126, "count": 10**9, "type": "VEC3"}] * 2),
                   ""),
    "other.gltf": (gltf(MESH, buffers=[{"byteLength": 100, "uri": "../../../../dev/zero"}]), "cannot be read as GLTF"),
    "list.ply": (ply(MESH, "binary_little_endian").replace(b"list uchar int", b"list uint int"), ""),
    "cut.glb": (b"glTF" + struct.pack("<IIII", 2, 2**31, 2**31 - 20, 0x4E4F534A), "claims 2147483648 bytes"),
    "short.glb": (b"glTF", "glTF header"),
    "part.step": (b"ISO-10303-21;", "must be a mesh file, one of .stl"),
    "part": (b"", "no suffix"),
}


@pytest.mark.parametrize("name", WRONG)
def test_wrong_files_get_one_line_and_no_memory(tmp_path, name):
    data, words = WRONG[name]
    file = tmp_path / name
    file.write_bytes(data)
    ph.MassProperties.from_file  # what is imported at the first use does not count
    try:
        import trimesh  # noqa: F401
    except ImportError:
        pass
    tracemalloc.start()
    try:
        with pytest.raises(ph.InvalidInput) as refused:
            ph.MassProperties.from_file(file, density=1)
        peak = tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
    text = str(refused.value)
    assert text.startswith(str(file)) and words in text and "\n" not in text, text
    assert peak < 2_000_000 + 50 * len(data), peak


def test_a_file_that_is_not_there(tmp_path):
    for path in (tmp_path / "gone.stl", tmp_path):
        with pytest.raises(ph.InvalidInput, match="cannot be read|must be a mesh file"):
            ph.MassProperties.from_file(path, density=1)


def test_without_trimesh(tmp_path, monkeypatch):
    import sys

    monkeypatch.setitem(sys.modules, "trimesh", None)
    (tmp_path / "part.obj").write_bytes(FILES["part.obj"])
    with pytest.raises(ph.InvalidInput, match=r"pip install 'polhode\[mesh\]'"):
        ph.MassProperties.from_file(tmp_path / "part.obj", density=1)
    (tmp_path / "part.stl").write_bytes(FILES["binary.stl"])
    assert ph.MassProperties.from_file(tmp_path / "part.stl", density=2700).mass == BODY.mass


def test_reading_alone(tmp_path):
    (tmp_path / "part.stl").write_bytes(FILES["binary.stl"])
    vertices, faces = ph.mesh.read(tmp_path / "part.stl")
    expected = soup(MESH)
    assert np.array_equal(vertices, expected[0]) and np.array_equal(faces, expected[1])
    assert ph.mesh.report(vertices, faces)["cavities"] == 1
