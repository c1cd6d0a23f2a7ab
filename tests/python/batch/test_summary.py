"""Sums over many bodies: against NumPy with math.fsum on the states, and the same bits for every cut and order."""

import math
import pickle

import levels
import numpy as np
import pytest

import polhode as ph
from polhode import _core

AXIS = (0.6, 0.0, 0.8)
TIMES = np.linspace(0.0, 30.0, 13)


def bodies(n, first=0):
    moments = _core._draw("uniform", 3, "moments", first, n, [[0.02, 0.03], [0.03, 0.04], [0.035, 0.045]])
    omega = _core._draw("normal", 3, "omega", first, n, [[0.0, 0.1], [0.0, 0.1], [1.0, 0.1]])
    rotation = _core._draw("rotation", 3, "attitude", first, n, [[0.05, 0.05, 0.05]])
    return moments, omega, rotation


def nominal(times=TIMES):
    return ph.FreeMotion([0.025, 0.035, 0.04], [0.0, 0.0, 1.0]).at(times)[1]


def quantities(times=TIMES):
    return [{"of": "angle", "nominal": nominal(times)}, {"of": "axis_angle", "axis": AXIS, "target": (0.0, 0.0, 1.0)},
            {"of": "omega"}, {"of": "energy"}, {"of": "attitude", "nominal": nominal(times)}]


def states(moments, omega, attitude, times=TIMES):
    return ph.free_motion(moments[:, None], omega[:, None], attitude[:, None], times)


def flat(record):
    """All that a record holds, as bytes."""
    parts = [repr([record[name] for name in ("first", "end", "bodies", "failed")]).encode()]
    for one in record["quantities"]:
        parts += [np.ascontiguousarray(one[name]).tobytes() for name in sorted(one)]
    return b"".join(parts)


def summarise(n, times=TIMES, first=0, threads=1, given=None):
    made = _core._Summary(quantities(times) if given is None else given, times.size)
    made.add_free(first, *bodies(n, first), times, threads)
    return made


def expected(omega, attitude, moments, times=TIMES):
    """The scalars by plain formulas."""
    relative = ph.Rotation(nominal(times)).inv() * ph.Rotation(attitude)
    axis = ph.Rotation(attitude).apply(AXIS)
    across = np.linalg.norm(np.cross(axis, (0.0, 0.0, 1.0)), axis=-1)
    return [relative.magnitude(), np.arctan2(across, axis[..., 2]), np.linalg.norm(omega, axis=-1),
            0.5 * np.einsum("bi,bti->bt", moments, omega**2)]


@pytest.fixture(scope="module")
def many():
    n = 100_000
    drawn = bodies(n)
    return n, expected(*states(*drawn), drawn[0]), states(*drawn), summarise(n).record()


def test_sums_of_many_bodies(many):
    n, scalars, _, record = many
    assert (record["first"], record["end"], record["bodies"], record["failed"]) == (0, n, n, 0)
    for values, one in zip(scalars, record["quantities"], strict=False):
        assert (one["count"] == n).all()
        for k in range(TIMES.size):
            column = values[:, k]
            total = math.fsum(column)
            assert abs(one["sum"][k] - total) <= 2e-14 * total
            assert abs(one["sum2"][k] - math.fsum(column**2)) <= 2e-14 * math.fsum(column**2)
            assert abs(one["min"][k] - column.min()) <= 2e-15 and abs(one["max"][k] - column.max()) <= 2e-15


def test_quantiles_from_the_histogram(many):
    n, scalars, _, record = many
    made = _core._Summary(quantities(), TIMES.size)
    for i, values in enumerate(scalars):
        edges, counts = made.edges(i), record["quantities"][i]["histogram"]
        assert counts.dtype == np.uint32 and counts.shape == (TIMES.size, edges.size - 1)
        assert (counts.sum(axis=1) == n).all()
        assert (np.diff(edges) > 0).all() and edges[0] == 0.0 and edges[-1] == np.inf
        assert (edges[2:-1] / edges[1:-2] <= 1 + 1 / 64).all()
        for k in range(TIMES.size):
            exact = np.histogram(values[:, k], edges)[0]
            assert np.abs(exact - counts[k]).sum() <= 4   # numbers at an edge to rounding
            for level in (0.5, 0.9, 0.999):
                at = int(np.searchsorted(np.cumsum(counts[k]), level * n))
                assert edges[at] <= np.quantile(values[:, k], level) <= edges[at + 1] * (1 + 1e-12)


