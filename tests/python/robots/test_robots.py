"""Robot descriptions: what is read, what is found, what is refused, and the run that the docs show."""

import json
import pathlib
import re

import numpy as np
import pytest
from typer.testing import CliRunner

import polhode as ph
from polhode.cli.app import app
from polhode.inertia import robots

ROOT = pathlib.Path(__file__).parents[3]
BROKEN = "examples/robots/broken.urdf"


def call(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def judged(file):
    result = call("inertia", file, "--json")
    assert result.exit_code in (0, 1), result.output
    return result.exit_code, {link["name"]: link for link in json.loads(result.stdout)["links"]}


@pytest.fixture
def write(tmp_path):
    def put(name, text):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
        return tmp_path / name
    return put


def urdf(inertial, geometry='<box size="0.2 0.4 0.6"/>', name="a"):
    return (f'<robot name="r"><link name="{name}"><inertial>{inertial}</inertial>'
            f'<visual><geometry>{geometry}</geometry></visual></link></robot>')


def tensor(matrix):
    m = np.asarray(matrix)
    return "<inertia " + " ".join(f'i{a}{b}="{float(m["xyz".index(a), "xyz".index(b)])!r}"'
                                  for a, b in ("xx", "xy", "xz", "yy", "yz", "zz")) + "/>"


def test_the_docs_show_the_run_of_the_broken_robot(monkeypatch):
    monkeypatch.chdir(ROOT)
    result = call("inertia", BROKEN)
    shown = re.search(rf"```text\n\$ polhode inertia {re.escape(BROKEN)}\n(.*?)```",
                      (ROOT / "docs/diagnosis.md").read_text(), flags=re.S)[1]
    assert [line.rstrip() for line in result.stdout.splitlines()] == shown.splitlines()
    assert result.exit_code == 1


def test_six_links_six_faults():
    status, links = judged(ROOT / BROKEN)
    causes = {name: [finding["cause"] for finding in link["findings"]] for name, link in links.items()}
    assert status == 1
    assert causes == {"base": ["units"], "shoulder": ["order"], "upper_arm": ["sign"], "forearm": ["point"],
                      "wrist": ["decimal"], "gripper": ["axes"]}
    for link in links.values():
        assert ph.InertiaTensor(link["findings"][0]["matrix"])


def test_a_sound_robot_is_fine(write):
    block = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    file = write("r.urdf", urdf(f'<mass value="12"/>{tensor(block.inertia.matrix)}'))
    status, links = judged(file)
    assert status == 0 and links["a"]["verdict"].startswith("fine") and links["a"]["misfit"] < 1e-12
    assert links["a"]["moments"] == pytest.approx(list(block.inertia.moments))
    assert "1 of 1 links judged, 0 wrong" in call("inertia", file).stdout


def test_urdf_rotations_are_about_fixed_axes(write):
    """The inertial frame is turned against the link's: the geometry has to be seen from there."""
    turn = ph.Rotation.from_euler("xyz", (0.3, -0.7, 1.9))
    body = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    text = urdf(f'<origin xyz="0.1 0.2 0.3" rpy="0.3 -0.7 1.9"/><mass value="12"/>{tensor(body.inertia.matrix)}')
    placed = text.replace("<geometry>", '<origin xyz="0.1 0.2 0.3" rpy="0.3 -0.7 1.9"/><geometry>')
    status, links = judged(write("a.urdf", placed))
    assert status == 0 and links["a"]["misfit"] < 1e-9
    doubled = placed.replace(tensor(body.inertia.matrix), tensor(body.inertia.rotated(turn).matrix))
    status, links = judged(write("b.urdf", doubled))
    (finding,) = links["a"]["findings"]
    assert finding["cause"] == "axes" and "superfluous" in finding["advice"]
    np.testing.assert_allclose(finding["matrix"], body.inertia.matrix, atol=1e-12)


def stl(vertices, faces):
    lines = ["solid part"]
    for face in faces:
        lines += ["facet normal 0 0 0", "outer loop",
                  *(f"vertex {x!r} {y!r} {z!r}" for x, y, z in vertices[face].tolist()),
                  "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid part", ""])


CORNERS = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.2, 0], [0, 0, 0.4]])
SIDES = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])


