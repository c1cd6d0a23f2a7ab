"""The command line: what it prints and writes, its status, and one clear line on bad input."""

import csv
import io
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from commands import call, left
from scene_files import write_scene

import polhode as ph
from polhode.cli import main


@pytest.fixture
def small(tmp_path):
    return write_scene(tmp_path / "small.toml", times="span = 2.0\nsamples = 21",
                       head='name = "small"\ntitle = "a brick for a moment"')


def test_run_shows_ends_drift_cost_and_message(small):
    result = call("run", small, "--accuracy", "1e-8")
    assert result.exit_code == 0, result.output
    motion = ph.solve(ph.Scene.load(small), 1e-8)
    text = result.stdout
    assert "small: 21 samples by " + motion.plan.method in text
    for i in (0, -1):
        assert all(f"{x:.9g}" in text for x in [motion.t[i], *motion.omega[i], *motion.attitude[i]])
    assert "t [s]" in text and "z [rad/s]" in text
    assert f"energy {motion.drift['energy']:.1e}" in text and "cost    1 run; " in text
    stepped = ph.solve(ph.Scene.load(small), method="rk45", rtol=1e-8).stats
    assert f"{stepped['steps']:,} steps, " in call("run", small, "--method", "rk45", "--rtol", "1e-8").stdout
    assert motion.message in text


def test_run_finds_an_invariant_that_moved():
    result = call("run", "S1", "--method", "rk45", "--rtol", "1e-6")
    assert result.exit_code == 1
    assert "FINDING: " in result.stdout and "drifted by" in result.stdout
    assert call("run", "S1", "--method", "rk45", "--rtol", "1e-6", "--max-steps", 10).exit_code == 1


def test_a_computation_that_fails_is_a_finding_and_no_bad_input(monkeypatch):
    def fails(*_, **__):
        raise ph.IntegrationFailure("t = 1 s: more than 10 steps")

    monkeypatch.setattr("polhode.cli.app.solve", fails)
    result = call("run", "S1")
    assert (result.exit_code, result.stdout) == (1, "") and result.stderr == "polhode: t = 1 s: more than 10 steps\n"


class Terminal(io.StringIO):
    def isatty(self):
        return True


@pytest.mark.parametrize("on", ["stderr", "stdout", ""])
def test_progress_goes_to_stderr(on, monkeypatch):
    """A bar if that is a terminal, else plain lines; never to stdout, be it a terminal or not."""
    from polhode.cli import show

    out, err = (Terminal() if on == name else io.StringIO() for name in ("stdout", "stderr"))
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    monkeypatch.setenv("TERM", "xterm")
    with show.Bar("working", 2) as bar:
        bar.step(1, "half of it")
    assert out.getvalue() == "" and "half of it" in err.getvalue()
    assert ("\x1b" in err.getvalue()) == (on == "stderr")


def test_run_writes_every_bit(small, tmp_path):
    motion = ph.solve(ph.Scene.load(small), method="rk45", rtol=1e-9)
    for ending in ("csv", "npz", "json"):
        file = tmp_path / f"out.{ending}"
        result = call("run", small, "--method", "rk45", "--rtol", "1e-9", "-o", file)
        assert result.exit_code == 0 and f"wrote {file}" in result.stdout
    with np.load(tmp_path / "out.npz") as arrays:
        for name in ("t", "omega", "attitude"):
            np.testing.assert_array_equal(arrays[name], getattr(motion, name))
    rows = list(csv.reader((tmp_path / "out.csv").read_text().splitlines()))
    assert rows[0] == ["t", "omega_x", "omega_y", "omega_z", "attitude_x", "attitude_y", "attitude_z", "attitude_w"]
    table = np.array(rows[1:], dtype=float)
    np.testing.assert_array_equal(table, np.column_stack([motion.t, motion.omega, motion.attitude]))
    content = json.loads((tmp_path / "out.json").read_text())
    assert content["omega"] == motion.omega.tolist() and content["success"] is True


def test_run_as_json(small):
    content = json.loads(call("run", small, "--json").stdout)
    assert content["scene"] == "small" and len(content["t"]) == 21
    assert content["error"] < 1e-14 and content["error_kind"] == "bounded"
    assert set(content["drift"]) == {"energy", "angular_momentum"}


def test_plan(small):
    result = call("plan", small, "S5", "--accuracy", "1e-8")
    assert result.exit_code == 0, result.output
    assert "small: omega and attitude within 1e-08" in result.stdout and "> triaxial" in result.stdout
    assert "S5:" in result.stdout
    plans = json.loads(call("plan", small, "S5", "--json").stdout)
    assert [plan["model"] for plan in plans] == ["triaxial", "euler"] and plans[1]["candidates"]
    assert plans[1]["facts"]["turns"] > 5
    assert call("plan", small, "--method", "rk5").exit_code == 2
    assert call("plan", small, "--accuracy", "2").exit_code == 2


def test_calibrate(tmp_path, monkeypatch):
    from polhode._solve import calibrate, costs

    monkeypatch.setenv("POLHODE_CACHE", str(tmp_path))
    monkeypatch.setattr(calibrate, "MOST_SECONDS", 0.05)
    costs._load.cache_clear()
    result = call("calibrate")
    costs._load.cache_clear()
    assert result.exit_code == 0 and str(tmp_path) in result.stdout and "heavy_top" in result.stdout


def test_methods():
    records = json.loads(call("methods", "--json").stdout)
    assert [r["name"] for r in records] == [r["name"] for r in ph.methods()]
    text = call("methods").stdout
    assert all(r["name"] in text and r["source"] in text for r in records)