def test_mean_attitude_and_spread(many):
    n, _, (_, attitude), record = many
    moments = record["quantities"][4]["moments"]
    assert np.abs(moments[:, [0, 4, 7, 9]].sum(axis=1) / n - 1).max() < 1e-14
    mean, spread = _core._mean_attitude(moments)
    for k in range(TIMES.size):
        found = ph.Rotation(nominal()[k]) * ph.Rotation(mean[k])
        rotations = ph.Rotation(attitude[:, k])
        assert (rotations.mean().inv() * found).magnitude() < 1e-13   # by LAPACK
        half = (found.inv() * rotations).magnitude() / 2
        assert spread[k] == pytest.approx(2 * math.asin(math.sqrt(math.fsum(np.sin(half)**2) / n)), rel=1e-12)


def test_a_small_spread_keeps_its_digits():
    scipy = pytest.importorskip("scipy.spatial.transform")
    vectors = np.random.default_rng(5).normal(0.0, 1e-7, (1000, 3))
    start = ph.Rotation.from_euler("ZXZ", (1.0, 0.5, -2.0))
    q = (start * ph.Rotation.from_rotvec(vectors)).as_quat()[:, None]
    made = _core._Summary([{"of": "attitude", "nominal": start.as_quat()}], 1)
    made.add_states(0, attitude=q)
    mean, spread = _core._mean_attitude(made.record()["quantities"][0]["moments"][0])
    centred = vectors - vectors.mean(axis=0)
    assert float(spread) == pytest.approx(math.sqrt((centred**2).sum() / 1000), rel=1e-6)
    found = (start * ph.Rotation(mean)).inv() * ph.Rotation(scipy.Rotation.from_quat(q[:, 0]).mean())
    assert found.magnitude() < 1e-14


def test_spread_of_rotations():
    transform = pytest.importorskip("scipy.spatial.transform")
    rng = np.random.default_rng(6)
    for size, rel in ((1e-9, 1e-6), (0.3, 1e-12), (3.0, 1e-12)):
        rotations = ph.Rotation.from_euler("x", 1.0) * ph.Rotation.from_rotvec(size * rng.normal(size=(4, 100, 3)))
        weights = rng.random((4, 100))
        theirs = transform.Rotation.from_quat(rotations.as_quat().reshape(-1, 4))
        for given in (None, weights):
            mean = theirs.mean(None if given is None else given.reshape(-1))
            half = (mean.inv() * theirs).magnitude() / 2
            expected = 2 * math.asin(math.sqrt(np.average(np.sin(half)**2, weights=None if given is None
                                                          else given.reshape(-1))))
            assert rotations.spread(given) == pytest.approx(expected, rel=rel)
            assert (ph.Rotation(mean.as_quat()).inv() * rotations.mean(given)).magnitude() < 1e-13
    assert ph.Rotation.from_euler("x", [[1.0], [1.0]]).spread() < 1e-15
    with pytest.raises(ph.InvalidInput, match="one or more"):
        ph.Rotation(np.empty((0, 4))).spread()


def test_no_spread_and_full_spread():
    one = np.array([0.5, -0.5, 0.5, 0.5])
    mean, spread = _core._mean_attitude(np.outer(one, one)[np.triu_indices(4)])
    assert np.allclose(mean, one, atol=1e-15) and float(spread) < 1e-7
    assert float(_core._mean_attitude(np.eye(4)[np.triu_indices(4)])[1]) == pytest.approx(2 * math.pi / 3, rel=1e-15)
    assert np.isnan(_core._mean_attitude(np.zeros(10))[1])


@pytest.mark.parametrize("times", [np.array([2.0]), np.linspace(0, 9, 64), np.linspace(0, 50, 301),
                                   np.array([0.0, 1.0, 5.0, 2.0, 2.5, 8.0, -3.0, 1e3, 4.0])])
def test_free_bodies_have_the_sums_of_their_states(times):
    moments, omega, attitude = bodies(200)
    omega[3] = 0.0
    omega[4] = [0.0, 1.0, 0.0]   # on the unstable axis
    omega[5] = [1e-9, 1.0, 0.0]
    closed = _core._Summary(quantities(times), times.size)
    closed.add_free(0, moments, omega, attitude, times)
    given = _core._Summary(quantities(times), times.size)
    given.add_states(0, *states(moments, omega, attitude, times), moments)
    assert flat(closed.record()) == flat(given.record())
    tensor = _core._Summary(quantities(times), times.size)
    tensor.add_states(0, *states(moments, omega, attitude, times), np.eye(3) * moments[:, None])
    assert flat(tensor.record()) == flat(given.record())


