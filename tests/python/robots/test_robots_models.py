"""MJCF and SDF with their parts in other files, frames, copies; xacro; and MuJoCo's own numbers."""

import numpy as np
import pytest
from test_robots import CORNERS, SIDES, call, judged, stl
from test_robots_real import robot, write  # noqa: F401  a fixture

import polhode as ph
from polhode.inertia import robots
from polhode.inertia.robots.paths import Search

BODY = '<body name="{}"><geom type="box" size="0.1 0.2 0.3"/></body>'


def test_mjcf_includes_are_put_in_their_places(write):
    write("parts/arm.xml", '<mujoco><worldbody>' + BODY.format("arm") + '</worldbody></mujoco>')
    write("settings.xml", '<mujocoinclude><default><geom density="2000"/></default></mujocoinclude>')
    file = write("a.xml", '<mujoco><include file="settings.xml"/><include file="parts/arm.xml"/><worldbody>'
                 + BODY.format("own") + '<include file="gone.xml"/></worldbody></mujoco>')
    status, links = judged(file)
    assert set(links) == {"arm", "own"} and all(link["mass"] == pytest.approx(96) for link in links.values())
    assert links["arm"]["file"].endswith("arm.xml") and "'gone.xml' not found" in call("inertia", file).stdout
    write("b.xml", '<mujoco><include file="b.xml"/><worldbody/></mujoco>')
    assert "nested" in call("inertia", file.parent / "b.xml").stderr


def test_mjcf_frames_replicas_and_attached_models(write):
    pair = '<geom type="box" size="0.1 0.1 0.1" pos="{} 0 0"/>'
    written = "<mujoco><worldbody><body name='a'>{}</body></worldbody></mujoco>"
    apart = judged(write("a.xml", written.format(pair.format(1) + pair.format(1.5))))[1]["a"]
    framed = judged(write("b.xml", written.format('<frame pos="1 0 0">' + pair.format(0) + '<frame pos="0.5 0 0">'
                                                  + pair.format(0) + "</frame></frame>")))[1]["a"]
    copied = judged(write("c.xml", written.format('<replicate count="2" offset="0.5 0 0">' + pair.format(1)
                                                  + "</replicate>")))[1]["a"]
    for other in (framed, copied):
        np.testing.assert_allclose(other["matrix"], apart["matrix"], rtol=1e-12)
        assert other["com"] == pytest.approx(apart["com"]) and other["mass"] == pytest.approx(apart["mass"])
    write("hand.xml", '<mujoco><default><geom density="500"/></default><worldbody><body name="palm">'
          '<geom type="box" size="0.1 0.2 0.3"/><body name="tip"><geom size="0.1"/></body></body></worldbody></mujoco>')
    _, links = judged(write("d.xml", '<mujoco><asset><model name="hand" file="hand.xml"/></asset><worldbody>'
                            '<body name="arm"><geom size="0.1"/><attach model="hand" body="palm" prefix="l_"/></body>'
                            '</worldbody></mujoco>'))
    assert set(links) == {"arm", "l_palm", "l_tip"} and links["l_palm"]["mass"] == pytest.approx(24)


def test_a_mesh_of_mjcf_is_placed_by_its_own_frame(write):
    """MuJoCo takes refpos from the vertices, and then turns them back by refquat."""
    write("part.stl", _binary(CORNERS, SIDES))
    text = ('<mujoco><asset><mesh name="m" file="part.stl" {}/></asset><worldbody><body name="a"><geom type="mesh" '
            'mesh="m" pos="0 0 1"/></body></worldbody></mujoco>')
    quarter = 'refquat="0.7071067811865476 0 0 0.7071067811865476"'   # about z
    back = ph.Rotation.from_euler("z", -np.pi / 2)
    for k, (told, corners) in enumerate([("", CORNERS), ('refpos="0.1 0.2 0"', CORNERS - (0.1, 0.2, 0)),
                                         (quarter, back.apply(CORNERS)),
                                         (f'refpos="0.1 0.2 0" {quarter}', back.apply(CORNERS - (0.1, 0.2, 0)))]):
        (found,) = robots.read(write(f"{k}.xml", text.format(told))).links
        body = ph.shapes.tetrahedron(1.0, corners + (0, 0, 1))
        np.testing.assert_allclose(found.pose.place, body.com, atol=1e-7)   # float32 in the file


