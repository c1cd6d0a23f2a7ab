"""Refusals and costs at the doors: empty windows, outputs that share memory, steps beyond float64, JSON."""

import json
import subprocess
import sys

import numpy as np
import pytest
from scene_files import write_scene

import polhode as ph

I, W, Q = (1, 2, 2.5), (1, 2, 3), (0, 0, 0, 1)


# ---- windows

@pytest.mark.parametrize("empty", [[], (), np.zeros((0, 2))])
def test_an_empty_list_of_windows_means_never(empty):
    never, always = ph.Rotor((0, 0, 1), momentum=1.0, during=empty), ph.Rotor((0, 0, 1), momentum=1.0)
    assert never.during == () and always.during is None and never != always
    assert "during=()" in repr(never) and "during" not in repr(always)
    assert eval(repr(never), {"polhode": ph}) == never
    start = {"inertia": I, "omega": W, "times": [1.0, 5.0]}
    free = ph.FreeMotion(I, W).at(np.array([1.0, 5.0]))
    push = ph.torques.During(ph.torques.Constant((1, 0, 0)), empty)
    for scene in (ph.Scene(**start, rotors=[never]), ph.Scene(**start, torques=[push])):
        for options in ({"accuracy": 1e-10}, {"accuracy": 1e-10, "certify": "proof"},
                        {"rtol": 1e-11, "method": "rk45"}):
            motion = ph.solve(scene, **options)
            np.testing.assert_allclose(motion.omega, free[0], rtol=0, atol=4e-9)
            np.testing.assert_allclose(motion.attitude, free[1], rtol=0, atol=4e-9)
    turned = ph.solve(ph.Scene(**start, rotors=[always]), 1e-10).omega
    assert np.abs(turned - free[0]).max() > 0.1
    with pytest.raises(ph.InvalidInput, match="windows of time"):
        ph.Gyrostat(I, rotors=[never], omega=W)
    with pytest.raises(ph.InvalidInput, match="free=True"):
        ph.Rotor((0, 0, 1), momentum=1.0, free=True, during=empty)


def test_files_keep_empty_windows(tmp_path):
    rotor = ph.Rotor((0, 0, 1), momentum=1.0, during=[])
    push = ph.torques.During(ph.torques.Constant((1, 0, 0)), [])
    motion = ph.solve(ph.Scene(inertia=I, omega=W, times=[1.0], rotors=[rotor], torques=[push]), 1e-9)
    motion.save(tmp_path / "m.npz")
    again = ph.load(tmp_path / "m.npz").scene
    assert again.rotors == (rotor,) and again.torques == (push,)


# ---- outputs

T = np.linspace(0, 1, 50)
BIG = np.zeros(1000)
OUTS = {
    "free_motion": lambda out: ph.free_motion(I, W, Q, T, out=out),
    "free_motion, bodies": lambda out: ph.free_motion(np.tile(I, (50, 1)), W, Q, T, out=out),
    "gyrostat": lambda out: ph.gyrostat(I, (1, 0, 0), W, Q, T, out=out),
    "heavy_top": lambda out: ph.heavy_top((1, 1, 0.5), 2.0, W, Q, T, out=out),
    "step": lambda out: ph.step(I, np.tile(W, (50, 1)).astype(float), np.tile(Q, (50, 1)).astype(float), 0.1, out=out),
    "free_sensitivity": lambda out: ph.free_sensitivity(I, W, Q, T, wrt="time", out=(
        *out, np.zeros((50, 3, 1)), np.zeros((50, 3, 1)))),
}


def outs(shift):
    """Arrays (50, 3) and (50, 4) in one piece of memory, the second so many numbers behind the first."""
    return BIG[:150].reshape(50, 3), BIG[shift:shift + 200].reshape(50, 4)


