"""`polhode inertia` for other people's CI: several files, levels, excuses, formats, repairs."""

import json
import pathlib
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from test_robots import call, tensor
from test_robots_real import GOOD, link, robot, write  # noqa: F401  a fixture
from typer.testing import CliRunner

import polhode as ph
from polhode.cli.app import app
from polhode.inertia.codes import CODES
from polhode.inertia.robots import Rule, check, repair, suffixes

ROOT = pathlib.Path(__file__).parents[3]
WRONG = f'<mass value="1"/>{tensor(np.diag((0.2, 0.4, 5.23)))}'
UNLIKELY = f'<mass value="1.31"/>{tensor(np.diag((0.213, 0.414, 0.515)))}'
BOX = '<box size="0.2 0.2 0.2"/>'


@pytest.fixture
def folder(write):  # noqa: F811
    file = write("robots/good.urdf", robot(link(GOOD, '<box size="0.2 0.4 0.6"/>', "arm")))
    frame = link('<mass value="0"/>' + tensor(np.zeros((3, 3))), "", "tool0")
    write("robots/deep/bad.urdf", "<robot name='r'>\n" + link(WRONG, "", "broken") + "\n" + link(UNLIKELY, BOX, "odd")
          + f"\n{frame}</robot>")
    write("robots/package.xml", "<package/>")
    write("robots/readme.txt", "<robot/>")
    return file.parent


def test_folders_and_several_files_in_one_call(folder):
    result = call("inertia", folder, "--json")
    reports = json.loads(result.stdout)
    assert result.exit_code == 1 and [r["file"].rsplit("/")[-1] for r in reports] == ["good.urdf", "bad.urdf"]
    one = json.loads(call("inertia", folder / "deep/bad.urdf", "--json").stdout)
    assert [entry["name"] for entry in one["links"]] == ["broken", "odd", "tool0"]
    assert json.loads(call("inertia", folder / "good.urdf", folder / "deep/bad.urdf", "--json").stdout)[1] == one
    text = call("inertia", folder).stdout
    assert "2 files, 0 not read; 4 links: 1 errors, 1 warnings, 1 remarks" in text


def test_one_unreadable_file_costs_no_other(folder):
    (folder / "broken.urdf").write_text("<robot><link")
    result = call("inertia", folder, "--json")
    assert result.exit_code == 1 and [bool(r.get("error")) for r in json.loads(result.stdout)].count(True) == 1
    alone = call("inertia", folder / "broken.urdf")
    assert alone.exit_code == 2 and alone.stderr.count("\n") == 1
    both = call("inertia", folder / "broken.urdf", folder / "gone.urdf")
    assert both.exit_code == 2 and both.stdout == ""


def test_stdin(folder):
    text = (folder / "deep/bad.urdf").read_bytes()
    result = CliRunner().invoke(app, ["inertia", "-", "--json"], input=text)
    assert result.exit_code == 1 and len(json.loads(result.stdout)["links"]) == 3
    assert CliRunner().invoke(app, ["inertia", "-", "a.urdf"], input=text).exit_code == 2


@pytest.mark.parametrize("level, status", [("error", 1), ("warning", 1), ("remark", 1), ("fatal", 2)])
def test_fail_on(folder, level, status):
    assert call("inertia", folder / "deep/bad.urdf", "--fail-on", level).exit_code == status


def test_fail_on_passes_over_lower_levels(write):  # noqa: F811
    file = write("a.urdf", robot(link(UNLIKELY, BOX)))
    assert call("inertia", file, "--fail-on", "error").exit_code == 0
    assert call("inertia", file).exit_code == 1
    frame = write("b.urdf", robot(link('<mass value="0"/>' + tensor(np.zeros((3, 3))))))
    assert call("inertia", frame).exit_code == 0 and call("inertia", frame, "--fail-on", "remark").exit_code == 1


