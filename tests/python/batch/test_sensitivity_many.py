"""Derivatives of many bodies: the bits of one at a time, whatever fails beside them."""

import numpy as np
import pytest

import polhode as ph

T = ph.torques
TIMES, RNG = np.linspace(0, 5, 6), np.random.default_rng(11)
OMEGA, ATTITUDE = RNG.normal(size=(9, 3)), RNG.normal(size=(9, 4))
MOMENTS = np.sum(RNG.uniform(0.2, 1, (9, 1, 3)) * (1 - np.eye(3)), axis=2)


def steer(t, omega, attitude, p, s):
    return -p.kp * attitude[:3] * attitude[3] - s.h, {"h": omega}


TORQUES = {
    "free": ((), ("omega", "axes", "inertia")),
    "heavy": ((T.Gravity(1.0, (0.1, 0, 1)),), ("attitude", "torques.0.weight")),
    "window": ((T.During(T.Constant((0, 0.1, 0)), [(1, 3)]),), "torques.0.windows"),
    "formula": ((T.Formula(steer, kp=0.3, states={"h": (0, 0.1, 0)}),),
                ("omega", "formula.kp", "states.h")),
}


def scene_of(kind):
    return ph.Scene(inertia=(1, 2, 2.5), omega=(1, 2, 3), torques=TORQUES[kind][0], times=TIMES)


def same(many, i, one):
    for name in ("omega", "attitude", "d_omega", "d_attitude"):
        np.testing.assert_array_equal(getattr(many, name)[i], getattr(one, name))
    assert many.columns == one.columns and many.side == one.side and set(many.d_states) == set(one.d_states)
    for name, part in one.d_states.items():
        np.testing.assert_array_equal(many.d_states[name][i], part)
    assert one.error is None or np.array_equal(many.error[i], one.error)


@pytest.mark.parametrize("threads", [1, 3])
@pytest.mark.parametrize("side", ["space", "body"])
@pytest.mark.parametrize("kind", TORQUES)
def test_the_bits_of_one_at_a_time(kind, side, threads):
    scene, by = scene_of(kind), TORQUES[kind][1]
    attitudes = ATTITUDE / np.linalg.norm(ATTITUDE, axis=1, keepdims=True)
    found = ph.solve_many(scene, inertia=MOMENTS, omega=OMEGA, attitude=attitudes, accuracy=1e-8, sensitivity=by,
                          side=side, threads=threads)
    assert found.success.all() and (kind == "free") == (found.sensitivity.error is None)
    for i in (0, 4, 8):
        own = scene.replace(inertia=MOMENTS[i], omega=OMEGA[i], attitude=attitudes[i])
        same(found.sensitivity, i, ph.solve(own, 1e-8, sensitivity=by, side=side).sensitivity)


def test_scenes_of_their_own():
    scenes = [scene_of("heavy"), scene_of("free"), scene_of("window")]
    found = ph.solve_many(scenes, sensitivity=("omega", "inertia")).sensitivity
    for i in (0, 1):
        one = ph.solve(scenes[i], 1e-9, sensitivity=("omega", "inertia")).sensitivity
        np.testing.assert_array_equal(found.d_omega[i], one.d_omega)
    assert np.isnan(found.error[1]).all() and np.isfinite(found.error[[0, 2]]).all()


def test_a_body_that_fails_is_alone():
    omega = OMEGA[:3].copy()
    omega[1] = np.nan
    found = ph.solve_many(scene_of("heavy"), omega=omega, sensitivity="omega", errors="nan")
    assert found.refused.tolist() == [False, True, False]
    assert np.isnan(found.sensitivity.d_omega[1]).all() and np.isfinite(found.sensitivity.d_omega[[0, 2]]).all()
    few = ph.solve_many(scene_of("heavy"), omega=OMEGA, sensitivity="omega", max_steps=2)
    assert np.isnan(few.sensitivity.d_omega).all() and all("no derivatives: " in text for text in few.message)


@pytest.mark.parametrize(("wrong", "words"), [
    ({"sensitivity": "torques.7.weight"}, "body 0"), ({"sensitivity": ""}, "must be names"),
    ({"sensitivity": ("omega", "omega")}, "once"), ({"sensitivity": "omega", "side": "left"}, "side"),
    ({"sensitivity": "omega", "rtol": 1e-6}, "rtol: must be left out"), ({"sensitivity": 3}, "must be names")])
def test_what_is_refused(wrong, words):
    with pytest.raises(ph.InvalidInput, match=words):
        ph.solve_many(scene_of("heavy"), omega=OMEGA, **wrong)


def test_other_numbers_in_other_scenes():
    with pytest.raises(ph.InvalidInput, match="of the same numbers"):
        ph.solve_many([scene_of("formula"), scene_of("heavy")], sensitivity="omega")


def test_no_bodies():
    assert ph.solve_many(scene_of("heavy"), omega=np.zeros((0, 3)), sensitivity="omega").sensitivity is None
