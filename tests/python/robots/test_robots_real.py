"""Robot descriptions as people write them: frames, placeholders, packages, includes, meshes, and XML that ROS takes."""

import json
import time

import numpy as np
import pytest
from test_robots import CORNERS, SIDES, call, judged, sdf, stl, tensor

import polhode as ph
from polhode._xml import parse_bytes
from polhode.inertia import robots
from polhode.inertia.evidence import Geometry, single
from polhode.inertia.robots.causes import Candidate, Known, choose, tally
from polhode.inertia.robots.meshes import convex_hull
from polhode.inertia.robots.paths import Search

BLOCK = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
GOOD = f'<mass value="12"/>{tensor(BLOCK.inertia.matrix)}'
ZERO = '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>'


@pytest.fixture
def write(tmp_path):
    def put(name, text):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return tmp_path / name
    return put


def link(inertial, geometry="", name="a", kind="visual"):
    shown = f"<{kind}><geometry>{geometry}</geometry></{kind}>" if geometry else ""
    return f'<link name="{name}"><inertial>{inertial}</inertial>{shown}</link>'


def robot(*links):
    return f'<robot name="r">{"".join(links)}</robot>'


def findings(file, name="a"):
    _, links = judged(file)
    return [(f["level"], f["code"], f["cause"]) for f in links[name]["findings"]]


def test_a_frame_without_mass_is_a_remark_and_costs_no_other_link(write):
    file = write("r.urdf", robot(link(f'<mass value="0"/>{ZERO}', name="tool0"),
                                 link(GOOD, '<box size="0.2 0.4 0.6"/>', "arm")))
    status, links = judged(file)
    assert status == 0 and links["arm"]["verdict"].startswith("fine")
    (finding,) = links["tool0"]["findings"]
    assert finding["level"] == "remark" and finding["code"] == "PI201" and finding["text"] == "massless: a frame"


@pytest.mark.parametrize("bad", ['<mass value="heavy"/>', '<mass value="1"/><inertia ixx="1"/>', '<mass value="${m}"/>',
                                 f'<origin xyz="0 0"/><mass value="1"/>{ZERO}'])
def test_a_bad_attribute_is_that_links_verdict(write, bad):
    file = write("r.urdf", robot(link(bad, name="bad"), link(GOOD, '<box size="0.2 0.4 0.6"/>', "arm")))
    status, links = judged(file)
    assert status == 1 and links["arm"]["verdict"].startswith("fine")
    (finding,) = links["bad"]["findings"]
    assert (finding["level"], finding["code"], finding["line"]) == ("error", "PI002", 1)


def test_bad_geometry_is_a_note(write):
    status, links = judged(write("r.urdf", robot(link(GOOD, '<box size="0.2 x 0.6"/>'))))
    assert status == 0 and "must be numbers" in links["a"]["notes"][0]


@pytest.mark.parametrize("mass, matrix, geometry, code, cause", [
    (0, np.eye(3), "", "PI003", "massless"),
    (-1, BLOCK.inertia.matrix, "", "PI003", "unknown"),
    (1, np.zeros((3, 3)), "", "PI202", "placeholder"),
    (1, np.diag([1e-20, 2e-20, -1e-20]), "", "PI202", "placeholder"),        # rounding of a program, not a sign
    (1, np.eye(3), '<box size="0.1 0.1 0.2"/>', "PI203", "placeholder"),
    (0.1, 1e-4 * np.ones((3, 3)), '<box size="0.1 0.1 0.2"/>', "PI005", "placeholder"),
    (1, np.diag([0.1, 0.1, 0.2]), '<box size="0.1 0.1 0.2"/>', "PI203", "placeholder"),
    (2.5, np.diag([0.145833, 0.145833, 0.125]), '<cylinder radius="0.1" length="0.1"/>', "PI203", "placeholder"),
    (0.1, np.diag([1.0, 1.0, 0.0]), '<box size="0.1 0.1 0.2"/>', "PI203", "placeholder"),
    (0.1, np.diag([0.001, 0.001, 0.01]), "", "PI005", "placeholder"),      # round, and no decimal point
    (1, 12 * ph.shapes.box(1, (0.05, 0.07, 0.11)).inertia.matrix, '<box size="0.1 0.14 0.22"/>', "PI102", "formula"),
    (1, 4 * ph.shapes.box(1, (0.05, 0.07, 0.11)).inertia.matrix, '<box size="0.1 0.14 0.22"/>', "PI102", "formula"),
    (2.2, np.diag([0.00311, 0.00412, 0.00517]), '<box size="0.01 0.01 0.01"/>', "PI205", "marker"),
])
def test_what_nobody_computed_is_told_before_units_and_decimals(write, mass, matrix, geometry, code, cause):
    found = findings(write("r.urdf", robot(link(f'<mass value="{mass}"/>{tensor(matrix)}', geometry))))
    assert [(c, why) for _, c, why in found][:1] == [(code, cause)]


