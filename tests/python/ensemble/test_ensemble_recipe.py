"""Recipes of ensembles: what may be drawn or swept, what is refused by its name, and what the hash depends on."""

import math
import tomllib

import ensembles
import meshes
import numpy as np
import pytest

import polhode as ph
from polhode._ensemble import distributions, recipe

GOOD = tomllib.loads(ensembles.FREE)


def changed(**tables):
    """The content of a recipe with other tables; None leaves one out."""
    content = {**GOOD, **tables}
    return {key: value for key, value in content.items() if value is not None}


def made(**tables):
    return recipe.from_content(changed(**tables), ".", "mine.toml")


REFUSED = [
    ({"draw": None}, "mine.toml: draw: must be 'by-body' for an ensemble"),
    ({"draw": "whole-arrays"}, "mine.toml: draw: must be 'by-body' for an ensemble"),
    ({"count": 0}, "mine.toml: count: "),
    ({"seed": -1}, "mine.toml: seed: "),
    ({"couunt": 3}, "mine.toml: couunt: unknown key, did you mean 'count'?"),
    ({"start": {"omega": {"normal": [0.0]}}}, "mine.toml: start.omega: normal: "),
    ({"start": {"omega": {"normal": [0.0, -1.0]}}}, "start.omega.normal: must have a deviation of 0 or more"),
    ({"start": {"omega": {"uniform": [1.0, 0.0]}}}, "start.omega.uniform: must have low <= high, got 1 and 0"),
    ({"start": {"omega": {"log_uniform": [0.0, 1.0]}}}, "start.omega.log_uniform: must have positive bounds"),
    ({"start": {"omega": {"normal": [[0.0, 1.0], 1.0]}}}, "omega.normal: must have 3 numbers in each list, got 2"),
    ({"start": {"omega": {"normal": [0.0, 1.0], "uniform": [0.0, 1.0]}}}, "give one of uniform, normal"),
    ({"start": {"omega": {"sphere": 0.0}}}, "sphere: must be the positive length"),
    ({"start": {"omegga": [0, 0, 1.0]}}, "start.omegga: unknown key, did you mean 'omega'?"),
    ({"start": {"omega": [0, 0, 1.0], "attitude": {"uniform": "ball"}}}, "start.attitude: uniform: "),
    ({"start": {"omega": [0, 0, 1.0], "attitude": {"normal_deg": -3.0}}}, "must have deviations of 0 or more"),
    ({"body": {"moments_relative": {"normal": [0.0, 0.1]}}}, "body.moments_relative: must stand beside 'moments'"),
    ({"body": {"shape": "box", "mass": {"sphere": 1.0}}}, "body.mass: sphere must stand in place of a vector"),
    ({"sweep": {"torques.0.weight": [1.0]}}, "sweep: must name numbers of the file"),
    ({"sweep": {"times.span": [1.0]}}, "sweep: must name numbers of the file"),
    ({"summary": [{"of": "anggle"}]}, "summary.0.of: "),
    ({"summary": [{"of": "axis_angle"}]}, "axis: missing for axis_angle"),
    ({"summary": [{"of": "omega", "nominal": "undisturbed"}]}, "nominal: must be left out for omega"),
    ({"summary": [{"of": "omega"}, {"of": "omega"}]}, "summary.1.name: must differ from the others, got 'omega'"),
    ({"summary": [{"of": "angle", "nominal": [0, 0, 0, 2.0]}]}, "must be a unit quaternion, got the length 2"),
    ({"summary": []}, "summary: must have one table or more"),
    ({"store": {"chunk": 1000}}, "store: chunk: must be a power of two, got 1000"),
    ({"store": {"states": "float16"}}, "store.states: "),
    ({"store": {"every": 2}}, "every: must be left out where no states are stored"),
    ({"solve": {"accuracy": -1.0}}, "solve.accuracy: "),
]


@pytest.mark.parametrize("tables, message", REFUSED, ids=[message[:60] for _, message in REFUSED])
def test_a_wrong_recipe_is_refused_by_name(tables, message):
    with pytest.raises(ph.InvalidInput) as refused:
        made(**tables)
    assert message in str(refused.value) and "\n" not in str(refused.value)


def test_a_uniform_attitude_has_no_middle():
    uniform = {"omega": [0.0, 0.0, 1.0], "attitude": {"uniform": "sphere"}}
    with pytest.raises(ph.InvalidInput, match="nominal: must be a quaternion, because start.attitude has no middle"):
        made(start=uniform, summary=[{"of": "angle"}])
    assert [wanted.of for wanted in made(start=uniform).wanted] == ["omega", "attitude"]
    assert [wanted.of for wanted in made().wanted] == ["omega", "angle"]


def test_s8_keeps_its_whole_arrays_and_is_no_ensemble():
    assert ph.recipe.load_recipe("S8").draw(5).omega.shape == (5, 3)
    with pytest.raises(ph.InvalidInput, match="S8.toml: draw: must be 'by-body'"):
        ph.ensemble("S8", executor=0)


