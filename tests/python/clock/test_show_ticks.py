"""Ticks on the command line, in files and in pictures."""

import json

import numpy as np
import pytest
from commands import call

import polhode as ph


def pid(t, m, s, p):
    e = m.attitude[:3] * m.attitude[3]
    return -p.kp * e - p.kd * m.omega - s.z, {"z": s.z + 0.1 * e}


@pytest.fixture
def loop(tmp_path):
    law = ph.Controller(0.1, pid, states={"z": (0, 0, 0)}, parameters={"kp": 2.0, "kd": 3.0}, width=0.06, delay=0.02)
    scene = ph.Scene(name="loop", inertia=(1.0, 2.0, 2.5), omega=(0.2, -0.3, 0.1), controllers=[law],
                     times=np.linspace(0, 2, 21))
    scene.save(tmp_path / "loop.toml")
    return tmp_path / "loop.toml", ph.solve(scene, 1e-8)


def test_run_shows_the_first_and_last_ticks(loop):
    path, motion = loop
    result = call("run", path, "--accuracy", "1e-8")
    assert result.exit_code == 0, result.output
    ticks = motion.ticks[0]
    assert "controller 0: 20 ticks, a command of torque" in result.stdout and "command 2" in result.stdout
    for k in (0, 2, -1):
        for value in (ticks.t[k], *ticks.command[k], *ticks.states["z"][k]):
            assert f"{value:.9g}" in result.stdout
    assert f"{ticks.command[7, 0]:.9g}" not in result.stdout


def test_files_hold_the_ticks(loop, tmp_path):
    path, motion = loop
    for name in ("a.json", "a.npz"):
        assert call("run", path, "--accuracy", "1e-8", "-o", tmp_path / name).exit_code == 0
    (ticks,) = json.loads((tmp_path / "a.json").read_text())["ticks"]
    arrays = np.load(tmp_path / "a.npz")
    own = motion.ticks[0]
    for found in (ticks, {key.removeprefix("ticks.0."): arrays[key] for key in arrays if key.startswith("ticks.0.")}):
        np.testing.assert_array_equal(found["t"], own.t)
        np.testing.assert_array_equal(found["command"], own.command)
        np.testing.assert_array_equal(found["states.z"], own.states["z"])
        np.testing.assert_array_equal(found["measurement.omega"], own.measurement["omega"])


def test_a_picture_has_the_commands(loop, tmp_path):
    pytest.importorskip("matplotlib").use("agg")
    path, motion = loop
    assert call("run", path, "--plot", tmp_path / "a.png").exit_code == 0
    assert (tmp_path / "a.png").stat().st_size > 10_000
    figure = motion.plot("commands")
    (axes,) = figure.axes
    assert axes.get_title(loc="left") == "commands: 20 ticks" and axes.get_ylabel() == "N m"
    t, y = (np.asarray(x) for x in axes.lines[0].get_data())
    held = np.interp([0.03, 0.05, 0.13, 0.15], t, y)   # within pulses from 0.02 to 0.08, and so on
    np.testing.assert_allclose(held, motion.ticks[0].command[[0, 0, 1, 1], 0], rtol=1e-12)
    assert np.interp(0.1, t, y) == 0.0


def test_a_scene_without_controllers_has_no_commands_to_draw():
    pytest.importorskip("matplotlib").use("agg")
    motion = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0.1, 1, 0), times=np.linspace(0, 5, 51)))
    assert motion.plot("commands").axes[0].get_title(loc="left") == "commands: the scene has no controller"