def test_collision_alone_needs_more(write):
    """The centre of a motor lies outside of the shape that collides: nothing is wrong with that."""
    body = f'<origin xyz="-0.02 0.1 0"/><mass value="2"/>{tensor(np.diag((0.0041, 0.0088, 0.0061)))}'
    shape = '<cylinder radius="0.05" length="0.04"/>'
    assert findings(write("a.urdf", robot(link(body, shape, kind="collision")))) == []
    assert "PI103" in {code for _, code, _ in findings(write("b.urdf", robot(link(body, shape))))}


def test_a_density_is_a_cause(write):
    """Mass and tensor both a thousand times too large: the shape agrees, the ratio of mass to volume does not."""
    heavy = f'<mass value="48000"/>{tensor(4000 * BLOCK.inertia.matrix)}'
    file = write("a.urdf", robot(link(heavy, '<box size="0.2 0.4 0.6"/>')))
    (finding,) = judged(file)[1]["a"]["findings"]
    assert (finding["level"], finding["code"], finding["cause"]) == ("error", "PI006", "density")
    assert finding["mass"] == pytest.approx(48)
    light = f'<mass value="0.01"/>{tensor(BLOCK.inertia.matrix / 1200)}'
    toy = write("b.urdf", robot(link(light, '<box size="0.2 0.4 0.6"/>')))
    assert findings(toy) == [("remark", "PI206", "density")]


def test_a_mass_raised_to_a_floor_is_told(write):
    small = ph.shapes.box(2e-4, (0.005, 0.007, 0.001))
    body = f'<mass value="0.001"/>{tensor(small.inertia.matrix)}'
    (finding,) = judged(write("a.urdf", robot(link(body, '<box size="0.01 0.014 0.002"/>'))))[1]["a"]["findings"]
    assert finding["cause"] == "floor" and finding["mass"] == pytest.approx(2e-4, rel=1e-6)
    foam = ph.shapes.box(2e-5, (0.005, 0.007, 0.001))   # 71 kg/m^3: no part of a robot, so no mass is proposed
    body = f'<mass value="0.001"/>{tensor(foam.inertia.matrix)}'
    (finding,) = judged(write("b.urdf", robot(link(body, '<box size="0.01 0.014 0.002"/>'))))[1]["a"]["findings"]
    assert finding["mass"] == 0.001 and "raised to 0.001 kg" in finding["advice"]


def test_a_centre_off_on_purpose_is_not_in_millimetres(write):
    """The tensor is that of the box, the centre was set aside: centre/1000 explains nothing by itself."""
    body = f'<origin xyz="0.05 0 0"/>{GOOD}'
    assert findings(write("a.urdf", robot(link(body, '<box size="0.2 0.4 0.6"/>')))) == []


def test_two_causes_that_explain_alike_are_not_named(write):
    """Of a flat triangle a sign and a decimal point are possible alike: without geometry nothing is named."""
    body = f'<mass value="1"/>{tensor(np.array([[5.6, 0, -5.7], [0, 5.2, 0], [-5.7, 0, 2.1]]) * 1e-2)}'
    (finding,) = judged(write("a.urdf", robot(link(body))))[1]["a"]["findings"]
    assert (finding["code"], finding["cause"]) == ("PI004", "unknown")


