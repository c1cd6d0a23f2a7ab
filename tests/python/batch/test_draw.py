"""Draws by counter: words against NumPy's Philox, numbers against mpmath, the same bits at every level and cut."""

import hashlib

import levels
import mpmath
import numpy as np
import pytest

import polhode as ph
from polhode import _core

EMPTY = np.empty((0, 0))
PARAMETERS = {"uniform": [[-1.0, 3.0], [0.5, 0.5]], "normal": [[0.0, 1.0], [2.0, 0.25], [1.0, 0.0]],
              "log_uniform": [[1e-5, 1e-3], [2.0, 2.0]],
              "truncated_normal": [[0.0, 1.0, -1.0, 2.0], [1.0, 0.5, 3.0, 4.0]],
              "sphere": EMPTY, "attitude": EMPTY, "rotation": [[0.05, 0.1, 0.0]]}


def draw(kind, first=0, count=1000, seed=8, key="start.omega", parameters=None, attempt=0):
    return _core._draw(kind, seed, key, first, count, PARAMETERS[kind] if parameters is None else parameters, attempt)


@pytest.mark.parametrize(("seed", "key", "first", "attempt"), [
    (0, "", 0, 0), (8, "start.omega", 1, 0), (2**64 - 1, "torques.0.diagonal", 2**61, 3), (5, "Größe", 10**12, 2**40)])
def test_words_are_numpys(seed, key, first, attempt):
    source = np.random.Philox(key=np.array([seed, _core._draw_key(key)], dtype=np.uint64),
                              counter=np.array([2 * first, attempt, 0, 0], dtype=np.uint64))
    assert np.array_equal(_core._draw_words(seed, key, first, 100, attempt), source.random_raw(800).reshape(100, 8))


def test_keys_are_fnv_1a():
    # http://www.isthe.com/chongo/src/fnv/test_fnv.c
    assert [_core._draw_key(text) for text in ("", "a", "foobar")] == [0xcbf29ce484222325, 0xaf63dc4c8601ec8c,
                                                                       0x85944171f73967e8]


def fractions(key, count, attempt=0):
    words = _core._draw_words(8, key, 0, count, attempt)
    return words, ((words >> np.uint64(12)).astype(float) + 0.5) * 2.0**-52


def ulps(found, exact):
    return float(abs(mpmath.mpf(float(found)) - exact)) / float(np.spacing(abs(float(exact))))


def quantile_above(p):
    """The z that a standard normal number exceeds with probability p <= 1/2, by Newton on the logarithm."""
    p = mpmath.mpf(p)
    z = mpmath.sqrt(-2 * mpmath.log(p)) * (mpmath.mpf("0.9") if p < 0.1 else mpmath.mpf("0.3"))
    for _ in range(100):
        tail = mpmath.erfc(z / mpmath.sqrt(2)) / 2
        step = mpmath.log(tail / p) * tail * mpmath.sqrt(2 * mpmath.pi) * mpmath.exp(z * z / 2)
        z += step
        if abs(step) < mpmath.mpf(10) ** -30:
            return z
    raise ArithmeticError(p)


def test_normal_numbers_are_exact():
    count = 400
    words, u = fractions("start.omega", count)
    found = draw("normal", count=count, parameters=[[0.0, 1.0]])[:, 0]
    with mpmath.workdps(40):
        worst = 0.0
        for i in range(count):
            exact = quantile_above(0.5 * u[i, 0]) * (-1 if words[i, 0] & np.uint64(1) else 1)
            worst = max(worst, ulps(found[i], exact))
    assert worst < 2.5   # 1.3 in the middle, 2.4 in the tails, 0.4 on average