def test_inertia_of_a_shape(tmp_path):
    file = tmp_path / "box.toml"
    file.write_text('[body]\nshape = "box"\nmass = 12.0\nhalf_sides = [0.3, 0.2, 0.1]\n')
    finding = json.loads(call("inertia", file, "--json").stdout)
    np.testing.assert_allclose(finding["moments"], [0.2, 0.4, 0.52], rtol=1e-15)
    assert finding["mass"] == 12 and finding["symmetry"] == "triaxial" and finding["valid"] is True
    assert np.array(finding["axes"]).shape == (3, 3)
    text = call("inertia", file).stdout
    assert "moments [kg m^2]   0.2, 0.4, 0.52" in text and "triaxial" in text and "a body can have this tensor" in text


@pytest.mark.parametrize("more", ["", "physical = false\n"])
def test_inertia_of_no_body_is_a_finding(tmp_path, more):
    file = tmp_path / "bad.toml"
    file.write_text(f"[body]\nmoments = [1.0, 1.0, 3.0]\n{more}")
    result = call("inertia", file)
    assert result.exit_code == 1 and "a deficit of 33.33 %" in result.stdout and "1, 1, 3" in result.stdout
    assert json.loads(call("inertia", file, "--json").stdout)["valid"] is False


def test_inertia_of_what_is_no_tensor_at_all(tmp_path):
    file = tmp_path / "bad.toml"
    file.write_text("[body]\nmatrix = [[1.0, 2.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]\n")
    finding = call("inertia", file, "--json")
    assert finding.exit_code == 1 and "moments" not in json.loads(finding.stdout)


@pytest.mark.parametrize(("arguments", "words"), [
    (("run", "S77"), "scene: must be a file, or one of N2, S1"),
    (("run", "S1", "--method", "rk99"), "rk99"),
    (("run", "S1", "--accuracy", "-1"), "accuracy: must be above 0"),
    (("run", "S1", "--accuracy", "1e-9", "--rtol", "1e-9"), "accuracy: must be left out"),
    (("run", "S1", "--accuracy", "tight"), "Invalid value for '--accuracy'"),
    (("run", "S1", "-o", "out.txt"), "output: must end in .csv, .npz or .json"),
    (("run", "S1", "-o", "nowhere/out.csv"), "cannot be written"),
    (("run",), "scene"),
    (("run", "S1", "--fast"), "--fast"),
    (("walk",), "walk"),
    (("inertia", "nothing.toml"), "must be a file"),
    (("chart", "S77"), "scene: must be a file"),
    (("chart", "S1", "S1"), "'S1' is given twice"),
    (("chart", "S1", "--budget", "0"), "budget: must be positive"),
    (("chart", "S1", "-o", "/proc/no/such"), "cannot be made"),
])  # fmt: skip
def test_bad_input_is_one_line_and_status_2(arguments, words, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, out, err = left(*arguments, capsys=capsys)
    assert status == 2 and out == ""
    assert words in err and err.startswith("polhode: ") and err.count("\n") == 1


def test_version_and_help(capsys):
    assert left("--version", capsys=capsys)[:2] == (0, f"polhode {ph.__version__}\n")
    for arguments in ((), ("--help",)):
        status, out, err = left(*arguments, capsys=capsys)
        assert (status, err) == (0, "")
        assert "Chart speed against accuracy." in out and "..." not in out.split("Commands:")[1]
    status, out, _ = left("run", "--help", capsys=capsys)
    assert status == 0 and "--accuracy" in out


def test_a_real_process_piped_is_not_cut(tmp_path):
    environment = os.environ | {"COLUMNS": "40"}
    command = [sys.executable, "-m", "polhode", "methods"]
    result = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, env=environment, check=False)
    assert result.returncode == 0 and result.stderr == ""
    for record in ph.methods():
        assert any(line.startswith(record["name"]) and record["doc"] in line and record["source"] in line
                   for line in result.stdout.splitlines())


@pytest.mark.parametrize(("hidden", "arguments", "words"), [
    ("typer", ["methods"], "needs typer: pip install 'polhode[cli]'"),
    ("rich", ["methods"], "needs rich: pip install 'polhode[cli]'"),
    ("matplotlib", ["chart", "S1"], "pip install 'polhode[plot]'"),
])  # fmt: skip
def test_without_an_extra_one_line_says_which(hidden, arguments, words, tmp_path):
    program = (f"import sys; sys.modules[{hidden!r}] = None; import polhode.cli; polhode.cli.main({arguments!r})")
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=tmp_path, check=False)
    assert result.returncode == 2 and words in result.stderr and result.stderr.count("\n") == 1


def test_the_package_alone_imports_no_extra():
    heavy = {"typer", "rich", "pydantic", "matplotlib", "scipy"}
    program = f"import sys, polhode; print(sorted({heavy} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_scenes_of_the_tree_and_names_are_the_same():
    file = Path(__file__).parents[3] / "scenes/S1.toml"
    by_path, by_name = (json.loads(call("run", scene, "--json").stdout) for scene in (file, "S1"))
    assert by_path["omega"] == by_name["omega"]


def test_control_c_ends_a_command_with_one_line_and_status_130(monkeypatch, capsys):
    def interrupted(*_arguments, **_named):
        raise KeyboardInterrupt

    monkeypatch.setattr("polhode.cli.app.solve", interrupted)
    with pytest.raises(SystemExit) as ended:
        main(["run", "S1"])
    assert ended.value.code == 130
    assert capsys.readouterr().err == "polhode: interrupted\n"
