"""Closed loops against mpmath, stepped from tick to tick by a route of its own (by_hand.py, make_truth.py)."""

import json
import pathlib

import loops
import numpy as np
import pytest

import polhode as ph

TRUTH = json.loads(pathlib.Path(__file__).with_name("truth.json").read_text())


def measure_error(motion, rows):
    """The error of all samples as `solve` defines it."""
    rows = np.array([[float(x) for x in row] for row in rows])
    w, q = rows[:, :3], rows[:, 3:]
    rates = np.linalg.norm(motion.omega - w, axis=1).max() / motion.omega_scale
    sign = np.sign(np.sum(motion.attitude * q, axis=1))[:, None]
    return max(rates, 2 * np.linalg.norm(sign * motion.attitude - q, axis=1).max())


def test_there_are_thirty_loops():
    assert len(loops.LOOPS) == 30 and TRUTH.keys() == loops.LOOPS.keys()


@pytest.mark.parametrize("accuracy", [1e-6, 1e-9, 1e-11])
@pytest.mark.parametrize("name", loops.LOOPS)
def test_a_loop_has_the_error_that_it_states(name, accuracy):
    motion = ph.solve(loops.make_scene(loops.LOOPS[name]), accuracy)
    assert motion.success and motion.error_kind == "bounded", motion.message
    assert measure_error(motion, TRUTH[name]) <= motion.error <= accuracy


def test_samples_do_not_move_the_loop():
    loop = loops.LOOPS["delay of 2.5 periods"]
    few = ph.solve(loops.make_scene(loop), 1e-9)
    many = ph.solve(loops.make_scene(loop, times=np.linspace(0, loop["span"], 401)), 1e-9)
    np.testing.assert_array_equal(few.ticks[0].command, many.ticks[0].command)


def test_bounds_hold_where_a_loop_amplifies():
    """Errors grow from tick to tick by the law: without its derivative, 9 of 60 of these bounds were false."""
    def law(t, m, s, p):
        return -p.u * np.tanh(p.kd * m.omega / p.u / 0.4) - 0.3 * m.attitude[:3]

    grown = 0.0
    for n in range(60):
        controller = ph.Controller(0.4 + 0.01 * n, law, parameters={"kd": 3 + 0.04 * n, "u": 0.5})
        scene = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(0.7, -0.6, 0.3 + 0.01 * n), controllers=[controller],
                         times=0.73 * np.arange(31))
        loose, tight = ph.solve(scene, 1e-8), ph.solve(scene, 1e-12)
        assert loose.error_kind == "bounded"
        apart = np.linalg.norm(loose.omega - tight.omega, axis=1).max() / tight.omega_scale
        assert apart <= loose.error + tight.error
        grown = max(grown, apart)
    assert grown > 1e-13   # some do amplify
