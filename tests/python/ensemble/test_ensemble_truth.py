"""Summaries of ensembles against NumPy and Python's exact sums on the raw states."""

import json

import ensemble_truth
import ensembles
import numpy as np
import pytest

import polhode as ph

MANY = 100_000
EVERYTHING = """
[[summary]]
of = "angle"
[[summary]]
of = "axis_angle"
axis = [0.0, 0.0, 1.0]
target = [0.0, 1.0, 1.0]
[[summary]]
of = "omega"
[[summary]]
of = "energy"
[[summary]]
of = "attitude"
"""


def compare(summary, values):
    mean, rms, least, largest = ensemble_truth.exact_sums(values)
    assert np.allclose(summary.mean, mean, rtol=1e-13) and np.allclose(summary.rms, rms, rtol=1e-13)
    assert np.allclose(summary.min, least, rtol=1e-9, atol=1e-15) and np.allclose(summary.max, largest, rtol=1e-12)
    kept = values[~np.isnan(values).any(axis=1)]
    assert (summary.count == len(kept)).all() and (summary.histogram.sum(axis=-1) == len(kept)).all()
    shares = [0.0, 1e-4, 0.1, 0.5, 0.9, 0.999, 1.0]
    exact = np.quantile(kept, shares, axis=0, method="inverted_cdf").T
    found = summary.quantile(shares)
    slack = 1e-12 * np.abs(exact)   # the values of the core and of NumPy differ by roundings
    assert (found.lower <= exact + slack).all() and (exact - slack <= found.upper).all()
    inner = found.lower > 1e-12
    assert ((found.upper / np.where(inner, found.lower, 1))[inner] < 1.0157).all()
    assert (found.lower <= found.value).all() and (found.value <= found.upper).all()


def test_certified_are_those_that_were_solved_with_a_known_error():
    from polhode._ensemble import chunk

    success, error = np.array([True, True, True, False, False]), np.array([1e-9, 3e-9, np.nan, 2e-9, np.nan])
    found = type("S", (), {"success": success, "error": error, "steps": np.full(5, 7)})
    head = dict.fromkeys(chunk.HEAD, 0.0)
    chunk._count(head, [found, found])
    assert (head["solved"], head["certified"], head["steps"], head["worst_error"]) == (6, 4, 70, 3e-9)


def test_a_start_that_is_not_drawn_is_that_of_every_body(tmp_path):
    fixed = {"omega": "[0.0, 0.1, 0.2]", "attitude": "[0.0, 0.6, 0.0, 0.8]"}
    for name in fixed:
        path = ensembles.write(tmp_path, ensembles.FREE, **{name: fixed[name], "count": 50})
        states = ph.ensemble(path, executor=0).states(range(50))
        starts = {"omega": states.omega[:, 0], "attitude": states.attitude[:, 0]}
        np.testing.assert_allclose(starts[name], np.tile(json.loads(fixed[name]), (50, 1)), atol=1e-15)
        assert all(len(np.unique(starts[other], axis=0)) == 50 for other in fixed if other != name)


def test_summaries_of_many_free_bodies_are_those_of_their_states(tmp_path):
    path = ensembles.write(tmp_path, ensembles.FREE + EVERYTHING, count=MANY, samples=3)
    run = ph.ensemble(path, executor=0)
    numbers = range(MANY)
    states, bodies = run.states(numbers), run.bodies(numbers)
    nominal = ph.free_motion([0.02, 0.03, 0.04], [0, 0, 0.2], (0, 0, 0, 1), run.times, want="attitude")
    quantities = {"angle": {"of": "angle", "nominal": nominal},
                  "axis_angle": {"of": "axis_angle", "axis": [0, 0, 1.0], "target": [0, 1.0, 1.0]},
                  "omega": {"of": "omega"}, "energy": {"of": "energy"}}
    for name, quantity in quantities.items():
        compare(run.summary[name],
                ensemble_truth.value_of(quantity, states.omega, states.attitude, bodies.inertia))
    assert run.done == run.total == run.counts["bodies"] == MANY and run.counts["failed"] == 0
    mean = run.summary["attitude"]
    for k in range(len(run.times)):
        q = states.attitude[:, k]
        values, vectors = np.linalg.eigh(np.einsum("ni,nj->ij", q, q) / MANY)
        assert abs(vectors[:, -1] @ mean.mean[k]) > 1 - 1e-12
        assert np.isclose(mean.spread[k], 2 * np.arcsin(np.sqrt(values[:3].sum())), rtol=1e-9)


def test_summaries_of_driven_bodies_are_those_of_their_states(tmp_path):
    path = ensembles.write(tmp_path, ensembles.DRIVEN + '[[summary]]\nof = "energy"\n', chunk=256, states='"none"')
    run = ph.ensemble(path, executor=0)
    states, bodies = run.states(range(500)), run.bodies(range(500))
    scene = ph.Scene(inertia=(1.0, 2.0, 2.5), omega=(0.3, 0.2, 3.0), times=run.times,
                     attitude=ph.Rotation.from_euler("ZXZ", [0.0, 0.5, 0.0]),
                     torques=[ph.torques.Gravity(2.0, (0.3, 0.2, 0.5))])
    nominal = ph.solve(scene, method="taylor", rtol=1e-10).attitude
    compare(run.summary["angle"], ensemble_truth.value_of({"of": "angle", "nominal": nominal}, states.omega,
                                                          states.attitude, bodies.inertia))
    compare(run.summary["omega"], ensemble_truth.value_of({"of": "omega"}, states.omega, None, None))
    compare(run.summary["energy"], ensemble_truth.value_of({"of": "energy"}, states.omega, None, bodies.inertia))