def test_links_of_a_file_support_each_other(write):
    """A whole robot with its masses in grams."""
    rng = np.random.default_rng(3)
    links = []
    for i in range(4):
        half = rng.uniform(0.03, 0.4, 3)
        body = ph.shapes.box(1000 * 8 * half.prod(), half)
        links.append(link(f'<mass value="{body.mass * 1000}"/>{tensor(body.inertia.matrix)}',
                          f'<box size="{" ".join(map(str, 2 * half))}"/>', f"l{i}"))
    _, found = judged(write("a.urdf", robot(*links)))
    assert [f["cause"] for each in found.values() for f in each["findings"]] == ["units"] * 4
    assert all("grams" in f["advice"] for each in found.values() for f in each["findings"])


def test_a_cause_must_beat_the_next_one_of_another_kind():
    """By 3 nats; less where other links have the same fault."""
    def candidate(kind, text, total, mass):
        return Candidate(kind, text, total, 50.0, single(mass, np.zeros(3), np.eye(3)))

    known = Known(Geometry(), "body")
    units, decimal = candidate("units", "the mass is in grams", 0.0, 1.0), candidate("decimal", "a point", 2.9, 2.0)
    assert choose([units], known, {}) is units and choose([], known, {}) is None
    assert choose([units, decimal], known, {}) is None
    assert choose([units, decimal._replace(total=3.1)], known, {}) is units
    assert choose([units, decimal._replace(body=units.body)], known, {}) is units      # one outcome, two names
    assert choose([units, decimal], known, tally([[units]] * 4 + [[decimal]])) is units
    assert choose([units, decimal], known, tally([[units], *[[decimal]] * 40])).kind == "decimal"


def test_copied_numbers_are_placeholders(write):
    matrix = np.diag((0.049, 0.0465, 0.00417))
    sizes = ("0.9 0.05 0.8", "0.1 0.2 0.3", "0.05 0.06 0.2")
    file = write("a.urdf", robot(*(link(f'<mass value="1.31"/>{tensor(matrix)}', f'<box size="{size}"/>', f"l{i}")
                                   for i, size in enumerate(sizes))))
    causes = [f["cause"] for each in judged(file)[1].values() for f in each["findings"]]
    assert causes and set(causes) == {"placeholder"}


# ---- XML

WITHIN = "<link name='a'><inertial>" + GOOD + "</inertial></link>"


@pytest.mark.parametrize("text", [
    f"<robot name='r'><sensor:camera x='1'/>{WITHIN}</robot>",                        # a prefix that is not declared
    f"<!-- by hand --><?xml version='1.0'?><robot name='r'>{WITHIN}</robot>",         # text before the declaration
    f"\n\n<?xml version='1.0' encoding='utf-8'?><robot name='r'>{WITHIN}</robot>",
    f"<robot name='r' xmlns='http://www.ros.org'>{WITHIN}</robot>",
    f"<robot name='r'><!-- a -- b -->{WITHIN}</robot>",
    f"<robot name='r'>{WITHIN}</robot><robot name='s'/>",
    f"?xml version='1.0'?>\n<robot name='r'>{WITHIN}</robot>",
    f"<robot name='r'>{WITHIN}</robot>\x1a\n",
    f"<robot name='r'><xacro:property name='a' value='1'/>{WITHIN}</robot>",
])
def test_xml_as_ros_takes_it(write, text):
    (found,) = robots.read(write("a.urdf", text)).links
    assert found.mass == 12


def test_lines_and_bytes_are_those_of_the_file():
    data = b"<!-- one\n two -->\n<?xml version='1.0'?>\n<robot>\n <!-- a -- b -->\n <link name='x'/></robot>"
    node = parse_bytes(data, "r").child("link")
    assert node.line == 6 and data[node.start:].startswith(b"<link")