def test_excuses(folder, tmp_path):
    bad = folder / "deep/bad.urdf"
    result = call("inertia", bad, "--json", "--ignore", "broken=a model of a test", "--ignore", "o?d=seen",
                  "--ignore", "nobody=old")
    links = {entry["name"]: entry for entry in json.loads(result.stdout)["links"]}
    assert result.exit_code == 0 and not links["broken"]["findings"]
    assert links["broken"]["ignored"][0]["reason"] == "a model of a test" and "seen" in links["odd"]["verdict"]
    assert "ignore 'nobody': no longer applies (old)" in result.stderr and "broken" not in result.stderr
    rules = tmp_path / "ignore.toml"
    rules.write_text('[[ignore]]\nlink = "broken"\ncode = "PI005"\nfile = "deep/*.urdf"\nreason = "known"\n'
                     '[[ignore]]\nlink = "odd"\ncode = "PI004"\nreason = "another code"\n')
    result = call("inertia", bad, "--json", "--ignore", rules)
    assert result.exit_code == 1 and "PI004: no longer applies" in result.stderr
    assert [bool(entry["findings"]) for entry in json.loads(result.stdout)["links"]] == [False, True, True]
    for text in ("broken", "=reason", "a=", "x"):
        assert call("inertia", bad, "--ignore", text).exit_code == 2
    for text in ("[[ignore]]\nlink='a'", "[[ignore]]\nlink='a'\nreason='b'\nlevel='c'", "a=1", "[[", "ignore=3",
                 "[[ignore]]\nlink='a'\nreason='b'\ncode='PI999'", "ignore=[3]"):
        rules.write_text(text)
        result = call("inertia", bad, "--ignore", rules)
        assert result.exit_code == 2 and result.stderr.count("\n") == 1 and str(rules) in result.stderr


def test_sarif(folder):
    log = json.loads(call("inertia", folder, "--format", "sarif", "--ignore", "odd=seen").stdout)
    (run,) = log["runs"]
    rules = {rule["id"] for rule in run["tool"]["driver"]["rules"]}
    assert log["version"] == "2.1.0" and rules == set(CODES)
    results = {result["locations"][0]["logicalLocations"][0]["name"]: result for result in run["results"]}
    assert (results["broken"]["level"], results["tool0"]["level"]) == ("error", "note")
    assert results["broken"]["locations"][0]["physicalLocation"]["region"]["startLine"] == 2
    assert results["odd"]["suppressions"][0]["justification"] == "seen" and "suppressions" not in results["broken"]
    assert results["odd"]["locations"][0]["physicalLocation"]["artifactLocation"]["uri"].endswith("deep/bad.urdf")


def test_junit(folder):
    root = ET.fromstring(call("inertia", folder, "--format", "junit").stdout)
    assert root.get("tests") == "4" and root.get("failures") == "2"
    cases = {case.get("name"): case for case in root.iter("testcase")}
    assert "PI005" in cases["broken"].find("failure").get("message") and cases["arm"].find("failure") is None
    assert cases["odd"].get("line") == "3" and cases["tool0"].find("failure") is None
    ET.fromstring(call("inertia", folder, "--format", "junit", "--fail-on", "remark").stdout)


def test_github(folder):
    lines = call("inertia", folder / "deep/bad.urdf", "--format", "github").stdout.splitlines()
    assert [line.split()[0] for line in lines] == ["::error", "::warning", "::notice"]
    assert all(re.fullmatch(r"::\w+ file=[^,]+,line=\d+,title=PI\d{3} \w+::[^\n]+", line) for line in lines)
    strange = folder / "a,b%c.urdf"
    strange.write_text(robot(link(WRONG)))
    assert "a%2Cb%25c.urdf" in call("inertia", strange, "--format", "github").stdout


def test_names_that_xml_and_commands_must_not_take_as_they_are(write):  # noqa: F811
    file = write("a.urdf", robot(link(WRONG, "", "a&quot;&lt;b&gt;&#10;::error::x")))
    ET.fromstring(call("inertia", file, "--format", "junit").stdout)
    assert call("inertia", file, "--format", "github").stdout.count("\n") == 1
    assert call("inertia", file, "--format", "yaml").exit_code == 2


def test_the_python_interface(folder):
    good, bad = check(folder, ignore=[Rule("odd", "seen")])
    assert (bad.level, good.level, bad.fails(), good.fails("remark")) == ("error", "", True, False)
    broken = bad.links[0]
    assert broken.findings[0].code == "PI005" and broken.link.name == "broken" and broken.link.line == 2
    assert bad.links[1].ignored[0][1] == "seen" and not bad.links[1].findings
    assert ph.inertia.robots.check is check
    (gone,) = check(folder / "gone.urdf")
    assert gone.level == "error" and "cannot be read" in gone.error


# ---- repair

