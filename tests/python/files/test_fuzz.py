"""Random bytes and random doubles at every door: a result, or InvalidInput in one line; and one answer by every way."""

import json
import pathlib
import runpy
import struct
import sys
import time
import types
import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import polhode as ph
from polhode.inertia import robots

QUICK = settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
LONG = settings(max_examples=5_000, deadline=None, suppress_health_check=list(HealthCheck))

# ---- files

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


def stl():
    rows = b"".join(struct.pack("<12fH", *[0.0] * 3, *CORNERS[side].ravel(), 0) for side in SIDES)
    return b"solid part".ljust(80, b"\0") + struct.pack("<I", 4) + rows


def ascii_stl():
    loops = "".join("facet normal 0 0 0\nouter loop\n" + "".join("vertex {} {} {}\n".format(*CORNERS[v]) for v in side)
                    + "endloop\nendfacet\n" for side in SIDES)
    return f"solid part\n{loops}endsolid part\n".encode()


def obj():
    return ("".join("v {} {} {}\n".format(*c) for c in CORNERS)
            + "".join("f {} {} {}\n".format(*(side + 1)) for side in SIDES)).encode()


def ply():
    head = ("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n")
    return (head + "".join("{} {} {}\n".format(*c) for c in CORNERS)
            + "".join("3 {} {} {}\n".format(*side) for side in SIDES)).encode()


def glb():
    body = CORNERS.astype("<f4").tobytes() + SIDES.astype("<u2").tobytes()
    content = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": len(body)}], "scene": 0,
               "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
               "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
                             {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
               "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
               "nodes": [{"mesh": 0}], "scenes": [{"nodes": [0]}]}
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    return (b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(body)) + struct.pack("<I", len(text)) + b"JSON" + text
            + struct.pack("<I", len(body)) + b"BIN\0" + body)


SCENE = b"""name = "a"
[body]
shape = "box"
mass = 3.0
half_sides = [0.1, 0.2, 0.3]
[start]
omega = [1.0, 2.0, 3.0]
euler = { sequence = "ZXZ", angles_deg = [10.0, 20.0, 30.0] }
[[torques]]
kind = "gravity"
weight = 9.0
arm = [0.0, 0.1, 0.2]
during = [[0.0, 1.0]]
[times]
span = 2.0
samples = 21
"""
INERTIA = '<inertia ixx="1" iyy="1.5" izz="2" ixy="0.1" ixz="0" iyz="0"/>'
URDF = f"""<robot name="r"><link name="a">
<inertial><origin xyz="0 0 0.1" rpy="0 0.2 0"/><mass value="2"/>{INERTIA}</inertial>
<visual><origin xyz="0 0 0"/><geometry><box size="1 2 3"/></geometry></visual>
<collision><geometry><cylinder radius="1" length="2"/></geometry></collision></link></robot>""".encode()
SDF = b"""<sdf version="1.9"><model name="m"><link name="a"><inertial><pose>0 0 0 0 0 1</pose><mass>2</mass><inertia>
<ixx>1</ixx><iyy>1.5</iyy><izz>2</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial>
<visual name="v"><geometry><sphere><radius>1</radius></sphere></geometry></visual></link></model></sdf>"""
MJCF = b"""<mujoco model="m"><compiler angle="radian"/><default><geom density="2000"/></default><worldbody>
<body name="b"><inertial pos="0 0 0" quat="1 0 0 0" mass="2" diaginertia="1 1.5 2"/><geom type="box" size="1 2 3"/>
<body name="c"><geom type="capsule" fromto="0 0 0 1 1 1" size="0.1"/></body></body></worldbody></mujoco>"""


RECIPE = b"""count = 5
seed = 8
draw = "by-body"
[body]
shape = "box"
mass = 3.0
half_sides = [0.1, 0.2, { uniform = [0.2, 0.3] }]
[start]
omega = { normal = [[0.0, 0.0, 0.2], 0.05] }
attitude = { normal_deg = 3.0, about = [0.0, 0.0, 0.0, 1.0] }
[[torques]]
kind = "damping"
diagonal = [0.1, 0.1, 0.1]
diagonal_relative = { log_uniform = [0.1, 0.3], same = true }
[times]
span = 2.0
samples = 3
[[summary]]
of = "axis_angle"
axis = [0.0, 0.0, 1.0]
target = [0.0, 1.0, 1.0]
[sweep]
"torques.0.diagonal" = [[0.1, 0.1, 0.1], [0.2, 0.2, 0.2]]
"""