def test_a_thousand_copies_are_read_and_no_more(write):
    text = ('<mujoco><worldbody><body name="a"><replicate count="{}" offset="0.5 0 0"><geom size="0.1"/></replicate>'
            '</body></worldbody></mujoco>')
    _, links = judged(write("a.xml", text.format(1000)))
    assert links["a"]["mass"] == pytest.approx(1000 * 1000 * 4 / 3 * np.pi * 0.1**3)
    refused = call("inertia", write("b.xml", text.format(1001)))
    assert refused.exit_code == 2 and "must be from 0 to 1000 to be read, got 1001" in refused.stderr


@pytest.mark.parametrize("merge", ["", " merge='true'"])
def test_models_in_models_are_read_twenty_deep(write, merge):
    """Each includes the next: twenty are read, with a link each, and the next one is named."""
    for k in reversed(range(22)):
        more = f"<include{merge}><uri>m{k + 1}.sdf</uri></include>" if k < 21 else ""
        file = write(f"m{k}.sdf", model(f"<link name='l{k}'>{INERTIAL}</link>", f"m{k}", more))
    longest = robots.read(file)
    assert {found.name.rpartition("::")[2] for found in longest.links} == {f"l{k}" for k in range(20)}
    (note,) = longest.notes
    assert "m20.sdf" in note and "nested more than 20 deep" in note
    whole = robots.read(write("m1.sdf", (file.parent / "m2.sdf").read_text()))
    assert len(whole.links) == 20 and not whole.notes


def test_mjcf_agrees_with_mujoco(write):
    """Mass, centre and tensor of bodies from geoms, against the compiled model."""
    mujoco = pytest.importorskip("mujoco")
    write("part.stl", _binary(1000 * CORNERS, SIDES))
    file = write("a.xml", """<mujoco><compiler angle="radian" eulerseq="XYz" inertiagrouprange="0 2"/>
<default><default class="dense"><geom density="3000"/></default></default>
<asset><mesh name="part" file="part.stl" scale="0.001 0.001 0.001" refpos="0.1 0 0"/></asset><worldbody>
<body name="a"><geom type="capsule" size="0.1" fromto="0 0 0 1 2 3"/><geom class="dense" size="0.2" pos="1 0 0"/></body>
<body name="b" childclass="dense"><frame euler="0.1 0.2 0.3" pos="1 1 0"><geom type="ellipsoid" size="0.1 0.2 0.3"
 axisangle="1 2 3 0.5"/></frame><geom type="box" size="1 1 1" group="3"/></body>
<body name="c"><frame pos="1 2 3" euler="0.4 0.5 0"><replicate count="3" offset="0.5 0 0.1" euler="0 0.3 0.7">
<geom type="cylinder" size="0.1 0.3" pos="0.3 0 0"/></replicate></frame></body>
<body name="d"><geom type="mesh" mesh="part" pos="0 0 1" xyaxes="0 1 0 -1 0 0"/></body>
</worldbody></mujoco>""")
    model = mujoco.MjSpec.from_file(str(file)).compile()
    links = {link.name: link for link in robots.read(file).links}
    assert set(links) == set("abcd")
    for name, link in links.items():
        i = model.body(name).id
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[i])
        turn = turn.reshape(3, 3)
        expected = turn @ np.diag(model.body_inertia[i]) @ turn.T
        assert link.mass == pytest.approx(model.body_mass[i], rel=1e-6)
        np.testing.assert_allclose(link.pose.place, model.body_ipos[i], rtol=1e-6, atol=1e-7)
        np.testing.assert_allclose(link.matrix, expected, rtol=1e-5, atol=1e-6 * np.abs(expected).max())


def _binary(vertices, faces):
    rows = np.zeros(len(faces), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]))
    rows["corners"] = vertices[faces]
    return b"\0" * 80 + np.uint32(len(faces)).tobytes() + rows.tobytes()


def test_what_only_mujoco_makes_is_read_through_it(write):
    pytest.importorskip("mujoco")
    file = write("a.xml", '<mujoco><worldbody><body name="s"><geom type="box" size="0.1 0.2 0.3" shellinertia="true"/>'
                 '</body><flexcomp name="f" type="grid" count="3 3 1" spacing="0.1 0.1 0.1" dim="2" mass="1" '
                 'radius="0.01"/></worldbody></mujoco>')
    status, links = judged(file)
    assert status == 0 and len(links) == 10 and links["f_0"]["mass"] == pytest.approx(1 / 9)
    assert links["s"]["matrix"] is not None and not links["s"]["findings"]
    write("part.stl", _binary(CORNERS, SIDES))
    outside = write("deep/er/still/b.xml", '<mujoco><asset><mesh name="m" file="../../../part.stl"/></asset><worldbody>'
                    '<body name="s"><geom type="box" size="0.1 0.2 0.3" shellinertia="true"/></body></worldbody>'
                    '</mujoco>')
    assert "not all read" in judged(outside)[1]["s"]["verdict"]