@pytest.mark.parametrize("uri", ["meshes/part.stl", "package://arm/meshes/part.stl", "model://arm/meshes/part.stl"])
def test_meshes_are_found_and_compared(write, uri):
    body = ph.shapes.tetrahedron(3.0, CORNERS)
    write("arm/meshes/part.stl", stl(CORNERS, SIDES))
    inertial = f'<origin xyz="{" ".join(map(str, body.com))}"/><mass value="3"/>'
    beside = f"{'../' if ':' not in uri else ''}{uri}"
    good = write("arm/urdf/good.urdf", urdf(inertial + tensor(body.inertia.matrix), f'<mesh filename="{beside}"/>'))
    status, links = judged(good)
    assert status == 0 and links["a"]["misfit"] < 1e-12 and not links["a"]["notes"]
    turned = np.where(np.eye(3) > 0, 1, -1) * body.inertia.matrix
    bad = write("arm/urdf/bad.urdf", urdf(inertial + tensor(turned), f'<mesh filename="{beside}"/>'))
    status, links = judged(bad)
    assert status == 1 and links["a"]["findings"][0]["cause"] == "sign"


def test_a_mesh_in_millimetres_is_told(write):
    body = ph.shapes.tetrahedron(3.0, CORNERS)
    write("part.stl", stl(1000 * CORNERS, SIDES))
    inertial = f'<origin xyz="{" ".join(map(str, body.com))}"/><mass value="3"/>' + tensor(body.inertia.matrix)
    status, links = judged(write("a.urdf", urdf(inertial, '<mesh filename="part.stl"/>')))
    assert links["a"]["findings"][0]["cause"] == "units" and "scale 0.001" in links["a"]["findings"][0]["advice"]
    status, links = judged(write("b.urdf", urdf(inertial, '<mesh filename="part.stl" scale="0.001 0.001 0.001"/>')))
    assert status == 0 and links["a"]["misfit"] < 1e-9


def test_what_cannot_be_compared_is_named(write):
    body = f'<mass value="12"/>{tensor(ph.shapes.box(12.0, (0.1, 0.2, 0.3)).inertia.matrix)}'
    status, links = judged(write("a.urdf", urdf(body, '<mesh filename="package://gone/part.stl"/>')))
    assert status == 0 and "not found" in links["a"]["notes"][0]
    (link,) = robots.read(write("a.urdf", urdf(body, '<mesh filename="package://gone/part.stl"/>'))).links
    (other,) = robots.read(write("d.urdf", urdf(body, '<box size="0 1 1"/>'))).links
    assert not link.visual.whole and not other.visual.whole   # what was not read may reach further
    write("open.stl", stl(CORNERS, SIDES[:3]))
    status, links = judged(write("b.urdf", urdf(body, '<mesh filename="open.stl"/>')))
    assert "not closed" in links["a"]["notes"][0]
    assert "no <inertial>" in call("inertia", write("c.urdf", '<robot name="r"><link name="tool0"/></robot>')).stdout


MJCF = """<mujoco model="m"><compiler angle="radian" eulerseq="XYZ" {compiler}/>
<default><geom density="2000"/><default class="seen"><geom contype="0" conaffinity="0" type="box"/></default></default>
<asset><mesh name="part" file="part.stl" scale="0.001 0.001 0.001"/></asset>
<worldbody><geom type="plane" size="1 1 1"/>{bodies}</worldbody></mujoco>"""


def mjcf(bodies, compiler=""):
    return MJCF.format(bodies=bodies, compiler=compiler)


def moments(axes):
    return " ".join(map(repr, axes.tolist()))


def test_mjcf_orientations_agree(write):
    """One rotation in MuJoCo's five ways: quat with the scalar first, euler, axisangle, xyaxes, zaxis."""
    quarter = np.pi / 2
    block = ph.shapes.box(12.0, (0.1, 0.2, 0.3)).inertia.matrix.diagonal()
    turned = block[[0, 2, 1]]   # a quarter turn about x
    ways = ['quat="0.70710678118654757 0.70710678118654757 0 0"', f'euler="{quarter} 0 0"',
            f'axisangle="2 0 0 {quarter}"',
            'xyaxes="1 0 0 0 0 2"', 'zaxis="0 -1 0"']
    bodies = "".join(f'<body name="{i}" childclass="seen"><inertial pos="0 0 0" {way} mass="12" '
                     f'diaginertia="{moments(turned)}"/>'
                     '<geom size="0.1 0.2 0.3"/></body>' for i, way in enumerate(ways))
    status, links = judged(write("a.xml", mjcf(bodies)))
    assert status == 0 and len(links) == 5 and all(link["misfit"] < 1e-9 for link in links.values())
    both = ('<body name="b"><inertial pos="0 0 0" euler="90 0 0" mass="12" diaginertia="%s"/>'
            '<geom type="box" size="0.1 0.2 0.3"/></body>')
    degrees = mjcf(both % moments(turned)).replace('angle="radian"', "")
    assert judged(write("b.xml", degrees))[1]["b"]["misfit"] < 1e-9