def test_one_tensor_of_all_bodies():
    tensor = ph.InertiaTensor.from_moments([0.02, 0.03, 0.04]).rotated(ph.Rotation.from_euler("ZXZ", (1, 2, 3)))
    _, omega, attitude = bodies(300)
    closed, given = (_core._Summary(quantities(), TIMES.size) for _ in range(2))
    closed.add_free(0, tensor, omega, attitude, TIMES)
    given.add_states(0, *ph.free_motion(tensor, omega[:, None], attitude[:, None], TIMES), tensor)
    assert flat(closed.record()) == flat(given.record())
    energy = 0.5 * np.einsum("bi,ij,bj->b", omega, tensor.matrix, omega)
    assert closed.record()["quantities"][3]["sum"] == pytest.approx(math.fsum(energy), rel=1e-14)


def test_the_bits_depend_on_neither_threads_nor_cut_nor_order():
    n = 5 * 4096 + 1234
    times = np.linspace(0, 9, 20)
    whole = flat(summarise(n, times).record())
    assert flat(summarise(n, times, threads=3).record()) == whole
    for cuts in ((0, 4096, n), (0, 1, 63, 64, 5000, 12288, 12289, n), (0, 3 * 4096, n)):
        made = _core._Summary(quantities(times), times.size)
        for begin, end in zip(cuts, cuts[1:], strict=False):
            made.add_free(begin, *bodies(end - begin, begin), times, 2)
        assert flat(made.record()) == whole
    for size in (1, 2, 4):
        pieces = [summarise(min(size * 4096, n - first), times, first) for first in range(0, n, size * 4096)]
        for order in (1, -1):
            for stored in (False, True):
                made = _core._Summary(quantities(times), times.size)
                for piece in pieces[::order]:
                    made.merge(_core._Summary.from_record(quantities(times), times.size, piece.record())
                               if stored else piece)
                assert flat(made.record()) == whole
    # Another order of the additions is seen: blocks one after the other, not by the tree.
    sums = [summarise(min(4096, n - first), times, first).record()["quantities"][0]["sum"]
            for first in range(0, n, 4096)]
    record = summarise(n, times).record()["quantities"][0]["sum"]
    assert np.array_equal(record, ((sums[0] + sums[1]) + (sums[2] + sums[3])) + (sums[4] + sums[5]))
    assert not np.array_equal(record, sum(sums[1:], sums[0]))


def test_levels_have_the_same_sums():
    code = ("import pickle, sys, test_summary\n"
            "sys.stdout.buffer.write(pickle.dumps(test_summary.summarise(5000).record()))")
    found = {level: pickle.loads(text) for level, text in levels.outputs(code, levels.LEVELS).items()}
    assert flat(found["avx2"]) == flat(found["avx512"])
    for a, b in zip(found["avx2"]["quantities"], found["baseline"]["quantities"], strict=True):
        for name in set(a) - {"histogram", "moments"}:
            assert np.allclose(a[name], b[name], rtol=1e-13, atol=1e-13), name


def test_bodies_that_do_not_exist_are_counted_and_left_out():
    n = 6000
    moments, omega, attitude = bodies(n)
    moments[7] = [1.0, 1.0, 3.0]
    omega[100, 1] = np.nan
    attitude[4099] = [0.0, 0.0, 0.0, 2.0]
    moments[5000, 0] = -1.0
    omega[5001] = 1e26
    good = np.ones(n, bool)
    good[[7, 100, 4099, 5000, 5001]] = False
    made = _core._Summary(quantities(), TIMES.size)
    made.add_free(0, moments, omega, attitude, TIMES)
    record = made.record()
    assert record["failed"] == made.failed == 5 and record["bodies"] == n
    values = expected(*states(moments[good], omega[good], attitude[good]), moments[good])
    for column, one in zip(values, record["quantities"], strict=False):
        assert (one["count"] == n - 5).all() and (one["histogram"].sum(axis=1) == n - 5).all()
        assert one["sum"][5] == pytest.approx(math.fsum(column[:, 5]), rel=1e-14)
    given = _core._Summary(quantities(), TIMES.size)
    w, q = np.full((n, TIMES.size, 3), np.nan), np.full((n, TIMES.size, 4), np.nan)
    w[good], q[good] = states(moments[good], omega[good], attitude[good])
    moments[~good] = 1.0
    given.add_states(0, w, q, moments)
    assert flat(given.record()) == flat(record)