def test_a_file_is_given_to_mujoco_only_if_its_folders_are_allowed(write):
    """MuJoCo opens what the file names, so the folders of its meshes are looked at before."""
    from polhode._xml import parse
    from polhode.inertia.robots import by_mujoco

    write("part.stl", _binary(CORNERS, SIDES))
    text = '<mujoco><compiler {}="{}"/><asset><mesh file="part.stl"/></asset></mujoco>'
    for key in ("meshdir", "texturedir", "assetdir"):
        for folder, allowed in (("meshes", True), (".", True), ("../../../..", False), ("/etc", False)):
            file = write("one/two/three/a.xml", text.format(key, folder))
            assert by_mujoco._allowed(file, parse(file), Search.of()) == allowed, (key, folder)


ENTRIES = "<inertia><ixx>0.52</ixx><iyy>0.4</iyy><izz>0.2</izz></inertia>"
INERTIAL = f"<inertial><mass>12</mass>{ENTRIES}</inertial>"
SHOWN = "<visual name='v'>{}<geometry><box><size>0.2 0.4 0.6</size></box></geometry></visual>"


def model(links, name="m", more=""):
    return f"<sdf version='1.9'><model name='{name}'>{more}{links}</model></sdf>"


def test_sdf_includes_by_folder_merged_and_nested(write, tmp_path, monkeypatch):
    write("models/box/model.config", "<model><sdf version='1.5'>old.sdf</sdf><sdf version='1.9'>new.sdf</sdf></model>")
    write("models/box/old.sdf", model("<link name='old'/>", "box"))
    write("models/box/new.sdf", model(f"<link name='l'>{INERTIAL}{SHOWN.format('')}</link>", "box"))
    include = "<include{}><uri>model://box</uri>{}</include>"
    world = ("<sdf version='1.9'><world name='w'>" + include.format("", "<name>one</name>") + include.format("", "")
             + "<model name='m'>" + include.format(" merge='true'", "") + "</model></world></sdf>")
    file = write("far/away/worlds/w.sdf", world)
    assert "<include> 'model://box' is not read" in call("inertia", file).stdout   # outside of the project
    for options in (("--path", tmp_path / "models"), ()):
        if not options:
            monkeypatch.setenv("GZ_SIM_RESOURCE_PATH", str(tmp_path / "models"))
        report = call("inertia", file, "--json", *options)
        assert report.exit_code == 0 and '"l"' in report.stdout and "2 further <include>" in report.stdout
    merged = write("far/away/worlds/m.sdf", model("", "m", include.format(" merge='true'", "")))
    (found,) = robots.read(merged).links
    assert found.name == "l" and found.file.endswith("new.sdf")


def test_sdf_poses_relative_to_other_frames(write):
    """The box is given in a frame that hangs on a joint's child: it comes to lie where the centre is."""
    pose = "<pose relative_to='f'>0 0 1 0 0 0</pose>"
    link = (f"<link name='a'><pose>1 0 0 0 0 1.5707963267948966</pose><inertial>{pose}<mass>12</mass>{ENTRIES}"
            "</inertial>" + SHOWN.format(pose) + "</link>")
    frames = ("<joint name='j' type='fixed'><parent>world</parent><child>a</child><pose>0 0 0 0 0 -1.5707963267948966"
              "</pose></joint><frame name='f' attached_to='j'><pose>0 2 0 0 0 0</pose></frame>")
    (found,) = robots.read(write("a.sdf", model(link, "m", frames))).links
    np.testing.assert_allclose(found.pose.place, (2, 0, 1), atol=1e-12)   # f is at (1, 2, 0) in the model
    assert judged(write("a.sdf", model(link, "m", frames)))[1]["a"]["misfit"] < 1e-9
    lost = model(link.replace("relative_to='f'>0 0 1 0 0 0</pose><geo", "relative_to='gone'>0 0 1 0 0 0</pose><geo"),
                 "m", frames)
    assert "'gone', which is not known" in str(judged(write("b.sdf", lost))[1]["a"]["notes"])


