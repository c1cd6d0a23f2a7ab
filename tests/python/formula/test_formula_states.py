"""States of formulas: their truth, their errors, and everything that holds their numbers."""

import json
import pickle
from pathlib import Path

import numpy as np
import pytest
from scene_files import write_scene

import polhode as ph
from polhode.formula import norm, to_body, to_space
from polhode.torques import During, Formula, Gravity

TRUTH = json.loads((Path(__file__).parents[2] / "reference" / "formula_motion.json").read_text())
START, TIMES = TRUTH["start"], np.array(TRUTH["times"])
Q = np.array(START["attitude"]) / np.linalg.norm(START["attitude"])
CASES = [case for case in TRUTH["cases"] if len(case["rows"][0]) > 7]
BLOCK = np.diag([1.0, 2.0, 2.5])


def wheels(t, omega, attitude, p, s):
    u = p.limit * np.tanh((-p.kp * attitude[:3] * attitude[3] - p.kd * omega) / p.limit)
    return u - np.cross(omega, s.h), {"h": -u}


def orbit(t, omega, attitude, p, s):
    size = norm(s.r)
    up = to_body(attitude, s.r / size)
    tide = 3 * p.mu / size**3 * np.cross(up, [up @ np.array(p.inertia[3 * i : 3 * i + 3]) for i in range(3)])
    field = (3 * (np.array([0.1, 0, 1]) @ s.r) / size * s.r / size - np.array([0.1, 0, 1])) / size**3
    return tide + np.cross(p.moment, to_body(attitude, field)), {"r": s.v, "v": -p.mu * s.r / size**3}


def integral(t, omega, attitude, p, s):
    return -p.kp * attitude[:3] * attitude[3] - p.kd * omega - p.ki * s.e, {"e": attitude[:3] * attitude[3]}


LAWS = {
    "wheels": (wheels, {"h": (0.01, 0.02, 0.03)}, dict(limit=0.05, kp=0.2, kd=0.5)),
    "orbit": (orbit, {"r": (1.0, 0.2, -0.1), "v": (0.1, 0.5, 0.3)}, dict(mu=0.5, moment=(0.05, -0.02, 0.03))),
    "integral": (integral, {"e": (0.0, 0.0, 0.0)}, dict(kp=0.7, kd=0.9, ki=0.1)),
}


def make(law, inertia=BLOCK):
    function, states, parameters = LAWS[law]
    if law == "orbit":
        parameters = dict(parameters, inertia=tuple(np.ravel(inertia)))
    return Formula(function, states=states, **parameters)


def scene(torques, inertia=BLOCK, **more):
    return ph.Scene(**dict(dict(inertia=np.array(inertia), omega=START["omega"], attitude=Q, torques=torques,
                                times=TIMES), **more))


@pytest.mark.parametrize("case", CASES, ids=lambda case: f"{case['law']}-{case['inertia'][0][1]}")
@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12])
def test_the_bound_holds_of_the_states_too(case, accuracy):
    rows = np.array(case["rows"], dtype=float)
    motion = ph.solve(scene([make(case["law"], case["inertia"])], case["inertia"]), accuracy)
    assert motion.success and motion.error_kind == "bounded" and motion.error <= accuracy
    assert motion.plan.method == "taylor"
    start = np.linalg.norm(START["omega"])
    size = max(start, np.linalg.norm(rows[:, :3], axis=1).max())
    assert np.linalg.norm(motion.omega - rows[:, :3], axis=1).max() <= motion.error * size
    sign = np.sign(np.sum(rows[:, 3:7] * motion.attitude, axis=1))[:, None]
    assert 2 * np.linalg.norm(motion.attitude - sign * rows[:, 3:7], axis=1).max() <= motion.error
    begin = 7
    for name, state in motion.states.items():
        want = rows[:, begin : begin + 3]
        begin += 3
        largest = max(np.abs(want).max(), np.abs(np.array(LAWS[case["law"]][1][name])).max())
        assert np.abs(state - want).max() <= 2 * motion.error * largest + 1e-16


def test_wheels_keep_the_angular_momentum():
    motion = ph.solve(scene([make("wheels")], times=np.linspace(0, 100, 50)), 1e-11)
    L = motion.rotation.apply(motion.omega @ BLOCK + motion.states["h"])
    np.testing.assert_allclose(L, L[:1] * np.ones((50, 1)), atol=1e-11)