def test_quantiles_and_tails_are_exact_far_out():
    points = [2.0**-54, 1e-12, 1e-9, 1.6e-8, 1e-5, 0.01, 0.0749, 0.075, 0.0751, 0.3, 0.499, 0.5 - 2.0**-54,
              1e-30, 1e-100, 1e-290]
    with mpmath.workdps(60):
        for p in points:
            assert ulps(_core._upper_normal_quantile(p), quantile_above(p)) < 2.5, p
        for x in (-38.0, -9.0, -3.0, -1.0, 0.0, 1e-9, 0.5, 1.5, 2.999, 3.0, 3.001, 5.0, 8.3, 20.0, 37.0):
            exact = mpmath.erfc(mpmath.mpf(x) / mpmath.sqrt(2)) / 2
            assert ulps(_core._upper_normal_tail(x), exact) < 1.0, x
    assert _core._upper_normal_tail(38.0) == 0.0


def test_uniform_and_log_uniform_numbers_are_exact():
    count = 500
    _, u = fractions("start.omega", count)
    flat, bent = draw("uniform", count=count), draw("log_uniform", count=count)
    with mpmath.workdps(40):
        ratio = mpmath.log(mpmath.mpf(1e-3) / mpmath.mpf(1e-5))
        for i in range(count):
            part = mpmath.mpf(float(u[i, 0]))
            assert abs(float(flat[i, 0] - (4 * part - 1))) <= 6e-16
            assert ulps(bent[i, 0], mpmath.mpf(1e-5) * mpmath.exp(part * ratio)) < 0.51
    assert (flat[:, 1] == 0.5).all() and (bent[:, 1] == 2.0).all()


def test_truncated_normal_numbers_are_exact():
    count = 200
    _, u = fractions("start.omega", count)
    found = draw("truncated_normal", count=count)
    with mpmath.workdps(40):
        for column, (mean, deviation, low, high) in enumerate(PARAMETERS["truncated_normal"]):
            below = [mpmath.ncdf((mpmath.mpf(b) - mean) / deviation) for b in (low, high)]
            for i in range(count):
                exact = below[0] + (below[1] - below[0]) * mpmath.mpf(float(u[i, column]))
                z = (mpmath.mpf(float(found[i, column])) - mean) / deviation
                assert abs(float(mpmath.ncdf(z) - exact)) < 3e-16 * (1 if column == 0 else 1e-3)
    far = draw("truncated_normal", count=10**4, parameters=[[0.0, 1.0, 30.0, np.inf]])
    assert 30.0 <= far.min() < 30.001 and 0.031 < far.mean() - 30.0 < 0.0345   # the mean excess is about 1/30


def test_directions_and_rotations_are_exact():
    count = 200
    _, u = fractions("start.omega", count)
    sphere, attitude, rotation = (draw(kind, count=count) for kind in ("sphere", "attitude", "rotation"))
    normal = draw("normal", count=count, parameters=[[0.0, 0.05], [0.0, 0.1], [0.0, 0.0]])
    with mpmath.workdps(40):
        for i in range(count):
            a, b, c = (mpmath.mpf(float(value)) for value in u[i, :3])
            height = 2 * a - 1
            radius = mpmath.sqrt(1 - height**2)
            exact = [radius * mpmath.cospi(2 * b), radius * mpmath.sinpi(2 * b), height]
            assert max(abs(float(x - y)) for x, y in zip(sphere[i], exact, strict=True)) < 2.5e-16
            exact = [mpmath.sqrt(1 - a) * mpmath.sinpi(2 * b), mpmath.sqrt(1 - a) * mpmath.cospi(2 * b),
                     mpmath.sqrt(a) * mpmath.sinpi(2 * c), mpmath.sqrt(a) * mpmath.cospi(2 * c)]
            assert max(abs(float(x - y)) for x, y in zip(attitude[i], exact, strict=True)) < 2.5e-16
    exact = ph.Rotation.from_rotvec(normal).as_quat()
    assert np.abs(rotation - exact).max() < 2e-16
    assert np.abs(np.linalg.norm(attitude, axis=1) - 1).max() < 5e-16