def test_old_sdf_and_static_models(write):
    old = ("<gazebo version='1.0'><model name='m'><link name='a'><inertial mass='12'><origin pose='0.1 0 0 0 0 0'/>"
           "<inertia ixx='0.52' iyy='0.4' izz='0.2' ixy='0' ixz='0' iyz='0'/></inertial><visual name='v'>"
           "<origin pose='0.1 0 0 0 0 0'/><geometry><box size='0.2 0.4 0.6'/></geometry></visual></link></model>"
           "</gazebo>")
    status, links = judged(write("a.world", old))
    assert status == 0 and links["a"]["mass"] == 12 and links["a"]["misfit"] < 1e-9
    wrong = model(f"<link name='a'>{INERTIAL.replace('0.52', '52.17')}{SHOWN.format('')}</link>")
    assert judged(write("b.sdf", wrong))[0] == 1
    large = INERTIAL.replace("0.52", "5.23").replace("0.4", "5.41")
    unlikely = model(f"<link name='a'>{large}{SHOWN.format('')}</link>")
    assert judged(write("c.sdf", unlikely))[0] == 1
    status, links = judged(write("d.sdf", unlikely.replace("<link", "<static>true</static><link")))
    assert status == 0 and links["a"]["findings"][0]["level"] == "remark"


def test_a_cone_stands_on_its_middle(write):
    cone = ph.shapes.cone(12.0, 0.3, 0.8).moved(translation=(0, 0, -0.4))
    m = cone.inertia.matrix
    entries = "".join(f"<i{a}{a}>{float(m[i, i])!r}</i{a}{a}>" for i, a in enumerate("xyz"))
    text = model(f"<link name='a'><inertial><pose>0 0 {cone.com[2]} 0 0 0</pose><mass>12</mass><inertia>{entries}"
                 "</inertia></inertial><visual name='v'><geometry><cone><radius>0.3</radius><length>0.8</length></cone>"
                 "</geometry></visual></link>")
    assert judged(write("a.sdf", text))[1]["a"]["misfit"] < 1e-9


XACRO = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:include filename="{include}"/>
<xacro:property name="m" value="12"/><link name="a"><inertial><mass value="${{m}}"/><xacro:tensor/>
</inertial></link></robot>"""
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="tensor" params="">
<inertia ixx="${1 + 1}" ixy="0" ixz="0" iyy="2" iyz="0" izz="3"/></xacro:macro></robot>"""


def test_xacro_is_expanded_where_it_is_installed(write, tmp_path):
    pytest.importorskip("xacro")
    write("arm/urdf/tensor.xacro", MACRO)
    for include in ("tensor.xacro", "$(find arm)/urdf/tensor.xacro"):
        status, links = judged(write("arm/urdf/a.urdf.xacro", XACRO.format(include=include)))
        assert status == 0 and links["a"]["matrix"][0][0] == 2
    write("elsewhere/tensor.xacro", MACRO)
    result = call("inertia", write("arm/urdf/b.xacro", XACRO.format(include=tmp_path / "elsewhere/tensor.xacro")))
    assert result.exit_code == 2 and "outside" in result.stderr and result.stderr.count("\n") == 1
    write("arm/urdf/tensor.xacro", "<!DOCTYPE robot [<!ENTITY a 'b'>]>" + MACRO)
    assert "document type" in call("inertia", tmp_path / "arm/urdf/a.urdf.xacro").stderr
    plain = call("inertia", tmp_path / "arm/urdf/a.urdf.xacro", "--no-xacro")
    assert plain.exit_code == 2 and plain.stderr.count("\n") == 1


def test_without_the_extras_what_they_read_is_named(write, monkeypatch):
    import sys
    for module in ("scipy.spatial", "trimesh", "xacro"):
        monkeypatch.setitem(sys.modules, module, None)
    write("open.stl", stl(CORNERS, SIDES[:3]))
    write("part.obj", "v 0 0 0\n")
    parts = "".join(f"<visual><geometry><mesh filename='{name}'/></geometry></visual>"
                    for name in ("open.stl", "part.obj"))
    inertial = ('<inertial><mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1.1" iyz="0" izz="1.2"/></inertial>')
    (link,) = robots.read(write("a.urdf", robot(f'<link name="a">{inertial}{parts}</link>'))).links
    assert "only its extent is compared" in link.notes[0] and "pip install 'polhode[mesh]'" in link.notes[1]