def test_pieces_hand_the_states_on_in_both_directions():
    window = During(Gravity(0.3, (0.1, 0.2, 0.3)), [(-0.5, 0.25), (1.0, 2.0)])
    for torques in ([make("integral"), window], [window, make("integral")]):
        motion = ph.solve(scene(torques), 1e-10, dense=True)
        assert len(motion.plan.pieces) > 3 and motion.error_kind == "bounded"
        # the same by one piece after another
        state, at = {}, {"omega": START["omega"], "attitude": Q, "states": {"e": (0.0, 0.0, 0.0)}}
        for begin, end, on in [(0, 0.25, True), (0.25, 1.0, False), (1.0, 2.0, True), (2.0, 8.0, False)]:
            function, _, parameters = LAWS["integral"]
            own = Formula(function, states=at["states"], **parameters)
            part = scene([own, window.torque] if on else [own], omega=at["omega"], attitude=at["attitude"], t0=begin,
                         times=[end])
            last = ph.solve(part, 1e-12)
            at = {"omega": last.omega[-1], "attitude": last.attitude[-1], "states": {"e": last.states["e"][-1]}}
        np.testing.assert_allclose(motion.states["e"][-1], at["states"]["e"], atol=1e-9)
        np.testing.assert_allclose(motion.omega[-1], at["omega"], atol=1e-9)
        dense = motion.states_at(TIMES)
        np.testing.assert_allclose(dense["e"], motion.states["e"], atol=1e-12)
        assert state == {}


def test_two_formulas_share_a_state_of_one_name_and_one_law():
    def own(t, omega, attitude, p, s):
        return p.k * s.x * omega, {"x": -s.x}

    a, b = Formula(own, states={"x": 1.0}, k=0.1), Formula(own, states={"x": 1.0}, k=-0.2)
    motion = ph.solve(scene([a, b], times=[1.0, 3.0]), 1e-10)
    assert list(motion.states) == ["x"]
    np.testing.assert_allclose(motion.states["x"], np.exp([-1.0, -3.0]), atol=1e-10)
    with pytest.raises(ph.InvalidInput, match=r"torques\[1\].states.x: must be as in the torques before it"):
        scene([a, Formula(own, states={"x": 2.0}, k=1)])

    def other(t, omega, attitude, p, s):
        return p.k * s.x * omega, {"x": -2 * s.x}

    with pytest.raises(ph.InvalidInput, match="name states of different torques differently"):
        ph.solve(scene([a, Formula(other, states={"x": 1.0}, k=1)]), 1e-6)


def test_states_in_tables_files_events_and_scenes(tmp_path):
    given = scene([make("wheels")])
    assert {name: list(start) for name, start in given.states.items()} == {"h": [0.01, 0.02, 0.03]}
    event = ph.Event(lambda t, omega, attitude, states: states["h"][0] - 0.05)
    motion = ph.solve(given, 1e-9, dense=True, events=[event, lambda t, omega, attitude: omega[0]])
    assert all(abs(hit.states["h"][0] - 0.05) < 1e-8 for hit in motion.events if hit.event == 0)
    assert any(hit.event == 0 for hit in motion.events)
    table = motion.to_pandas()
    np.testing.assert_array_equal(table[["h_0", "h_1", "h_2"]], motion.states["h"])
    np.testing.assert_array_equal(motion.to_xarray()["h"], motion.states["h"])
    for name in ("motion.npz", "motion.zarr"):
        motion.save(tmp_path / name)
        again = ph.load(tmp_path / name)
        np.testing.assert_array_equal(again.states["h"], motion.states["h"])
        assert again.scene == given and len(again.events) == len(motion.events)
    given.save(tmp_path / "scene.toml")
    loaded = ph.Scene.load(tmp_path / "scene.toml")
    assert loaded == given
    np.testing.assert_array_equal(ph.solve(loaded, 1e-9).states["h"], ph.solve(given, 1e-9).states["h"])
    assert pickle.loads(pickle.dumps(given)) == given
    torque = make("wheels")
    h = np.array([0.4, -0.1, 0.2])
    want = wheels(0.0, np.array([1.0, 2.0, 3.0]), Q, type("P", (), dict(limit=0.05, kp=0.2, kd=0.5)),
                  type("S", (), dict(h=h)))
    np.testing.assert_allclose(torque.value(0, (1, 2, 3), Q, states={"h": h}), want[0], atol=1e-15)
    np.testing.assert_allclose(given.torque(0, (1, 2, 3), Q, states={"h": h}), want[0], atol=1e-15)
    np.testing.assert_allclose(torque.rates(0, (1, 2, 3), Q, states={"h": h})["h"], want[1]["h"], atol=1e-15)
    assert eval(repr(torque), {"polhode": ph}) == torque