def test_many_comments_take_no_longer_each():
    """Ten thousand comments before the root: read in a second, where an unwise pattern takes forever."""
    start = time.process_time()
    assert parse_bytes(b"<!-- a -->\n " * 10_000 + b"<robot/>", "r").line == 10_001
    assert time.process_time() - start < 5


@pytest.mark.parametrize("text", ["<!-- x --><!DOCTYPE robot [<!ENTITY a 'b'>]><robot/>",
                                  "<?xml version='1.0'?><!-- a -- b --><!DOCTYPE robot [<!ENTITY a 'b'>]><robot/>"])
def test_lenience_lets_no_entity_in(text):
    with pytest.raises(ph.InvalidInput, match="entities"):
        parse_bytes(text.encode(), "r")


# ---- places

def test_packages_by_name_by_folder_and_by_environment(write, tmp_path, monkeypatch):
    body = ph.shapes.tetrahedron(3.0, CORNERS)
    write("elsewhere/meshes/part.stl", stl(CORNERS, SIDES))
    write("roots/arm/meshes/part.stl", stl(CORNERS, SIDES))
    inertial = f'<origin xyz="{" ".join(map(str, body.com))}"/><mass value="3"/>{tensor(body.inertia.matrix)}'
    file = write("deep/er/urdf/a.urdf", robot(link(inertial, '<mesh filename="package://arm/meshes/part.stl"/>')))

    def misfit(*options):
        return json.loads(call("inertia", file, "--json", *options).stdout)["links"][0]["misfit"]

    assert misfit() is None
    assert misfit("--package", f"arm={tmp_path / 'elsewhere'}") < 1e-9
    assert misfit("--path", tmp_path / "roots") < 1e-9
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "roots"))
    assert misfit() < 1e-9


def test_files_outside_of_the_folders_are_not_opened(write, tmp_path):
    write("secret/part.stl", stl(CORNERS, SIDES))
    write("secret/m.sdf", sdf("<mass>1</mass>", "<empty/>"))
    outside = "../../../../secret/part.stl"
    file = write("one/two/three/four/a.urdf", robot(link(GOOD, f'<mesh filename="{outside}"/>')))
    note = robots.read(file).links[0].notes[0]
    assert "outside" in note and "--path" in note
    near = robots.read(file, search=Search.of(allowed=[tmp_path])).links[0]
    assert near.visual.parts
    including = write("one/two/three/four/a.sdf", "<sdf version='1.9'><include><uri>../../../../secret/m.sdf</uri>"
                      "</include>"
                      "<model name='m'><link name='a'/></model></sdf>")
    assert "outside" in robots.read(including).notes[0]
    (tmp_path / "one/two/three/four/link.stl").symlink_to(tmp_path / "secret/part.stl")
    linked = write("one/two/three/four/b.urdf", robot(link(GOOD, '<mesh filename="link.stl"/>')))
    assert "outside" in robots.read(linked).links[0].notes[0]


# ---- shapes and meshes

@pytest.mark.parametrize(("shape", "volume", "half"), [
    ('<box size="0.2 0.4 0.6"/>', 0.2 * 0.4 * 0.6, (0.1, 0.2, 0.3)),
    ('<sphere radius="0.3"/>', 4 / 3 * np.pi * 0.3**3, (0.3, 0.3, 0.3)),
    ('<cylinder radius="0.3" length="0.8"/>', np.pi * 0.3**2 * 0.8, (0.3, 0.3, 0.4)),
    ('<capsule radius="0.3" length="0.8"/>', np.pi * 0.3**2 * 0.8 + 4 / 3 * np.pi * 0.3**3, (0.3, 0.3, 0.7)),
])
def test_shapes_have_their_volume_and_their_box(write, shape, volume, half):
    (found,) = robots.read(write("a.urdf", robot(link(GOOD, shape)))).links
    assert found.geometry().volume == pytest.approx(volume, rel=1e-14)
    np.testing.assert_allclose(found.geometry().box, [np.negative(half), half])