def test_rows_that_were_not_reached_are_left_out():
    moments, omega, attitude = bodies(10)
    w, q = states(moments, omega, attitude)
    w[4, 9:] = np.nan
    q[5, 12] = np.inf
    made = _core._Summary(quantities(), TIMES.size)
    made.add_states(0, w, q, moments)
    record = made.record()
    assert record["failed"] == 2
    for one in record["quantities"]:
        assert one["count"].tolist() == [10] * 9 + [9] * 3 + [8]


def test_values_of_both_signs():
    values = np.array([[[-3.0, 5.0]], [[1e-30, np.nan]], [[0.0, -1e9]], [[7.0, 1e9]], [[-3.0, 0.25]]])
    made = _core._Summary([{"of": "value"}, {"of": "value", "least": 0.01, "largest": 100.0}], 1)
    made.add_states(0, values=values)
    first, second = made.record()["quantities"]
    assert made.record()["failed"] == 1
    assert (first["count"], second["count"]) == (4, 4)   # a body's row counts as a whole
    assert first["sum"] == 1.0 and first["min"] == -3.0 and first["max"] == 7.0 and first["sum2"] == 67.0
    edges = made.edges(0)
    assert edges.size == first["histogram"].shape[1] + 1 and edges[0] == -np.inf and edges[-1] == np.inf
    assert np.array_equal(edges, -edges[::-1]) and edges[-2] == 2.0**20
    bins = dict(zip(*np.unique(np.repeat(np.arange(edges.size - 1), first["histogram"][0]), return_counts=True),
                    strict=True))
    places = {int(np.searchsorted(edges, x, "right") - 1): count for x, count in ((0.0, 1), (7.0, 1))}
    places[int(np.searchsorted(edges, -3.0)) - 1] = 2
    assert bins == places
    assert made.edges(1)[-2] == 128.0 and second["histogram"][0, 0] == 1 and second["histogram"][0, -1] == 1


@pytest.mark.parametrize(("quantity", "words"), [
    ({"of": "angle"}, "one reference"), ({"of": "angle", "nominal": (0, 0, 0, 2.0)}, "unit quaternion"),
    ({"of": "axis_angle", "axis": (1, 0, 0)}, "one reference"), ({"of": "speed"}, "axis_angle"), ({}, "'of'"),
    ({"of": "axis_angle", "axis": (1, 1, 0), "target": (0, 0, 1)}, "unit vector as axis"),
    ({"of": "omega", "nominal": (0, 0, 0, 1)}, "known entries"), ({"of": "omega", "least": 1.0}, "both"),
    ({"of": "omega", "least": 1.0, "largest": 0.5}, "least < largest"),
    ({"of": "angle", "nominal": np.eye(4)[[3, 3]]}, "one for each time")])
def test_quantities_that_are_refused(quantity, words):
    with pytest.raises(ph.InvalidInput, match=words):
        _core._Summary([quantity], TIMES.size)


def test_bodies_are_added_once_and_in_order():
    made = summarise(5000)
    with pytest.raises(ph.InvalidInput, match="the next body, 5000"):
        made.add_free(0, *bodies(10), TIMES)
    with pytest.raises(ph.InvalidInput, match="multiple of 4096"):
        summarise(10, first=100)
    with pytest.raises(ph.InvalidInput, match="twice"):
        made.merge(summarise(3, first=4096))
    with pytest.raises(ph.InvalidInput, match="same quantities"):
        made.merge(_core._Summary([{"of": "omega"}], TIMES.size))
    with pytest.raises(ph.InvalidInput, match="add_states"):
        _core._Summary([{"of": "value"}], TIMES.size).add_free(0, *bodies(1), TIMES)
    with pytest.raises(ph.InvalidInput, match="aligned"):
        _core._Summary.from_record(quantities(), TIMES.size, summarise(3 * 4096, first=4096).record())
    made.merge(summarise(4096, first=3 * 4096))
    with pytest.raises(ph.InvalidInput, match="consecutive"):
        _core._Summary.from_record(quantities(), TIMES.size, made.record())
