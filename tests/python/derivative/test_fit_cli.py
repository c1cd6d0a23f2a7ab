"""`polhode fit`: a table of measurements in, parameters and a picture out, one clear line on bad input."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

import polhode as ph
from polhode._sensitivity.result import moment_errors
from polhode.cli import main
from polhode.cli.app import app

HEADER = "t,omega_x,omega_y,omega_z"


@pytest.fixture
def log(tmp_path):
    rng = np.random.default_rng(2)
    t = np.linspace(0, 4, 200)
    y = ph.FreeMotion((0.3, 0.5, 0.62), (1, -6, 0.7)).at(t)[0] + 0.03 * rng.normal(size=(200, 3))
    lines = [",".join(f"{v:.9g}" for v in row) for row in np.column_stack([t, y])]
    lines[7] = lines[7].split(",")[0] + ",,,"   # the sensor was silent
    file = tmp_path / "log.csv"
    file.write_text("\n".join([HEADER, *lines]) + "\n")
    return file


def call(*arguments):
    return CliRunner().invoke(app, [str(a) for a in arguments])


def test_a_log_becomes_a_body(log):
    done = call("fit", log, "--sigma", "omega=0.03", "--fit", "omega,inertia", "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["omega"] == pytest.approx([1, -6, 0.7], abs=0.05)
    assert found["inertia"] == pytest.approx(np.array([0.3, 0.5, 0.62]) / 0.62, abs=0.02)
    assert found["parameters"]["omega_x"]["stderr"] < 0.02 and found["dof"] == 3 * 199 - 5
    done = call("fit", log, "--sigma", "omega=0.03", "--fit", "omega,inertia", "--bias")
    assert "bias_x = " in done.stdout and "not observable: the scale of the inertia" in done.stdout


def test_a_model_that_does_not_fit_is_a_finding(log):
    assert call("fit", log, "--sigma", "omega=0.003", "--fit", "omega,inertia").exit_code == 1


def test_the_picture_is_written(log, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "fit.svg"
    assert call("fit", log, "--sigma", "omega=0.03", "--fit", "omega,inertia", "--plot", picture).exit_code == 0
    assert "predicted spread of the attitude" in picture.read_text()


def test_a_table_of_one_row_is_read(log):
    log.write_text(f"{HEADER}\n0,1,2,3\n")
    done = call("fit", log, "--sigma", "omega=0.03", "--fit", "omega,inertia")
    assert done.exit_code == 2 and "3 numbers cannot give 5 parameters" in done.output


@pytest.mark.parametrize(("arguments", "text"), [
    (("--sigma", "omega"), "--sigma: must be such as"),
    (("--sigma", "axis=1"), "--sigma: must give omega"),
    (("--sigma", "omega=0.1", "--columns", "t,a"), "--columns: must name the 4 columns"),
    (("--sigma", "omega=0.1", "--columns", "time,a,b,c"), "--columns: must name the time"),
    (("--sigma", "omega=0.1", "--columns", "t,a,b,c"), "--columns: must name a sensor"),
    (("--sigma", "omega=0.1", "--columns", "t,omega_x,b,c"), "--columns: omega needs"),
    (("--sigma", "direction=0.1", "--columns", "t,direction_x,direction_y,direction_z"), "--direction: must give"),
    (("--sigma", "omega=0.1", "--fit", "mass"), "fit: must be some of"),
])
def test_bad_arguments_give_one_line(log, arguments, text, capsys):
    with pytest.raises(SystemExit) as leaving:
        main(["fit", str(log), *arguments])
    err = capsys.readouterr().err
    assert leaving.value.code == 2 and text in err and err.count("\n") == 1


def test_a_part_of_a_foreign_file_gives_the_ratios_of_the_moments(log, tmp_path):
    """Columns of other names and orders, and one that is no number of the fit; times count from --from."""
    rows = [line.split(",") for line in log.read_text().splitlines()[1:]]
    lines = ["seconds,z,y,x,volume"]
    for t, x, y, z in rows:
        lines.append(f"{float(t) + 7:.9g},{z},{y},{x},3")
    lines += ["11.5,90,90,90,1", "6.5,90,90,90,1"]     # a hand holds the phone
    file = tmp_path / "phone.csv"
    file.write_text("\n".join(lines) + "\n")
    options = ["--sigma", "omega=0.03", "--fit", "omega,inertia", "--columns",
               "t=seconds,omega_x=x,omega_y=y,omega_z=z", "--from", "7", "--to", "11.1"]
    done = call("fit", file, *options, "--json")
    assert done.exit_code == 0, done.output
    found = json.loads(done.stdout)
    assert found["omega"] == pytest.approx([1, -6, 0.7], abs=0.05) and len(found["candidates"]) == 1
    assert "moments over the largest: 0.48" in call("fit", file, *options).stdout
    done = call("fit", file, "--sigma", "omega=0.03", "--columns", "t=time,omega_x=x")
    assert done.exit_code == 2 or "must be name=column with columns of" in str(done.exception) + done.output


def test_the_errors_of_the_moments_are_those_of_draws():
    rng = np.random.default_rng(4)
    ratios, cov = np.array([0.4, -0.7]), np.array([[4e-6, 1e-6], [1e-6, 9e-6]])
    P = np.exp(np.column_stack([rng.multivariate_normal(ratios, cov, 40_000), np.zeros(40_000)]))
    J = P.sum(axis=1, keepdims=True) - P
    assert moment_errors(ratios, cov) == pytest.approx((J / J[:, [np.argmax(J[0])]]).std(axis=0), rel=0.03, abs=1e-12)