@pytest.mark.parametrize("angles", [(0, 0, 0), (0, 0, np.pi / 2), (0.3, -0.7, 1.9)])
def test_the_box_of_a_mesh_is_that_of_its_corners(write, angles):
    write("part.stl", stl(CORNERS, SIDES))
    scale, place = np.array([2.0, 0.5, -3.0]), np.array([0.4, 0.5, -0.6])
    text = robot(link(GOOD, '<mesh filename="part.stl" scale="2 0.5 -3"/>')).replace(
        "<visual>", f'<visual><origin xyz="0.4 0.5 -0.6" rpy="{" ".join(map(str, angles))}"/>')
    (found,) = robots.read(write("a.urdf", text)).links
    corners = ph.Rotation.from_euler("xyz", angles).apply(CORNERS * scale) + place
    np.testing.assert_allclose(found.geometry().box, [corners.min(axis=0), corners.max(axis=0)], atol=1e-12)


def test_one_line_tells_of_all_meshes_that_are_not_there(write):
    gone, here = '<mesh filename="{}.stl"/>', '<box size="0.2 0.4 0.6"/>'
    file = write("a.urdf", robot(link(GOOD, gone.format("one"), "a"), link(GOOD, here, "b"),
                                 link(GOOD, gone.format("two"), "c")))
    (report,) = robots.check(file)
    (line,) = [note for note in report.notes if "meshes" in note]
    assert line.startswith("2 meshes not found, in 2 links; the first: ") and "'one.stl'" in line



def closed_off(corners, sides):
    rows = [f"{len(corners)} {len(sides)} 0", *(" ".join(map(str, c)) for c in corners.tolist()),
            *("3 " + " ".join(map(str, s)) for s in sides.tolist())]
    return "OFF\n" + "\n".join(rows) + "\n"


DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="12">{corners}</float_array><technique_common>
<accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="{count}"><input semantic="VERTEX" source="#v" offset="0"/><p>{sides}</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><matrix>1 0 0 10 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""


def dae(corners, sides):
    return DAE.format(corners=" ".join(map(str, (1000 * corners).ravel())), count=len(sides),
                      sides=" ".join(map(str, sides.ravel())))


def test_collada_in_its_unit_and_place_off_and_their_lies(write):
    pytest.importorskip("trimesh")
    pytest.importorskip("collada")
    vertices, faces = ph.mesh.read(write("a.dae", dae(CORNERS, SIDES)))
    body = ph.MassProperties.from_mesh(vertices, faces, density=1)
    expected = ph.shapes.tetrahedron(CORNERS[1, 0] * CORNERS[2, 1] * CORNERS[3, 2] / 6, CORNERS)
    np.testing.assert_allclose(body.com, np.array(expected.com) + (0.01, 0, 0), rtol=1e-6)
    np.testing.assert_allclose(body.inertia.matrix, expected.inertia.matrix, rtol=1e-6, atol=1e-12)
    vertices, faces = ph.mesh.read(write("a.off", closed_off(CORNERS, SIDES)))
    assert len(faces) == 4 and np.array_equal(vertices[faces], CORNERS[SIDES])
    for text in (DAE.replace("0.001", "-1"), "<!DOCTYPE a [<!ENTITY b 'c'>]><COLLADA/>", "no collada"):
        with pytest.raises(ph.InvalidInput):
            ph.mesh.read(write("b.dae", text))
    with pytest.raises(ph.InvalidInput, match="claims 99"):
        ph.mesh.read(write("b.off", "OFF\n99999999 4 0\n"))


def test_an_open_mesh_is_bounded_by_its_hull(write):
    pytest.importorskip("scipy")
    write("open.stl", stl(CORNERS, SIDES[:3]))
    body = ph.shapes.tetrahedron(3.0, CORNERS)
    inertial = f'<origin xyz="{" ".join(map(str, body.com))}"/><mass value="3"/>{tensor(body.inertia.matrix)}'
    file = write("a.urdf", robot(link(inertial, '<mesh filename="open.stl"/>')))
    status, links = judged(file)
    assert status == 0 and "convex hull" in links["a"]["notes"][0] and links["a"]["misfit"] < 1e-9
    turned = robot(link(inertial.replace(tensor(body.inertia.matrix),
                                         tensor(np.where(np.eye(3) > 0, 1, -1) * body.inertia.matrix)),
                        '<mesh filename="open.stl"/>'))
    (finding,) = judged(write("b.urdf", turned))[1]["a"]["findings"]
    assert (finding["level"], finding["cause"]) == ("warning", "sign")