def test_distributions():
    stats = pytest.importorskip("scipy.stats")
    n = 200_000
    tests = {"uniform": stats.uniform(-1, 4), "normal": stats.norm(), "log_uniform": stats.loguniform(1e-5, 1e-3),
             "truncated_normal": stats.truncnorm(-1, 2)}
    for kind, law in tests.items():
        assert stats.kstest(draw(kind, count=n)[:, 0], law.cdf).pvalue > 1e-3, kind
    sphere = draw("sphere", count=n)
    for column in sphere.T:
        assert stats.kstest(column, stats.uniform(-1, 2).cdf).pvalue > 1e-3
    q = draw("attitude", count=n)
    angle = 2 * np.arccos(np.minimum(np.abs(q[:, 3]), 1))   # density (1 - cos angle) / pi
    assert stats.kstest(angle, lambda x: (x - np.sin(x)) / np.pi).pvalue > 1e-3
    assert np.abs(q.T @ q / n - np.eye(4) / 4).max() < 0.003
    normal = draw("normal", count=n, parameters=[[0.0, 1.0]] * 8)
    assert np.abs(np.corrcoef(normal.T) - np.eye(8)).max() < 0.01
    assert stats.anderson(normal[:5000, 3], "norm", method="interpolate").pvalue > 1e-3


@pytest.mark.parametrize("kind", PARAMETERS)
def test_a_body_depends_on_nothing_but_its_number(kind):
    whole = draw(kind, count=1000)
    pieces = [draw(kind, first=first, count=count) for first, count in ((0, 1), (1, 499), (500, 0), (500, 500))]
    assert np.array_equal(np.concatenate(pieces), whole)
    assert not np.array_equal(draw(kind, key="start.attitude"), whole)
    assert not np.array_equal(draw(kind, attempt=1), whole)
    assert not np.array_equal(draw(kind, seed=9), whole)
    if len(PARAMETERS[kind]) > 1:   # a component more shifts no other
        assert np.array_equal(draw(kind, parameters=PARAMETERS[kind][:1]), whole[:, :1])


def hash_of_draws():
    total = hashlib.sha256()
    for kind in PARAMETERS:
        total.update(draw(kind, count=5000).tobytes())
    return total.hexdigest()


def test_the_bits_are_the_same_at_every_level():
    found = levels.outputs("import test_draw; print(test_draw.hash_of_draws(), end='')", levels.LEVELS)
    assert set(found.values()) == {hash_of_draws().encode()}
    assert hash_of_draws().startswith("c705a84ff681056b")   # the same on every machine


@pytest.mark.parametrize(("kind", "parameters", "words"), [
    ("uniform", [[1.0, 0.0]], "low <= high"), ("uniform", [[0.0, np.inf]], "finite"), ("uniform", EMPTY, "shape"),
    ("uniform", [[0.0, 1.0]] * 9, "up to 8"), ("normal", [[0.0, -1.0]], "deviation"),
    ("normal", [[0.0, np.nan]], "finite"), ("log_uniform", [[0.0, 1.0]], "positive"),
    ("truncated_normal", [[0.0, 1.0, 40.0, 41.0]], "within 37"), ("truncated_normal", [[0.0, 0.0, 1.0, 2.0]], "within"),
    ("rotation", [[0.1, -0.1, 0.0]], "0 or more"), ("rotation", [[0.1, 0.1]], "shape"), ("sphere", [[1.0]], "shape"),
    ("beta", [[1.0, 2.0]], "a distribution"), ("normal", [0.0, 1.0], "two axes")])
def test_what_is_no_distribution_is_refused(kind, parameters, words):
    with pytest.raises(ph.InvalidInput, match=words):
        _core._draw(kind, 8, "x", 0, 3, parameters)


def test_bodies_beyond_the_counter_are_refused():
    assert draw("normal", first=2**62 - 3, count=3).shape == (3, 3)
    with pytest.raises(ph.InvalidInput, match="below 2\\^62"):
        draw("normal", first=2**62 - 3, count=4)
