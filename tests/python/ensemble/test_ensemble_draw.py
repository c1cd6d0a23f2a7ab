"""Draws of ensembles: each body from its own number, whatever the cut, with the stated distributions."""

import os
import subprocess
import sys
import tomllib

import ensembles
import numpy as np
import pytest

import polhode as ph
from polhode._ensemble import draw, recipe

stats = pytest.importorskip("scipy.stats")
GOOD = tomllib.loads(ensembles.FREE)


def made(**tables):
    return recipe.from_content({**GOOD, **tables}, ".", "mine.toml")


def drawn(spec, first=0, count=20000):
    return draw.draw(spec, spec.points[0], first, count)


def test_bits_do_not_depend_on_the_cut():
    spec = made()
    whole = drawn(spec, 0, 3000)
    for first, count in ((0, 1), (17, 23), (1024, 1976)):
        part = drawn(spec, first, count)
        for path, values in part.values.items():
            assert np.array_equal(values, whole.values[path][first:first + count]), path
        assert np.array_equal(part.attempts, whole.attempts[first:first + count])


def test_another_quantity_shifts_none():
    plain, more = made(), made(torques=[{"kind": "damping", "diagonal": {"log_uniform": [1e-5, 1e-3]}}],
                               body={"moments": [0.02, 0.03, 0.04]})
    for path in (("start", "omega"), ("start", "attitude")):
        assert np.array_equal(drawn(plain, 0, 500).values[path], drawn(more, 0, 500).values[path])


def test_a_body_that_cannot_be_is_drawn_again_alone():
    wide = made(body={"moments": [0.02, 0.03, 0.04], "moments_relative": {"normal": [0.0, 0.3]}})
    bodies = drawn(wide)
    moments = bodies.values["body", "moments"]
    again = bodies.attempts > 0
    assert 0.1 < again.mean() < 0.5 and not bodies.impossible.any()
    assert (moments > 0).all() and (2 * moments.max(axis=1) <= moments.sum(axis=1) * (1 + 1e-15)).all()
    (quantity,) = [q for q in wide.points[0].quantities if q.path == ("body", "moments")]
    first = draw._draw(quantity, wide.seed, 0, len(moments))
    assert np.array_equal(moments[~again], first[~again]) and (moments[again] != first[again]).any(axis=1).all()


def test_plates_of_any_size_are_taken_as_an_inertia_tensor_takes_them():
    flat = {"moments": [0.02, 0.03, 0.05], "moments_relative": {"uniform": [-0.5, 0.5], "same": True}}
    plates = drawn(made(body=flat))
    a, b, c = plates.values["body", "moments"].T
    assert (a + b < c).sum() > 1000   # by rounding
    assert not plates.attempts.any() and not plates.impossible.any()
    for moments in plates.values["body", "moments"][a + b < c][:20]:
        ph.InertiaTensor.from_moments(moments)
    beyond = np.array([[1.0, 2.0, 3.0 * (1 + excess)] for excess in (0.9e-12, 1.1e-12)])
    assert draw._are_possible(beyond, True).tolist() == [True, False]
    assert draw._are_possible(beyond, False).all()


def test_shapes_that_cannot_be_are_drawn_again():
    spec = made(body={"shape": "box", "mass": 1.0, "half_sides": [0.3, 0.2, {"normal": [0.1, 0.1]}]})
    bodies = drawn(spec, 0, 200)
    thin = bodies.values["body", "half_sides", 2]
    assert (thin > 0).all() and (bodies.attempts > 0).sum() > 10
    expected = [ph.shapes.box(mass=1.0, half_sides=[0.3, 0.2, side]).inertia.moments for side in thin]
    assert np.array_equal([tensor.moments for tensor in bodies.inertia], expected)


def test_hopeless_bodies_are_given_up_and_counted(tmp_path, monkeypatch):
    monkeypatch.setattr(draw, "MOST_ATTEMPTS", 1)
    path = ensembles.write(tmp_path, ensembles.FREE, count=400, moments_relative="{ normal = [0.0, 0.3] }")
    run = ph.ensemble(path, executor=0)
    numbers = np.arange(400)
    states = run.states(numbers)
    lost = np.array([states.status == 5]).ravel()
    assert 3 < run.counts["impossible"] == lost.sum() == run.counts["failed"] < 100
    assert np.isnan(states.omega[lost]).all() and np.isfinite(states.omega[~lost]).all()
    assert (run.summary["omega"].count == 400 - lost.sum()).all()


LAWS = [
    ({"uniform": [[1.0, -1.0, 0.0], [2.0, 1.0, 5.0]]},
     [stats.uniform(1, 1), stats.uniform(-1, 2), stats.uniform(0, 5)]),
    ({"normal": [[0.0, 1.0, -2.0], 0.5]}, [stats.norm(mean, 0.5) for mean in (0.0, 1.0, -2.0)]),
    ({"log_uniform": [1e-3, 1e2]}, [stats.loguniform(1e-3, 1e2)] * 3),
    ({"truncated_normal": [0.0, 1.0, -0.5, 2.0]}, [stats.truncnorm(-0.5, 2.0)] * 3),
]