def test_middles_are_those_of_the_distributions():
    point = made(
        body={"shape": "box", "mass": {"log_uniform": [1.0, 4.0]}, "half_sides": [{"uniform": [1.0, 2.0]}, 1.0, 0.5]},
        start={"omega_deg": {"truncated_normal": [10.0, 1.0, [0.0, 0.0, 11.0], 20.0]},
               "attitude": {"normal_deg": 3.0}, "euler": {"sequence": "ZXZ", "angles": [0.1, 0.2, 0.3]}},
        torques=[{"kind": "damping", "diagonal": {"uniform": [1.0, 3.0], "same": True}}],
        rotors=[{"axis": {"sphere": 1.0}, "momentum": 0.3, "momentum_relative": {"normal": [0.5, 0.1]}}],
    ).points[0]
    assert point.data["body"]["mass"] == 2.0 and point.data["body"]["half_sides"] == [1.5, 1.0, 0.5]
    assert point.data["start"]["omega_deg"] == [10.0, 10.0, 11.0]
    assert point.data["torques"][0]["diagonal"] == [2.0, 2.0, 2.0]
    assert math.isclose(point.data["rotors"][0]["momentum"], 0.45)
    assert np.array_equal(point.nominal.attitude, ph.Rotation.from_euler("ZXZ", [0.1, 0.2, 0.3]).as_quat())
    assert point.without_middle == ["rotors.0.axis"]
    assert {quantity.key for quantity in point.quantities} == {
        "body.mass", "body.half_sides.0", "start.omega_deg", "start.attitude", "torques.0.diagonal", "rotors.0.axis",
        "rotors.0.momentum"}


def test_a_sweep_is_a_grid():
    spec = made(torques=[{"kind": "damping", "diagonal": [1e-5, 1e-5, 1e-5]}],
                sweep={"torques.0.diagonal": [[1e-5] * 3, [1e-4] * 3],
                       "body.moments": [[0.02, 0.03, 0.04], [1, 2, 2.5]]})
    assert len(spec.points) == 4 and spec.points[3].settings["body.moments"] == [1, 2, 2.5]
    assert spec.points[2].data["torques"][0]["diagonal"] == [1e-4] * 3


def test_the_hash_depends_on_what_numbers_depend_on():
    first = made().hash
    assert made(name="another", title="a title", about="a text").hash == first
    others = [made(seed=9), made(count=19999), made(store={"chunk": 8192}), made(times={"span": 100.0, "samples": 7})]
    assert len({first, *(spec.hash for spec in others)}) == 5


def test_the_hash_depends_on_the_mesh_and_not_on_its_folder(tmp_path):
    hashes = []
    for name, size in (("a", 1.0), ("b", 1.0), ("c", 1.1)):
        folder = tmp_path / name
        folder.mkdir()
        (folder / "box.stl").write_bytes(meshes.binary_stl(meshes.box(high=(size, size, size))))
        hashes.append(recipe.from_content(changed(body={"mesh": "box.stl", "mass": 1.0}), str(folder), "x").hash)
    assert hashes[0] == hashes[1] != hashes[2]


def test_every_kind_has_its_parameters():
    assert set(distributions.NUMBERS) | {"sphere", "normal_deg"} == distributions.WORDS


@pytest.mark.parametrize("options, message", [
    ('accuracy = 1e-9\nrtol = 1e-9', "accuracy"), ('method = "rk46"', "method"), ('step = 0.1', "step")])
def test_wrong_options_of_solve_are_refused_before_any_chunk(tmp_path, options, message):
    text = ensembles.DRIVEN.replace('method = "taylor"\nrtol = 1e-10', options).replace('"float64"', '"none"')
    path = tmp_path / "recipe.toml"
    path.write_text(text)
    with pytest.raises(ph.InvalidInput, match=message):
        ph.ensemble(path, executor=0)


def test_histograms_that_need_too_much_memory_are_refused(tmp_path):
    path = ensembles.write(tmp_path, ensembles.FREE, samples=1_000_000)
    with pytest.raises(ph.InvalidInput, match="the histograms of 1000000 times at 1 points need .* bytes") as refused:
        ph.ensemble(path, executor=0)
    assert "least and largest narrow a histogram" in str(refused.value)
    narrow = '[[summary]]\nof = "omega"\nleast = 0.0625\nlargest = 0.25\n'
    assert ph.ensemble(ensembles.write(tmp_path, ensembles.FREE + narrow, samples=1000), executor=0, count=3).done == 3


def test_bodies_on_an_orbit_are_those_of_solve():
    """An eccentric orbit in a recipe: a body drawn alone, by solve, is the body of the ensemble."""
    orbits = {"main": {"mu": 3.986e14, "a": 7e6, "e": 0.1, "inclination": 0.9}}
    own = made(orbits=orbits, torques=[{"kind": "gravity_gradient", "orbit": "main"}], summary=None,
               body={"moments": [20.0, 40.0, 52.0]}, start={"omega": {"normal": [[2e-3, 4e-3, 6e-3], 1e-3]}},
               times={"span": 3000.0, "samples": 4}, solve={"accuracy": 1e-9})
    done = ph.ensemble(own, executor=0, count=None)
    states, scene = done.states(range(3)), done.scene(2)
    motion = ph.solve(scene, accuracy=1e-11)
    assert type(scene.torques[0]).__name__ == "OrbitGradient"
    assert np.abs(states.omega[2] - motion.omega).max() < 1e-9 * motion.omega_scale
    free = ph.solve(scene.replace(torques=[]))
    assert np.abs(free.omega - motion.omega).max() > 1e-5 * motion.omega_scale


def test_an_orbit_that_the_recipe_does_not_have_is_refused():
    with pytest.raises(ph.InvalidInput, match="orbit: must name a table of .orbits., got 'moon'"):
        made(torques=[{"kind": "gravity_gradient", "orbit": "moon"}])
