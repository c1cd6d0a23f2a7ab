"""Links without geometry whose numbers nobody computed; meshes of links with seams, and with holes; excuses."""

import json

import pytest
from commands import call, left
from meshes import binary_stl, seamed

LINK = """<link name="{name}"><inertial><mass value="{mass}"/>
<inertia ixx="{x}" iyy="{y}" izz="{z}" ixy="0" ixz="0" iyz="0"/></inertial>{more}</link>"""


def robot(*links):
    body = "".join(LINK.format(**{"more": "", **link}) for link in links)
    joints = "".join(f'<joint name="j{i}" type="continuous"><parent link="{a["name"]}"/><child link="{b["name"]}"/>'
                     "</joint>" for i, (a, b) in enumerate(zip(links, links[1:])))
    return f'<robot name="r">{body}{joints}</robot>'


@pytest.mark.parametrize("mass, moments, found", [
    (0.2, (0.1, 0.1, 0.1), True), (13, (1, 1, 1), True), (1, (0.01, 0.02, 0.02), True),
    (13, (0.341, 0.41, 0.23), False), (0.2, (1.3e-5, 1.31e-5, 2.2e-5), False)])
def test_numbers_that_nobody_computed_are_remarked_on(tmp_path, mass, moments, found):
    file = tmp_path / "r.urdf"
    file.write_text(robot(*({"name": name, "mass": mass, **dict(zip("xyz", moments))} for name in "ab")))
    result = call("inertia", file, "--json")
    assert result.exit_code == 0   # a remark is no fault
    for link in json.loads(result.stdout)["links"]:
        assert [(f["code"], f["level"]) for f in link["findings"]] == [("PI203", "remark")] * found
        if found:
            assert link["findings"][0]["cause"] == "placeholder" and "with no geometry" in link["findings"][0]["text"]
    assert call("inertia", file, "--fail-on", "remark").exit_code == found
    assert ("fine" in call("inertia", file).stdout) != found


def test_an_excuse_without_a_reason(tmp_path, capsys):
    file = tmp_path / "r.urdf"
    file.write_text(robot({"name": "ph", "mass": 13, "x": 1, "y": 1, "z": 1}))
    status, _, err = left("inertia", file, "--ignore", "ph", capsys=capsys)
    assert status == 2 and "ignore: must be LINK=reason, or a TOML file of rules; got 'ph' without a reason" in err
    status, _, err = left("inertia", file, "--ignore", "gone.toml", capsys=capsys)
    assert status == 2 and "cannot be read" in err
    assert call("inertia", file, "--ignore", "ph=a stand-in", "--fail-on", "remark").exit_code == 0


def test_a_seam_is_no_hole_of_a_link(tmp_path):
    """The hull stands for meshes that are open, and for no others."""
    visual = '<visual><geometry><mesh filename="part.stl"/></geometry></visual>'
    (tmp_path / "r.urdf").write_text(robot({"name": "a", "mass": 4000, "x": 1590.1, "y": 1588.2, "z": 1593.3,
                                           "more": visual}))
    for take, words in ((0, False), (1, True)):
        vertices, faces = seamed()
        (tmp_path / "part.stl").write_bytes(binary_stl((vertices, faces[take:])))
        found = json.loads(call("inertia", tmp_path / "r.urdf", "--json").stdout)
        assert ("is not closed: only its convex hull" in json.dumps(found)) == words