@pytest.mark.parametrize("sequence", ["xyz", "zyx", "XYZ", "ZYX", "xYz", "ZxY"])
def test_mjcf_euler_sequences(write, sequence):
    """MuJoCo's lower case turns with the body: the reverse of SciPy's."""
    angles = (0.3, -0.7, 1.1)
    axes = {"x": (1, 0, 0), "y": (0, 1, 0), "z": (0, 0, 1)}
    turn = ph.Rotation.from_quat((0, 0, 0, 1))
    for letter, angle in zip(sequence, angles):
        single = ph.Rotation.from_rotvec(np.array(axes[letter.lower()]) * angle)
        turn = turn * single if letter.islower() else single * turn
    quat = np.roll(turn.as_quat(), 1)
    block = ph.shapes.box(12.0, (0.1, 0.2, 0.3)).inertia.matrix.diagonal()
    text = mjcf(f'<body name="b"><inertial pos="0 0 0" euler="{" ".join(map(str, angles))}" mass="12" '
                f'diaginertia="{moments(block)}"/>'
                f'<geom type="box" size="0.1 0.2 0.3" quat="{" ".join(map(str, quat))}"/></body>')
    text = text.replace("XYZ", sequence)
    assert judged(write("a.xml", text))[1]["b"]["misfit"] < 1e-9


def test_mjcf_masses_from_geoms(write):
    status, links = judged(write("a.xml", mjcf('<body name="b"><geom type="box" size="0.1 0.2 0.3"/></body>')))
    expected = ph.shapes.box(2000 * 0.2 * 0.4 * 0.6, (0.1, 0.2, 0.3))
    assert links["b"]["mass"] == pytest.approx(expected.mass)
    assert links["b"]["moments"] == pytest.approx(expected.inertia.moments)
    text = mjcf('<body name="b"><inertial pos="0 0 0" mass="1" diaginertia="1 1 9"/><geom size="0.1" mass="3"/></body>',
                'inertiafromgeom="true"')
    status, links = judged(write("b.xml", text))
    assert status == 0 and links["b"]["mass"] == pytest.approx(3) and "ignores the given" in links["b"]["notes"][0]
    end = mjcf('<body name="b"><geom type="capsule" fromto="0 0 1 1 0 1" size="0.1"/></body>')
    capsule = ph.shapes.capsule(1.0, 0.1, 1.0)
    status, links = judged(write("c.xml", end))
    assert links["b"]["com"] == pytest.approx([0.5, 0, 1])
    assert links["b"]["matrix"][0][0] / links["b"]["mass"] == pytest.approx(capsule.inertia.moments[0])


def test_mjcf_settings_that_hide_faults_are_named(write):
    text = mjcf('<body name="b"><inertial pos="0 0 0" mass="0.5" diaginertia="1 1 9"/></body>',
                'balanceinertia="true" boundmass="1" boundinertia="2" settotalmass="7"')
    result = call("inertia", write("a.xml", text.replace("<worldbody>", '<include file="x.xml"/><worldbody>')))
    assert result.exit_code == 1
    for word in ("balanceinertia", "boundmass", "boundinertia", "settotalmass", "<include> is not read"):
        assert word in result.stdout


def test_mjcf_full_inertia_has_its_own_order(write):
    text = mjcf('<body name="b"><inertial pos="0 0 0" mass="1" fullinertia="4 5 6 0.1 0.2 0.3"/></body>')
    assert judged(write("a.xml", text))[1]["b"]["matrix"] == [[4, 0.1, 0.2], [0.1, 5, 0.3], [0.2, 0.3, 6]]