def test_a_body_drawn_again_has_the_motion_of_its_scene(tmp_path):
    run = ph.ensemble(ensembles.write(tmp_path, ensembles.DRIVEN, states='"none"'), executor=0, count=40)
    states = run.states([7, 8, 31])
    for row, number in enumerate((7, 8, 31)):
        one = ph.solve_many([run.scene(number)], method="taylor", rtol=1e-10)
        assert np.array_equal(one.omega[0], states.omega[row])
        assert np.array_equal(one.attitude[0], states.attitude[row])


ROTORS = """
name = "wheels"
count = 40
seed = 5
draw = "by-body"
[body]
shape = "box"
mass = 12.0
half_sides = [0.3, { uniform = [0.15, 0.25] }, 0.1]
[start]
omega = { normal = [[0.1, 0.2, 0.3], 0.05] }
[[torques]]
kind = "damping"
diagonal = { log_uniform = [1e-4, 1e-2], same = true }
[[rotors]]
axis = { sphere = 1.0 }
momentum = { normal = [0.3, 0.05] }
[times]
span = 20.0
samples = 5
[solve]
accuracy = 1e-8
[[summary]]
of = "omega"
[[summary]]
of = "attitude"
"""


def test_any_number_of_a_scene_may_be_drawn_and_certificates_are_counted(tmp_path):
    path = tmp_path / "wheels.toml"
    path.write_text(ROTORS)
    run = ph.ensemble(path, executor=0)
    assert run.counts["solved"] == run.counts["certified"] == 40 and run.certified == 1.0
    assert 0 < run.counts["worst_error"] <= 1e-8 and run.counts["steps"] > 0
    drawn = run.bodies(range(40)).values
    scene, states = run.scene(11), run.states([11])
    assert np.array_equal(scene.torques[0].matrix, np.eye(3) * drawn["torques.0.diagonal"][11])
    assert np.allclose(scene.rotors[0].__getstate__()[1], drawn["rotors.0.momentum"][11])
    single = ph.solve(scene, 1e-8)
    assert np.array_equal(single.omega, states.omega[0]) and states.error[0] == single.error
    compare(run.summary["omega"],
            ensemble_truth.value_of({"of": "omega"}, run.states(range(40)).omega, None, None))


def test_a_body_that_fails_fails_alone(tmp_path):
    text = ROTORS.replace("[solve]\naccuracy = 1e-8", '[solve]\nmethod = "rk45"\nrtol = 1e-6\nmax_steps = 85')
    path = tmp_path / "few.toml"
    path.write_text(text.replace("normal = [[0.1, 0.2, 0.3], 0.05]", "normal = [0.0, 0.5]"))
    run = ph.ensemble(path, executor=0)
    states = run.states(range(40))
    late = states.status == 2
    assert 0 < late.sum() < 40 and run.counts["failed"] == late.sum()
    assert np.isnan(states.omega[late, -1]).all() and np.isfinite(states.omega[~late]).all()
    assert run.summary["omega"].count[0] == 40 and run.summary["omega"].count[-1] == 40 - late.sum()


def test_a_sweep_has_the_same_draws_at_each_point(tmp_path):
    text = ensembles.DRIVEN + "[sweep]\n\"torques.0.weight\" = [1.0, 2.0]\n"
    run = ph.ensemble(ensembles.write(tmp_path, text, states='"none"'), executor=0, count=70)
    plain = ph.ensemble(ensembles.write(tmp_path, ensembles.DRIVEN, states='"none"', name="plain.toml"), executor=0,
                        count=70)
    assert run.points == ({"torques.0.weight": 1.0}, {"torques.0.weight": 2.0}) and run.total == 140
    assert np.array_equal(run.bodies(range(70), point=0).omega, run.bodies(range(70), point=1).omega)
    assert run.summary["angle"].mean.shape == (2, 11)
    assert np.array_equal(run.summary["angle"].mean[1], plain.summary["angle"].mean)
    assert not np.array_equal(run.summary["angle"].mean[0], plain.summary["angle"].mean)


@pytest.mark.parametrize("wrong", [1.5, -0.1, [[0.5]], float("nan")])
def test_quantiles_outside_0_to_1_are_refused(tmp_path, wrong):
    run = ph.ensemble(ensembles.write(tmp_path, ensembles.FREE), executor=0, count=10)
    with pytest.raises(ph.InvalidInput, match="q: must be numbers from 0 to 1"):
        run.summary["angle"].quantile(wrong)
    with pytest.raises(KeyError, match="must be one of omega, angle"):
        run.summary["angel"]


def test_the_first_bodies_of_more_are_the_same(tmp_path):
    path = ensembles.write(tmp_path, ensembles.FREE)
    few, many = ph.ensemble(path, executor=0, count=1000), ph.ensemble(path, executor=0, count=5000)
    assert np.array_equal(few.states(range(1000)).attitude, many.states(range(1000)).attitude)
    with pytest.raises(ph.InvalidInput, match="numbers: must be one or more of 0 to 999"):
        few.states([1000])