@pytest.mark.parametrize("name", OUTS)
def test_outputs_that_share_memory_are_refused(name):
    for shift in (0, 1, 149):
        with pytest.raises(ph.InvalidInput, match="share memory"):
            OUTS[name](outs(shift))
    OUTS[name](outs(150))
    rows = np.zeros((50, 7))
    OUTS[name]((rows[:, :3], rows[:, 3:]))   # interleaved, apart
    assert rows.any(axis=0)[3:].any() and np.array_equal(np.linalg.norm(rows[:, 3:], axis=1).round(12), np.ones(50))


def test_derivatives_that_share_memory_are_refused():
    d = np.zeros((50, 3, 1))
    with pytest.raises(ph.InvalidInput, match="share memory"):
        ph.free_sensitivity(I, W, Q, T, wrt="time", out=(np.zeros((50, 3)), np.zeros((50, 4)), d, d))


# ---- steps

@pytest.mark.parametrize("kind, most", [("float64", 1e25), ("float32", 1e10)])
def test_a_step_that_has_no_digits_is_refused_and_any_other_has_numbers(kind, most):
    quiet = np.array(Q, kind)
    for size in (1e-30, 1.0, 1e30) + ((1e148, 1e300) if kind == "float64" else ()):
        momentum = (np.array((0.1, 0.2, 0.25)) * size).astype(kind)
        for angle in 10.0 ** np.arange(-5, 40):
            h = angle / size
            if not np.finfo(kind).tiny < h < np.finfo(kind).max:
                continue
            try:
                found = ph.step(np.array(I, kind), momentum, quiet, h)
            except ph.InvalidInput as error:
                assert "rotates by at most" in str(error) and angle > most
            else:
                assert angle < 2 * most and all(np.isfinite(part).all() for part in found)


def test_torques_count_for_the_size_of_a_step():
    with pytest.raises(ph.InvalidInput, match="rotates by at most"):
        ph.step(I, W, Q, 1e10, torque=(1e10, 0, 0))
    L, q = ph.step(I, np.array([W, (np.inf, 0, 0)], float), np.array([Q, Q], float), 0.1)
    assert np.isfinite(L[0]).all() and np.isnan(q[1]).all()   # not finite: its own NaN, no refusal of the others


# ---- JSON

def test_a_plan_beyond_float64_is_json(tmp_path):
    file = write_scene(tmp_path / "far.toml", '[[torques]]\nkind = "damping"\ndiagonal = [1e18, 1e18, 1e18]',
                       omega=(9e18, 1e18, 1e18), times="span = 1e290\nsamples = 3")
    found = subprocess.run([sys.executable, "-m", "polhode", "plan", str(file), "--json"], capture_output=True,
                           text=True)
    assert "Traceback" not in found.stderr, found.stderr
    if found.returncode == 0:
        json.loads(found.stdout, parse_constant=lambda name: pytest.fail(name))


def test_json_has_null_for_what_is_not_finite(capsys):
    pytest.importorskip("typer")
    from polhode.cli.streams import write_json

    write_json({"a": [float("nan"), (1.5, float("-inf"))], "b": {"c": float("inf")}, "d": "nan"})
    assert json.loads(capsys.readouterr().out) == {"a": [None, [1.5, None]], "b": {"c": None}, "d": "nan"}


# ---- numbers

def test_bytes_are_no_numbers():
    scene = ph.Scene(inertia=I, omega=W, times=[1.0])
    for call in (lambda: ph.lyapunov(scene, b"1"), lambda: ph.step(I, W, Q, b"1"), lambda: ph.lyapunov(scene, "1")):
        with pytest.raises(ph.InvalidInput):
            call()


def test_threads_cost_no_second_look():
    """One body at a few times takes the short way with any number of threads."""
    called = []
    short = ph._core._free_motion_of_one
    try:
        ph._core._free_motion_of_one = lambda *arguments: called.append(1) or short(*arguments)
        for threads in (None, 1, 2):
            ph.free_motion(I, W, Q, T, threads=threads)
    finally:
        ph._core._free_motion_of_one = short
    assert len(called) == 3