SDF = """<sdf version="1.9"><world name="w"><model name="m"><link name="a">
<inertial><pose{attributes}>{pose}</pose><mass>12</mass>
<inertia><ixx>{0}</ixx><iyy>{1}</iyy><izz>{2}</izz></inertia></inertial>
<collision name="c"><pose>0.1 0 0 0 0 0</pose><geometry><box><size>0.2 0.4 0.6</size></box></geometry></collision>
</link>
<model name="n"><link name="b"/><link name="c"><inertial auto="true"/></link></model></model></world></sdf>"""


@pytest.mark.parametrize("attributes, pose", [("", f"0.1 0 0 {np.pi / 2!r} 0 0"), (' degrees="true"', "0.1 0 0 90 0 0"),
                                              (' rotation_format="quat_xyzw"',
                                               "0.1 0 0 0.7071067811865476 0 0 0.7071067811865476")])
def test_sdf(write, attributes, pose):
    block = ph.shapes.box(12.0, (0.1, 0.2, 0.3)).inertia.matrix.diagonal()
    status, links = judged(write("a.sdf", SDF.format(*block[[0, 2, 1]].tolist(), attributes=attributes, pose=pose)))
    assert status == 0 and list(links) == ["a", "m::n::b", "m::n::c"] and links["a"]["misfit"] < 1e-9
    assert "1 kg" in links["m::n::b"]["verdict"] and "auto" in links["m::n::c"]["verdict"]
    assert judged(write("b.sdf", SDF.format(*block.tolist(), attributes=attributes, pose=pose)))[0] == 1


def test_the_repaired_centre_is_in_the_links_axes(write):
    """Of an inertial frame turned against the link's, with its centre in millimetres."""
    body = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    text = urdf(f'<origin xyz="100 200 300" rpy="0.3 -0.7 1.9"/><mass value="12"/>{tensor(body.inertia.matrix)}')
    placed = text.replace("<geometry>", '<origin xyz="0.1 0.2 0.3" rpy="0.3 -0.7 1.9"/><geometry>')
    (finding,) = judged(write("a.urdf", placed))[1]["a"]["findings"]
    assert finding["cause"] == "units"
    np.testing.assert_allclose(finding["com"], (0.1, 0.2, 0.3), rtol=1e-9)


def test_the_box_round_a_turned_part_is_seen_from_the_inertial_axes(write):
    angles, shown = (0.3, -0.7, 1.9), (1.1, 0.4, -0.6)
    text = urdf(f'<origin rpy="{" ".join(map(str, angles))}"/><mass value="12"/>{tensor(np.eye(3))}')
    text = text.replace("<geometry>", f'<origin xyz="0.1 0.2 0.3" rpy="{" ".join(map(str, shown))}"/><geometry>')
    (link,) = robots.read(write("a.urdf", text)).links
    turn = ph.Rotation.from_euler("xyz", angles).as_matrix().T @ ph.Rotation.from_euler("xyz", shown).as_matrix()
    reach = np.abs(turn) @ (0.1, 0.2, 0.3)
    place = ph.Rotation.from_euler("xyz", angles).as_matrix().T @ (0.1, 0.2, 0.3)
    np.testing.assert_allclose(link.geometry().box, [place - reach, place + reach], rtol=1e-12)


BOMB = '<!DOCTYPE robot [<!ENTITY a "aaaaaaaaaa"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]><robot name="&b;"/>'
OUTSIDE = '<!DOCTYPE robot [<!ENTITY a SYSTEM "file:///etc/hostname">]><robot name="&a;"/>'