@pytest.mark.parametrize("count", [20, 5000])
def test_the_hull_has_the_moments_of_its_triangles(count):
    """Against the integral over the hull's faces, wound outward; points within it change nothing."""
    spatial = pytest.importorskip("scipy.spatial")
    points = np.random.default_rng(count).normal(size=(count, 3)) ** 3 * (1, 2, 3) + (4, 5, 6)
    moments, corners = convex_hull(points)
    hull = spatial.ConvexHull(points)
    faces = hull.simplices.astype(np.int64)
    a, b, c = (points[faces[:, i]] for i in range(3))
    out = np.einsum("ni,ni->n", np.cross(b - a, c - a), hull.equations[:, :3]) < 0
    faces[out] = faces[out][:, ::-1]
    body = ph.MassProperties.from_mesh(points, faces, density=1)
    assert moments.volume == pytest.approx(body.mass) and moments.centre == pytest.approx(np.array(body.com))
    np.testing.assert_allclose(np.trace(moments.second) * np.eye(3) - moments.second, body.inertia.matrix, rtol=1e-9,
                               atol=1e-9 * body.inertia.moments[2])
    assert len(corners) == len(hull.vertices)


def test_each_mesh_is_read_once(write, monkeypatch):
    write("part.stl", stl(CORNERS, SIDES))
    shown = '<mesh filename="part.stl" scale="{0} {0} {0}"/>'
    parts = "".join(f"<{kind}><geometry>{shown.format(scale)}</geometry></{kind}>"
                    for kind, scale in (("visual", 1), ("collision", 1), ("visual", 0.5)))
    calls = []
    true = ph.mesh.read
    monkeypatch.setattr("polhode.mesh.read", lambda path: calls.append(path) or true(path))
    (found,) = robots.read(write("a.urdf", robot(f'<link name="a"><inertial>{GOOD}</inertial>{parts}</link>'))).links
    assert len(calls) == 1 and len(found.visual.parts) == 2
    full, half = (part.solid for part in found.visual.parts)
    assert full.mass == pytest.approx(8 * half.mass) and half.com == pytest.approx(np.array(full.com) / 2)
    np.testing.assert_allclose(full.inertia.matrix, 32 * half.inertia.matrix)
    np.testing.assert_allclose(full.inertia.matrix / full.mass, ph.shapes.tetrahedron(1, CORNERS).inertia.matrix)


def test_a_stretched_and_turned_mesh_has_the_moments_of_its_triangles(write):
    """Moments of a mesh are scaled, not integrated again: against the integral over the scaled triangles."""
    write("part.stl", stl(CORNERS, SIDES))
    scale, angles, place = np.array([2.0, -0.5, 3.0]), (0.3, -0.7, 1.9), np.array([0.4, 0.5, -0.6])
    text = robot(link(GOOD, f'<mesh filename="part.stl" scale="{" ".join(map(str, scale))}"/>'))
    text = text.replace("<visual>", f'<visual><origin xyz="{" ".join(map(str, place))}" '
                        f'rpy="{" ".join(map(str, angles))}"/>')
    (found,) = robots.read(write("a.urdf", text)).links
    turn = ph.Rotation.from_euler("xyz", angles).as_matrix()
    body = ph.MassProperties.from_mesh((CORNERS * scale) @ turn.T + place, SIDES[:, ::-1], density=1)
    solid = found.visual.parts[0].solid
    assert solid.mass == pytest.approx(body.mass) and solid.com == pytest.approx(np.array(body.com))
    np.testing.assert_allclose(solid.inertia.matrix, body.inertia.matrix, rtol=1e-9, atol=1e-12)