@pytest.mark.parametrize("table, laws", LAWS, ids=[next(iter(table)) for table, _ in LAWS])
def test_draws_have_their_distributions(table, laws):
    values = drawn(made(start={"omega": table})).values["start", "omega"]
    for column, law in zip(values.T, laws, strict=True):
        assert stats.kstest(column, law.cdf).pvalue > 1e-4
    across = np.corrcoef(values.T)[np.triu_indices(3, 1)]
    assert (np.abs(across) < 0.03).all()


def test_quantities_are_independent():
    normal = {"normal": [0.0, 1.0]}
    torques = [{"kind": "constant", "torque": normal}, {"kind": "constant", "torque": normal}]
    values = drawn(made(start={"omega": normal}, torques=torques)).values
    across = np.corrcoef(np.concatenate([values[path] for path in values if path[0] != "body"], axis=1).T)
    assert across.shape == (9, 9) and (np.abs(across - np.eye(9)) < 0.03).all()


def test_directions_and_attitudes_are_uniform():
    values = drawn(made(start={"omega": {"sphere": 0.2}, "attitude": {"uniform": "sphere"}})).values
    omega, attitude = values["start", "omega"], values["start", "attitude"]
    assert np.allclose(np.linalg.norm(omega, axis=1), 0.2) and np.allclose(np.linalg.norm(attitude, axis=1), 1)
    for axis in omega.T:
        assert stats.kstest(axis / 0.2, stats.uniform(-1, 2).cdf).pvalue > 1e-4
    turned = ph.Rotation.from_quat(attitude).apply([0.0, 0.0, 1.0])
    for axis in turned.T:
        assert stats.kstest(axis, stats.uniform(-1, 2).cdf).pvalue > 1e-4


def test_turns_are_about_the_nominal_attitude_in_body_axes():
    start = {"omega": [0, 0, 1.0], "euler": {"sequence": "ZXZ", "angles": [0.4, 0.5, 0.6]},
             "attitude": {"normal_deg": [1.0, 2.0, 3.0]}}
    attitude = ph.Rotation.from_quat(drawn(made(start=start)).values["start", "attitude"])
    nominal = ph.Rotation.from_euler("ZXZ", [0.4, 0.5, 0.6])
    vectors = np.degrees((nominal.inv() * attitude).as_rotvec())
    for column, deviation in zip(vectors.T, (1.0, 2.0, 3.0), strict=True):
        assert stats.kstest(column, stats.norm(0, deviation).cdf).pvalue > 1e-4


PROGRAM = """
import hashlib, sys
import numpy as np
from polhode._ensemble import draw, recipe
spec = recipe.load(sys.argv[1])
values = draw.draw(spec, spec.points[0], 0, 5000).values
print(hashlib.sha256(b"".join(np.ascontiguousarray(v).tobytes() for v in values.values())).hexdigest())
"""


def test_bits_do_not_depend_on_numpys_processor(tmp_path):
    path = ensembles.write(tmp_path, ensembles.FREE)
    features = "AVX2 FMA3 AVX512F AVX512CD AVX512_SKX AVX512_CLX AVX512_CNL AVX512_ICL X86_V3 X86_V4 AVX512_SPR"
    found = set()
    for disabled in ("", features):
        env = {**os.environ, "NPY_DISABLE_CPU_FEATURES": disabled} if disabled else dict(os.environ)
        command = [sys.executable, "-W", "ignore", "-c", PROGRAM, str(path)]
        done = subprocess.run(command, capture_output=True, text=True, env=env, check=True)
        found.add(done.stdout)
    assert len(found) == 1


def test_parameters_and_starts_of_formulas_are_drawn_by_name():
    torque = {"kind": "formula", "torque": "-kp * attitude.xyz - kd * omega - h",
              "parameters": {"kp": {"normal": [0.7, 0.1]}, "kd": {"uniform": [[0.1, 0.2, 0.3], [0.2, 0.3, 0.4]]}},
              "states": {"h": {"start": {"truncated_normal": [[0, 0, 1], 0.1, [-1, -1, 0], [1, 1, 2]]},
                               "rate": "omega"}}}
    given = recipe.from_content({**tomllib.loads(ensembles.FREE), "torques": [torque], "count": 40}, ".", "mine.toml")
    laws = [ph.ensemble(given, executor=0).scene(i).torques[0] for i in (3, 4, 39)]
    assert len({law.parameters["kp"] for law in laws}) == 3
    for law in laws:
        kd, h = law.parameters["kd"], law.states["h"]["start"]
        assert all(low <= x <= low + 0.1 for low, x in zip((0.1, 0.2, 0.3), kd, strict=True)) and 0 <= h[2] <= 2
        assert abs(h[0]) < 1 and len(h) == 3