def read_recipe(file):
    from polhode._ensemble import draw, recipe

    made = recipe.load(file)
    return made if made.count > 5 else [len(draw.draw(made, point, 0, 2)) for point in made.points[:3]]


def judge(file):
    return [link.diagnose() for link in robots.read(file).links]


SEEDS = {"a.stl": (stl(), ph.mesh.read), "b.stl": (ascii_stl(), ph.mesh.read), "a.obj": (obj(), ph.mesh.read),
         "a.ply": (ply(), ph.mesh.read), "a.glb": (glb(), ph.mesh.read), "a.toml": (SCENE, ph.Scene.load),
         "recipe.toml": (RECIPE, read_recipe),
         "a.urdf": (URDF, judge), "a.sdf": (SDF, judge), "a.xml": (MJCF, judge)}
PIECES = [b"0", b"-1", b"1e400", b"nan", b"inf", b"9" * 30, b"\0", b"\xff", b"<", b">", b'"', b"[", b"]", b"{", b"=",
          b"\n", b" ", b"1e-320", b"mesh", b"''", b"&a;", b"<!--", b"\xef\xbb\xbf", b"4294967295", b"\xff" * 4]


@st.composite
def changed(draw, seed):
    """A file with a few changes: bytes replaced, parts removed, doubled or swapped, pieces put in."""
    data = bytearray(seed)
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(data)))
        kind = draw(st.sampled_from(("byte", "cut", "double", "piece", "remove", "number")))
        end = min(len(data), at + draw(st.integers(0, 40)))
        if kind == "byte" and at < len(data):
            data[at] = draw(st.integers(0, 255))
        elif kind == "cut":
            del data[at:]
        elif kind == "double":
            data[at:at] = data[at:end]
        elif kind == "remove":
            del data[at:end]
        elif kind == "number":
            data[at:at] = repr(draw(st.floats())).encode()
        else:
            data[at:end] = draw(st.sampled_from(PIECES))
    return bytes(data)


def try_file(name, folder, data):
    file = folder / name
    file.write_bytes(data)
    start = time.perf_counter()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")   # of meshes that are kilometres long, say
        try:
            SEEDS[name][1](file)
        except ph.InvalidInput as error:
            assert "\n" not in str(error).strip(), error
    assert time.perf_counter() - start < 5


@pytest.mark.parametrize("name", SEEDS)
def test_the_seeds_are_read(name, tmp_path):
    if name[-3:] in ("obj", "ply", "glb"):
        pytest.importorskip("trimesh", reason="needs trimesh")
    (tmp_path / name).write_bytes(SEEDS[name][0])
    assert SEEDS[name][1](tmp_path / name)


@pytest.mark.parametrize("name", SEEDS)
def test_changed_files_are_read_or_refused(name, tmp_path):
    QUICK(given(changed(SEEDS[name][0]))(lambda data: try_file(name, tmp_path, data)))()


@pytest.mark.long
@pytest.mark.parametrize("name", SEEDS)
def test_many_changed_files_are_read_or_refused(name, tmp_path):
    LONG(given(changed(SEEDS[name][0]))(lambda data: try_file(name, tmp_path, data)))()


# ---- doubles by their bits

BITS = st.integers(0, 2**64 - 1).map(lambda bits: struct.unpack("<d", struct.pack("<Q", bits))[0])
MIXED = st.one_of(st.floats(-10, 10), st.floats(-10, 10), st.floats(), BITS)
VECTOR, TIMES = st.tuples(MIXED, MIXED, MIXED), st.lists(MIXED, min_size=1, max_size=70)
MOMENTS = st.one_of(st.tuples(*[st.floats(1.0, 1.9)] * 3), VECTOR)


def tried(call):
    """The arrays of a call, or None where it is refused."""
    try:
        return call()
    except ph.InvalidInput as error:
        assert "\n" not in str(error)
        return None


def same(a, b):
    return all(np.array_equal(x, y, equal_nan=True) for x, y in zip(a, b, strict=True))


def check_free(moments, omega, times):
    """Batches have the same bits for any threads and neighbours, and FreeMotion's values to its rounding."""
    one = tried(lambda: ph.FreeMotion(moments, omega).at(times))
    if one is None:
        return
    t, bodies = np.array(times), np.array([moments] * 70)[:, None]
    many = ph.free_motion(bodies, omega, (0, 0, 0, 1), t, threads=1)
    assert same(many, ph.free_motion(bodies, omega, (0, 0, 0, 1), t, threads=2))
    assert all(same((many[0][0], many[1][0]), (many[0][k], many[1][k])) for k in (1, 63, 69))
    with np.errstate(all="ignore"):
        size = np.abs(one[0]).max() or 1.0
        assert np.array_equal(np.isfinite(one[0]), np.isfinite(many[0][0]))
        assert np.nanmax(np.abs(one[0] / size - many[0][0] / size), initial=0) < 1e-13
        assert np.nanmax(np.abs(one[1] - many[1][0]), initial=0) < 1e-13