def test_scene_files_with_states_and_potentials(tmp_path):
    path = write_scene(tmp_path / "own.toml", omega=(0.3, 1, -0.2), times="span = 5\nsamples = 3", tables="""
[[torques]]
kind = "formula"
torque = "-k * s * omega"
parameters = { k = 0.5 }
states = { s = { start = 1.0, rate = "-s" } }
[[torques]]
kind = "formula"
potential = "weight * to_space(arm).z"
parameters = { weight = 2, arm = [0.3, 0.2, 0.5] }
recognise = false
""")
    own = ph.Scene.load(path)
    motion = ph.solve(own, 1e-9)
    np.testing.assert_allclose(motion.states["s"], np.exp(-motion.t), atol=1e-9)
    own.save(tmp_path / "again.toml")
    assert ph.Scene.load(tmp_path / "again.toml") == own


@pytest.mark.parametrize("recognise", [True, False])
def test_a_potential_gives_the_torque_and_keeps_the_energy(recognise):
    def potential(t, attitude, p):
        return p.weight * to_space(attitude, p.arm)[2]

    gravity = Gravity(2.0, (0.3, 0.2, 0.5))
    own = Formula(potential=potential, recognise=recognise, weight=2.0, arm=(0.3, 0.2, 0.5))
    text = Formula(potential="weight * to_space(arm).z", recognise=recognise, weight=2.0, arm=(0.3, 0.2, 0.5))
    np.testing.assert_allclose(own.energy(0, Q), text.energy(0, Q), rtol=1e-15)
    np.testing.assert_allclose(own.value(0, (0, 0, 0), Q), gravity.value(0, (0, 0, 0), Q), atol=1e-15)
    assert own.traits["has_potential"] and own.potential and own.text == ""
    motion = ph.solve(scene([own]), 1e-9)
    np.testing.assert_allclose(motion.omega, ph.solve(scene([gravity]), 1e-10).omega, atol=3e-9)
    assert motion.drift["energy"] < 1e-8
    assert pickle.loads(pickle.dumps(own)) == own and eval(repr(own), {"polhode": ph}) == own
    magnet = Formula(potential=lambda t, q, p: -np.dot(p.m, to_body(q, (np.cos(t), np.sin(t), 0.3))), m=(0.1, 0.2, 0.3))
    field = ph.Rotation.from_quat(Q).inv().apply((np.cos(0.7), np.sin(0.7), 0.3))
    np.testing.assert_allclose(magnet.value(0.7, (0, 0, 0), Q), np.cross((0.1, 0.2, 0.3), field), atol=1e-15)


@pytest.mark.parametrize(("arguments", "message"), [
    (dict(function=lambda t, w, q, p, s: w, states={"h": 1.0}), r"must return \(torque, rates of the states\)"),
    (dict(function=lambda t, w, q, p, s: (w, {}), states={"h": 1.0}), r"the rate of each state \(h\), got none"),
    (dict(function=lambda t, w, q, p, s: (w, {"h": w}), states={"h": 1.0}), r"the rate of h of shape \(\)"),
    (dict(function=lambda t, w, q, p: w, states={"h": 1.0}), r"callable as function\(t, omega, attitude, p, s\)"),
    (dict(function=lambda t, w, q, p, s: (s.g * w, {"h": 0 * t}), states={"h": 1.0}), "use states that are given"),
    (dict(text="h * omega", states={"h": 1.0}), "start.*rate"),
    (dict(text="h * omega", states={"h": {"start": 1.0, "rate": "[h, h]"}}), "states.h.rate"),
    (dict(text="h * omega", states={"h": {"start": float("nan"), "rate": "h"}}), "finite"),
    (dict(text="omega", states=3), "a dict"),
    (dict(text="omega", potential="attitude.x"), "one of them, got several"),
    (dict(potential="omega.x"), "a function of time and attitude"),
    (dict(potential="attitude.x", states={"h": 1.0}), "left out for a potential"),
    (dict(potential=lambda t, q, p: q), r"a potential of shape \(\)"),
    (dict(text="scale * omega", scale=1.0), "a reserved name"),
    (dict(function=lambda t, w, q, p, s: (w, {"h": -s.h}), states={"h": list(range(60))}), "at most 56 numbers"),
])
def test_refusals(arguments, message):
    with pytest.raises(ph.InvalidInput, match=message):
        Formula(**arguments)


def test_states_are_refused_where_they_have_no_meaning_yet():
    own = make("wheels")
    with pytest.raises(ph.InvalidInput, match="a torque without states"):
        During(own, [(0, 1)])
    with pytest.raises(ph.InvalidInput, match="taylor integrates them"):
        ph.solve(scene([own]), method="dop853", rtol=1e-9)
    with pytest.raises(ph.InvalidInput, match="states"):
        own.value(0, (1, 2, 3), Q, states={"g": 1.0})