@pytest.mark.parametrize("text, said", [
    (BOMB, "entities"), (OUTSIDE, "entities"), ('<!DOCTYPE robot SYSTEM "http://a/b.dtd"><robot/>', "document type"),
    ("<robot><link", "is no XML"), ("", "is no XML"), ("<html/>", "must have the root"),
    ("<robot/>", "<link> is missing"), ('<robot name="r"><link/></robot>', "name is missing"),
    (urdf("<inertia ixx='1'/>"), "'a'> <inertial>: <mass> is missing"),
    (urdf('<mass value="1"/>'), "<inertia> is missing"),
    (urdf('<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0"/>'), "izz is missing"),
    (urdf('<mass value="heavy"/>'), "value: must be numbers, got 'heavy'"),
    (urdf('<mass value="nan"/>'), "value: must be finite"),
    (urdf('<origin xyz="0 0"/><mass value="1"/>'), "xyz: must be 3 numbers"),
    ('<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><xacro:macro/></robot>', "xacro"),
    ("<robot>" + "<link>" * 2000 + "</link>" * 2000 + "</robot>", "nested"),
    ('<mujoco><worldbody><body name="b"><inertial pos="0 0 0" mass="1"/></body></worldbody></mujoco>',
     "diaginertia or fullinertia"),
    ('<mujoco><worldbody><body><geom size="1" quat="0 0 0 0"/></body></worldbody></mujoco>', "length zero"),
    (urdf('<mass value="1e40"/>'), "below 1e+30"), ('<mujoco><worldbody/></mujoco>', "no <body>"),
    ("<sdf/>", "<link> is missing"),
])
def test_what_is_no_robot_is_one_line(write, text, said):
    file = write("bad.urdf", text)
    result = call("inertia", file)
    assert result.exit_code == 2 and result.stdout == ""
    assert result.stderr.count("\n") == 1 and said in result.stderr and str(file) in result.stderr


def test_a_missing_file_is_one_line(tmp_path):
    result = call("inertia", tmp_path / "gone.urdf")
    assert result.exit_code == 2 and result.stderr.count("\n") == 1 and "cannot be read" in result.stderr


@pytest.mark.parametrize("value", ["nan", "inf", "1e308", "-1e308", "1e-320", "1e200"])
def test_numbers_out_of_range_are_findings(write, value):
    file = write("a.urdf", urdf('<mass value="1"/>' + tensor(np.eye(3)).replace('izz="1.0"', f'izz="{value}"')))
    result = call("inertia", file, "--json")
    assert result.exit_code == 1 and json.loads(result.stdout)["links"][0]["findings"]


def test_shapes_without_size_are_named_not_fatal(write):
    body = f'<mass value="12"/>{tensor(np.eye(3))}'
    status, links = judged(write("a.urdf", urdf(body, '<sphere radius="0"/>')))
    assert "not compared" in links["a"]["notes"][0]
    assert robots.read(write("b.urdf", urdf(body))).links[0].mass == 12


def sdf(inertial, geometry):
    return (f'<sdf version="1.9"><model name="m"><link name="a"><inertial>{inertial}</inertial>'
            f'<visual name="v"><geometry>{geometry}</geometry></visual></link></model></sdf>')


def test_meshes_of_sdf_files_are_compared(write):
    body = ph.shapes.tetrahedron(3.0, CORNERS)
    write("part.stl", stl(1000 * CORNERS, SIDES))
    m = body.inertia.matrix
    entries = "".join(f'<i{a}{b}>{float(m["xyz".index(a), "xyz".index(b)])!r}</i{a}{b}>'
                      for a, b in ("xx", "xy", "xz", "yy", "yz", "zz"))
    inertial = f'<pose>{" ".join(map(str, body.com))} 0 0 0</pose><mass>3</mass><inertia>{entries}</inertia>'
    mesh = "<mesh><uri>part.stl</uri>{}</mesh>"
    status, links = judged(write("a.sdf", sdf(inertial, mesh.format("<scale>0.001 0.001 0.001</scale>"))))
    assert status == 0 and links["a"]["misfit"] < 1e-9 and not links["a"]["notes"]
    status, links = judged(write("b.sdf", sdf(inertial, mesh.format(""))))
    assert links["a"]["findings"][0]["cause"] == "units"
    status, links = judged(write("c.sdf", sdf(inertial, "<polyline/>")))
    assert status == 0 and links["a"]["notes"] == ["<polyline> is not read: not compared with it"]


@pytest.mark.parametrize("text", ["x" * 300, "1 " * 300, "1e400", "nan"])
def test_a_long_text_is_cut_in_a_message(write, text):
    with pytest.raises(ph.InvalidInput, match="mass.* must be") as refused:
        robots.read(write("a.urdf", urdf(f'<mass value="{text}"/>' + tensor(np.eye(3)))))
    assert len(str(refused.value)) < 300 and ("..." in str(refused.value)) == (len(text) > 60)


def test_numbers_of_the_compiler_of_mjcf_are_checked(write):
    for name in ("settotalmass", "boundmass", "boundinertia"):
        with pytest.raises(ph.InvalidInput, match=f"<compiler>: {name}: must be numbers, got 'heavy'"):
            robots.read(write("a.xml", mjcf("", f'{name}="heavy"')))
