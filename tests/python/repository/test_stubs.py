"""The type stubs tell what the compiled module has, and the package passes mypy's strict rules with them."""

import os
import pathlib
import subprocess
import sys

import pytest

import polhode

ROOT = pathlib.Path(__file__).parents[3]
STUBS = ROOT / "python/polhode/_core"


def texts(folder):
    return {str(path.relative_to(folder)): path.read_text() for path in sorted(folder.rglob("*.pyi"))}


def run(*command, **options):
    return subprocess.run([sys.executable, *map(str, command)], capture_output=True, text=True, cwd=ROOT, **options)


def test_stubs_are_those_of_the_module(tmp_path):
    made = run("tests/support/make_stubs.py", tmp_path)
    assert made.returncode == 0, made.stdout + made.stderr
    fresh, kept = texts(tmp_path), texts(STUBS)
    stale = [name for name in fresh | kept if fresh.get(name) != kept.get(name)]
    assert not stale, f"{', '.join(stale)} in python/polhode/_core: the bindings have changed, run `make stubs`"


def test_mypy_strict():
    checked = run("-m", "mypy")
    assert checked.returncode == 0, checked.stdout + checked.stderr


@pytest.mark.parametrize("line, wrong", [
    ("reveal_type(ph.FreeMotion((1, 2, 2.5), (1, 2, 3)).at(0.5)[0])", ""),
    ("reveal_type(ph.InertiaTensor.from_moments((1, 2, 2.5)).principal().axes)", ""),
    ("ph.torques.Gravity(2.0)", "Missing positional argument"),
    ("ph.FreeMotion((1, 2, 2.5), omgea=(1, 2, 3))", 'Unexpected keyword argument "omgea"'),
    ("ph.solve(ph.Scene.load('S1'), accuracy='high')", "incompatible type"),
])
def test_a_users_type_checker_sees_the_types(line, wrong, tmp_path):
    program = tmp_path / "program.py"
    program.write_text(f"import polhode as ph\n{line}\n")
    environment = {**os.environ, "MYPYPATH": str(ROOT / "python")}
    checked = run("-m", "mypy", "--config-file=", "--strict", program, env=environment)
    if wrong:
        assert checked.returncode == 1 and wrong in checked.stdout, checked.stdout
    else:
        assert checked.returncode == 0, checked.stdout
        assert "numpy.ndarray[" in checked.stdout and "float64" in checked.stdout, checked.stdout


def test_the_package_says_that_it_is_typed():
    assert (pathlib.Path(polhode.__file__).parent / "py.typed").exists()