def test_a_repair_changes_numbers_alone(write):  # noqa: F811
    body = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    m = body.inertia.matrix
    xx, yy, zz = (repr(float(m[i, i] * 1e6)) for i in range(3))
    text = f"""<?xml version='1.0'?>\r
<!-- by  hand -- twice -->
<robot name = "r">\t<link name="a"><inertial><origin xyz='0 0 0'/>
  <mass   value = '12' />
  <inertia ixx="{xx}"  ixy='0' ixz="0" iyy = "{yy}" iyz="0" izz="{zz}"/>
</inertial><visual><geometry><box size="0.2 0.4 0.6"/></geometry></visual></link></robot>
<!-- end -->"""
    file = write("a.urdf", text)
    result = call("inertia", file, "--fix")
    assert result.exit_code == 1 and "PI102 extent (units): repaired" in result.stderr and "wrote" in result.stderr
    fixed = (file.parent / "a.fixed.urdf").read_bytes().decode()
    assert file.read_bytes().decode() == text
    comment = re.search("<!-- was [^>]*-->", fixed)[0]
    assert all(repr(float(m[i, i] * 1e6)) in comment for i in range(3))
    again = fixed.replace(comment, "")
    for i in range(3):
        assert f'"{m[i, i]:.9g}"' in again
        again = again.replace(f'"{m[i, i]:.9g}"', f'"{float(m[i, i] * 1e6)!r}"')
    assert again == text
    (report,) = check(file.parent / "a.fixed.urdf")
    assert report.level == "" and np.allclose(report.links[0].link.matrix, m)


def test_repairs_of_sdf_and_mjcf(write):  # noqa: F811
    body = ph.shapes.box(12.0, (0.1, 0.2, 0.3))
    xx, yy, zz = (float(x) for x in body.inertia.matrix.diagonal())
    sdf = (f"<sdf version='1.9'><model name='m'><link name='a'><inertial>\n<pose>0 0 0 0 0 0</pose><mass> 12000 </mass>"
           f"<inertia><ixx>{xx}</ixx><iyy>{yy}</iyy><izz>{zz}</izz></inertia></inertial><visual name='v'><geometry>"
           "<box><size>0.2 0.4 0.6</size></box></geometry></visual></link></model></sdf>")
    file = write("a.sdf", sdf)
    call("inertia", file, "--fix")
    fixed = (file.parent / "a.fixed.sdf").read_text()
    assert fixed == sdf.replace("<mass> 12000 </mass>", "<mass> 12 </mass><!-- was mass 12000 -->")
    mjcf = (f'<mujoco><worldbody><body name="a"><inertial pos="0 0 0" mass="12" diaginertia="{xx} {zz} {yy}"/>'
            '<geom type="box" size="0.1 0.2 0.3" contype="0" conaffinity="0"/></body></worldbody></mujoco>')
    file = write("a.xml", mjcf)
    assert call("inertia", file).exit_code == 1
    call("inertia", file, "--fix")
    fixed = (file.parent / "a.fixed.xml").read_text()
    assert f'diaginertia="{xx:.9g} {yy:.9g} {zz:.9g}"/><!-- was diaginertia="{xx} {zz} {yy}" -->' in fixed


def test_what_is_not_sure_is_not_repaired(folder):
    bad = folder / "deep/bad.urdf"
    (report,) = check(bad)
    data, said = repair(bad.read_bytes(), report)
    assert data == bad.read_bytes()
    assert any("odd: PI102 extent (unknown): not repaired" in line for line in said)
    assert not any("tool0" in line for line in said)


def test_options_are_for_robots_alone():
    for option in (("--fail-on", "error"), ("--ignore", "a=b"), ("--path", "."), ("--fix",), ("--format", "sarif"),
                   ("--no-xacro",)):
        result = call("inertia", "S1", *option)
        said = f"{option[0].replace('--no-', '--')}: must be used with robots"
        assert result.exit_code == 2 and said in result.stderr


# ---- pages

def test_each_code_has_its_page():
    pages = {page.stem: page.read_text() for page in (ROOT / "docs/codes").glob("PI*.md")}
    assert set(pages) == set(CODES)
    table = (ROOT / "docs/codes/README.md").read_text()
    for code in CODES.values():
        assert pages[code.name].startswith(f"# {code.name}: {code.title}\n\nLevel: {code.level}. ")
        assert f"| [{code.name}]({code.name}.md) | {code.level} | {code.title} |" in table


def test_the_hook_calls_the_command_for_the_suffixes_that_are_read():
    hook = (ROOT / ".pre-commit-hooks.yaml").read_text()
    pattern = re.search(r"files: (.*)", hook)[1]
    assert "entry: polhode inertia\n" in hook
    assert [suffix for suffix in suffixes if not re.search(pattern, f"a{suffix}")] == [".xml", ".xacro"]