def check_tensor(entries):
    matrix = np.array(entries).reshape(3, 3)
    matrix = np.triu(matrix) + np.triu(matrix, 1).T
    tensor = tried(lambda: ph.InertiaTensor(matrix))
    with np.errstate(all="ignore"), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        moments, axes = ph.inertia.principal_axes(np.array([matrix, matrix]))[:2]
    assert np.array_equal(moments[0], moments[1], equal_nan=True) and np.array_equal(axes[0], axes[1], equal_nan=True)
    if tensor is not None:
        assert np.array_equal(np.maximum(moments[0], 0), tensor.moments)


def check_scene(moments, omega, times):
    scene = tried(lambda: ph.Scene(inertia=moments, omega=omega, times=times))
    motion = scene and tried(lambda: ph.solve(scene, 1e-6, max_steps=1000))
    if motion is None:
        return
    many = tried(lambda: ph.solve_many([scene] * 2, accuracy=1e-6, max_steps=1000))
    assert many is not None
    for k in range(2):
        assert same((motion.omega, motion.attitude), (many.omega[k], many.attitude[k]))


def check_lanes(moments, omega, times):
    scene = tried(lambda: ph.Scene(inertia=moments, omega=omega, times=np.clip(times, -5, 5)))
    motion = scene and tried(lambda: ph.solve(scene, rtol=1e-6, method="rk45", max_steps=2000))
    if motion is None or motion.status != "finished":
        return
    many = ph.solve_many([scene] * 9, rtol=1e-6, method="rk45", max_steps=2000)
    assert same((motion.omega, motion.attitude), (many.omega[8], many.attitude[8]))


def check_mesh(vertices, faces):
    tried(lambda: ph.mesh.report(np.reshape(vertices[:len(vertices) // 3 * 3], (-1, 3)), np.reshape(faces, (-1, 3))))


def check_rotation(quat, angles):
    turn = tried(lambda: ph.Rotation(quat))
    if turn is not None:
        assert same([turn.as_matrix()], [ph.Rotation([quat] * 3).as_matrix()[2]])
    tried(lambda: ph.Rotation.from_euler("ZXZ", angles).as_euler("ZXZ"))
    tried(lambda: ph.Rotation.from_rotvec(angles).as_quat())


INDEX = st.one_of(st.integers(0, 5), st.integers(-2**63, 2**63 - 1))
CHECKS = {
    "free motion": (check_free, (MOMENTS, VECTOR, TIMES)), "tensors": (check_tensor, (st.tuples(*[MIXED] * 9),)),
    "scenes": (check_scene, (MOMENTS, VECTOR, TIMES)), "lanes": (check_lanes, (MOMENTS, VECTOR, TIMES)),
    "meshes": (check_mesh, (st.lists(MIXED, min_size=3, max_size=18), st.lists(INDEX, min_size=3, max_size=24).map(
        lambda faces: faces[:len(faces) // 3 * 3]))),
    "rotations": (check_rotation, (st.tuples(*[MIXED] * 4), VECTOR)),
}


def run_check(name, profile):
    check, strategies = CHECKS[name]

    @profile
    @given(st.tuples(*strategies))
    def one(values):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")   # rows that are NaN because their input is
            check(*values)

    one()


@pytest.mark.parametrize("name", CHECKS)
def test_random_doubles(name):
    run_check(name, QUICK)


@pytest.mark.long
@pytest.mark.parametrize("name", CHECKS)
def test_many_random_doubles(name):
    run_check(name, LONG)


def test_the_target_of_make_fuzz_finds_its_seeds(monkeypatch, capsys):
    pytest.importorskip("trimesh")
    monkeypatch.setitem(sys.modules, "atheris", types.ModuleType("atheris"))
    monkeypatch.setattr(sys, "path", [*sys.path])
    target = pathlib.Path(__file__).parents[2] / "fuzz/files.py"
    monkeypatch.setattr(sys, "argv", [str(target)])
    runpy.run_path(str(target), run_name="__main__")
    assert capsys.readouterr().out.split() == list(SEEDS)
    script = (target.parents[2] / ".ci/fuzz").read_text(encoding="utf-8")
    assert "python tests/fuzz/files.py);" in script
