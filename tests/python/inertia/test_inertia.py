"""Inertia tensors at the door, turned, and put together. Principal axes have their own file, shapes theirs."""

import pathlib
import pickle
import re
import warnings
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import polhode as ph

fixed = settings(derandomize=True, deadline=None, max_examples=30)
EPS = np.finfo(float).eps

numbers = st.floats(-3, 3)
points = st.tuples(numbers, numbers, numbers).map(np.array)
rotations = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1).map(Rotation.from_quat)
# Any body at all: second moments of mass along three axes, zero allowed (flat bodies, rods), then turned.
spreads = st.tuples(*[st.one_of(st.just(0.0), st.floats(1e-6, 4))] * 3).filter(lambda s: sum(s) > 0)


def turned(moments, rotation):
    R = rotation.as_matrix()
    m = R @ np.diag(moments) @ R.T
    return (m + m.T) / 2


def moments_of(spread):
    return np.sum(spread) - np.array(spread)


tensors = st.builds(lambda s, r: ph.InertiaTensor(turned(moments_of(s), r)), spreads, rotations)
bodies = st.builds(ph.MassProperties, st.floats(0.1, 10), points, tensors)


def close(a, b, scale, tolerance=1e-14):
    np.testing.assert_allclose(a, b, rtol=0, atol=tolerance * scale)


def same(a, b, size=10.0, tolerance=1e-13):
    close(a.mass, b.mass, b.mass, tolerance)
    close(a.com, b.com, size, tolerance)
    close(a.inertia.matrix, b.inertia.matrix, b.mass * size**2, tolerance)


# ---- the door


@fixed
@given(spreads, rotations, st.sampled_from([1e-300, 1e-12, 1.0, 1e12, 1e300]))
def test_every_body_is_let_in_at_every_scale(spread, rotation, scale):
    tensor = ph.InertiaTensor(turned(moments_of(spread), rotation) * scale)
    np.testing.assert_allclose(tensor.moments, np.sort(moments_of(spread)) * scale, rtol=0,
                               atol=4e-15 * scale * max(moments_of(spread)))
    assert tensor.moments[0] >= 0


@pytest.mark.parametrize("scale", [1e-300, 1e-12, 1.0, 1e12, 1e300])
def test_thresholds_are_relative(scale):
    let_in = [np.diag([1, 2, 3 * (1 + 0.9e-12)]), np.diag([0, 1, 1]), np.zeros((3, 3)), np.diag([-0.9e-12, 1, 1]),
              [[1, 0.9e-12, 0], [0, 1, 0], [0, 0, 1]]]
    refused = [np.diag([1, 2, 3 * (1 + 1.2e-12)]), np.diag([-1.2e-12, 1, 1]), [[1, 1.1e-12, 0], [0, 1, 0], [0, 0, 1]]]
    for matrix in let_in:
        ph.InertiaTensor(np.multiply(matrix, scale))
    for matrix in refused:
        with pytest.raises(ph.InvalidInput):
            ph.InertiaTensor(np.multiply(matrix, scale))
    assert ph.InertiaTensor(np.diag([-0.9e-12, 1, 1]) * scale).moments[0] == 0


def test_small_asymmetry_is_averaged():
    matrix = ph.InertiaTensor([[1, 2e-13, 0], [0, 1, 0], [0, 0, 1]]).matrix
    assert matrix[0, 1] == matrix[1, 0] == 1e-13


@pytest.mark.parametrize("matrix, words", [
    (np.diag([1, 2, 5]), ["5 about the axis (0, 0, 1)", "the sum 3", "deficit of 40 %", "decimal point"]),
    (np.diag([8, 2, 5]), ["8 about the axis (1, 0, 0)", "the sum 7", "deficit of 12.5 %"]),
    ([[2, 0.9, 0], [0.9, 2, 0], [0, 0, 1.5]], ["2.9", "(0.7071, 0.7071, 0)", "10.34 %", "order of the products"]),
    (np.diag([1, 2, 3.0001]), ["0.003333 %", "flat body", "physical=False"]),
    (np.diag([-1, 2, 2]), ["negative", "-1 about the axis (1, 0, 0)", "50 % of the largest", "sign on the diagonal"]),
    ([[1, 2, 0], [2, 1, 0], [0, 0, 1]], ["negative", "-1", "(0.7071, -0.7071, 0)", "33.33 %", "products of inertia"]),
    ([[1, 0.1, 0], [-0.1, 1, 0], [0, 0, 1]], ["symmetric", "0.1 at [0, 1]", "-0.1 across", "20 %", "a sign"]),
    ([[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], ["symmetric", "10 %", "one triangle only"]),
    ([[1, 0.1, 0], [0.2, 1, 0], [0, 0, 1]], ["symmetric", "10 %", "a slip"]),
    ([[1, 0, 0], [0, 1, np.nan], [0, 0, 1]], ["finite", "nan"]),
    ([[1, 0, 0], [0, np.inf, 0], [0, 0, 1]], ["finite", "inf"]),
    ([1, 2, 3], ["(3, 3)", "(3,)"]),
    (np.zeros((2, 3, 3)), ["(3, 3)", "(2, 3, 3)"]),
    ([[1, 2], [3]], ["real numbers"]),
    ("tensor", ["real numbers"]),
    (None, ["real numbers"]),
    (np.eye(3) * 1j, ["real numbers"]),
])
def test_refusals_say_where_how_much_and_why(matrix, words):
    with pytest.raises(ph.InvalidInput) as refusal:
        ph.InertiaTensor(matrix)
    assert isinstance(refusal.value, ValueError)
    assert str(refusal.value).startswith("inertia: must be ")
    for word in words:
        assert word in str(refusal.value)


def test_the_opt_out_gives_up_the_triangle_inequality_alone():
    tensor = ph.InertiaTensor(np.diag([1, 2, 5]), physical=False)
    assert not tensor.physical and list(tensor.moments) == [1, 2, 5]
    assert not tensor.rotated((0, 0, 1, 0)).physical
    assert eval(repr(tensor), {"InertiaTensor": ph.InertiaTensor}) == tensor == pickle.loads(pickle.dumps(tensor))
    assert list(ph.InertiaTensor.from_moments((5, 1, 2), physical=False).moments) == [1, 2, 5]
    for matrix in (np.diag([-1, 2, 2]), [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], np.full((3, 3), np.nan)):
        with pytest.raises(ph.InvalidInput):
            ph.InertiaTensor(matrix, physical=False)


def test_the_page_tells_what_happens():
    page = (pathlib.Path(__file__).parents[3] / "docs" / "inertia.md").read_text()
    names = {}
    exec(compile(re.search(r"```python\n(.*?)```", page, flags=re.S)[1], "docs/inertia.md", "exec"), names)
    assert list(names["block"].inertia.moments) == [20, 40, 52]
    assert names["part"].mass == 11.5
    with pytest.raises(ph.InvalidInput) as refusal:
        ph.InertiaTensor([[1, 0, 0], [0, 2, 0], [0, 0, 5]])
    assert str(refusal.value) in " ".join(page.split())


# ---- values


@fixed
@given(bodies)
def test_values_compare_hash_pickle_and_print(body):
    for value in (body, body.inertia, body.inertia.principal()):
        again = pickle.loads(pickle.dumps(value))
        assert again == value and hash(again) == hash(value) and len({value, again}) == 1
        assert value != 1
    names = {"InertiaTensor": ph.InertiaTensor, "MassProperties": ph.MassProperties}
    assert eval(repr(body), names) == body
    assert ph.MassProperties(body.mass * 2, body.com, body.inertia) != body


def test_values_do_not_change():
    body = ph.shapes.box(1, (1, 2, 3))
    for owner, name in ((body, "com"), (body.inertia, "matrix"), (body.inertia, "axes"), (body.inertia, "moments")):
        before = getattr(owner, name)
        getattr(owner, name)[...] = 7  # into a copy
        assert np.array_equal(getattr(owner, name), before)
    with pytest.raises(AttributeError):
        body.mass = 2


# ---- turning, axes


@fixed
@given(tensors, rotations, points)
def test_turning_keeps_what_does_not_depend_on_axes(tensor, rotation, direction):
    assume(np.linalg.norm(direction) > 1e-3)
    top = tensor.moments[2]
    other = tensor.rotated(rotation)
    R = rotation.as_matrix()
    close(other.matrix, R @ tensor.matrix @ R.T, top, 4e-15)
    close(other.moments, tensor.moments, top, 4e-15)
    close(other.about_axis(rotation.apply(direction)), tensor.about_axis(direction), top, 4e-15)
    close(other.rotated(rotation.inv()).matrix, tensor.matrix, top, 8e-15)
    assert tensor.rotated(rotation.as_quat()) == other


@fixed
@given(tensors, points)
def test_the_moment_about_an_axis_is_the_quadratic_form(tensor, direction):
    assume(np.linalg.norm(direction) > 1e-3)
    u = direction / np.linalg.norm(direction)
    close(tensor.about_axis(direction), u @ tensor.matrix @ u, tensor.moments[2])
    for length in (1e-300, 1e-12, 1e12, 1e300):
        close(tensor.about_axis(u * length), u @ tensor.matrix @ u, tensor.moments[2])


@pytest.mark.parametrize("direction", [(0, 0, 0), (np.nan, 0, 1), (np.inf, 0, 1), (1, 2), "x", None])
def test_bad_directions(direction):
    with pytest.raises(ph.InvalidInput, match="^direction:"):
        ph.shapes.rod(1, 1).inertia.about_axis(direction)


@pytest.mark.parametrize("rotation", [(0, 0, 0, 0), (0, 0, 0, 2), (0, 0, 1), (np.nan, 0, 0, 1), np.eye(3)])
def test_bad_rotations(rotation):
    body = ph.shapes.box(1, (1, 2, 3))
    with pytest.raises(ph.InvalidInput):
        body.inertia.rotated(rotation)
    with pytest.raises(ph.InvalidInput):
        body.moved(rotation)


# ---- bodies


@fixed
@given(bodies, points)
def test_parallel_axes(body, point):
    d = np.array(point) - body.com
    steiner = body.mass * (d @ d * np.eye(3) - np.outer(d, d))
    close(body.about(point).matrix - steiner, body.inertia.matrix, body.about(point).moments[2])
    assert body.about(body.com) == body.inertia


@fixed
@given(bodies, rotations, points, points)
def test_moving_a_body_and_its_point_of_reference_alike(body, rotation, shift, point):
    there = body.moved(rotation, shift)
    R = rotation.as_matrix()
    close(there.com, rotation.apply(body.com) + shift, 10)
    expected = body.about(point)
    top = expected.moments[2] + body.mass * 100
    close(there.about(rotation.apply(point) + shift).matrix, R @ expected.matrix @ R.T, top)
    same(there.moved(rotation.inv(), -rotation.inv().apply(shift)), body)
    assert body.moved() == body.moved(translation=(0, 0, 0))


@fixed
@given(bodies, bodies, bodies, points)
def test_adding_and_taking_away(a, b, c, point):
    both = a + b
    close((both.mass * both.com), a.mass * a.com + b.mass * b.com, 100)
    close(both.about(point).matrix, a.about(point).matrix + b.about(point).matrix, 20 * 100)
    assert both == b + a or np.allclose(both.com, (b + a).com, rtol=1e-14, atol=1e-14)
    same((a + b) + c, a + (b + c))
    same(both - b, a, tolerance=1e-13 * both.mass / a.mass)


def test_taking_more_than_there_is():
    box = ph.shapes.box
    with pytest.raises(ph.InvalidInput, match="difference: must be a body of positive mass, got 0 .a hole bigger"):
        box(1, (1, 1, 1)) - box(1, (1, 1, 1))
    with pytest.raises(ph.InvalidInput, match="positive mass, got -1"):
        box(1, (1, 1, 1)) - box(2, (1, 1, 1))
    with pytest.raises(ph.InvalidInput, match="difference: .*negative.*a hole bigger than the body"):
        box(2, (1, 1, 1)) - box(1, (2, 2, 2))
    with pytest.raises(ph.InvalidInput, match="difference: .*outside it"):
        box(8, (1, 1, 1)) - box(1, (0.5, 0.5, 0.5)).moved(translation=(3, 0, 0))
    with pytest.raises(ph.InvalidInput, match="difference: .*triangle"):
        box(8, (1, 1, 0.1)) - box(1, (0.1, 0.1, 0.3))


@fixed
@given(st.floats(0.01, 9), rotations, points)
def test_flat_bodies_with_holes_are_not_refused_for_rounding(digits, rotation, shift):
    """However thin the ring that is left: the difference's rounding is judged by what it was taken from."""
    radius = 1 - 10**-digits
    disk = ph.shapes.disk(1, 1).moved(rotation, shift)
    hole = ph.shapes.disk(radius**2, radius).moved(rotation, shift)
    washer = disk - hole
    close(washer.inertia.moments[2], 0.5 * (1 + radius**2) * (1 - radius**2), 1, 1e-14)


def test_a_hole_leaves_what_is_known():
    block, hole = ph.shapes.box(6.0, (1, 2, 3)), ph.shapes.box(6.0 / 8, (0.5, 1, 1.5))
    expected = ph.shapes.box(1.0, (1, 2, 3)).inertia.matrix * (6 - 0.75 / 4)
    close((block - hole).inertia.matrix, expected, 26)
    same(ph.shapes.hollow_box(6 - 0.5 * 1.5 * 2.5 / 6 * 6, (1, 2, 3), 0.5),
         ph.shapes.box(6.0, (1, 2, 3)) - ph.shapes.box(6 * 0.5 * 1.5 * 2.5 / 6, (0.5, 1.5, 2.5)), tolerance=1e-15)


@fixed
@given(st.lists(st.tuples(st.integers(1, 9), *[st.integers(-9, 9)] * 3), min_size=1, max_size=6), st.integers(0, 40))
def test_points_are_exact_sums(rows, shift):
    masses, positions = [r[0] for r in rows], np.array([r[1:] for r in rows])
    body = ph.MassProperties.from_points(masses, positions + 2.0**shift)
    total = sum(masses)
    com = [Fraction(sum(m * int(p[k]) for m, p in zip(masses, positions)), total) for k in range(3)]
    spread = np.array([[float(sum(m * (int(p[j]) - com[j]) * (int(p[k]) - com[k]) for m, p in zip(masses, positions)))
                        for k in range(3)] for j in range(3)])
    top = max(np.trace(spread), 1)
    close(body.com, [float(c + 2**shift) for c in com], 2.0**shift + 10, EPS)
    close(body.inertia.matrix, np.trace(spread) * np.eye(3) - spread, top, 3e-15)
    assert body.mass == total


def test_a_single_point_and_a_dumbbell():
    point = ph.MassProperties.from_points([2], [(1, 2, 3)])
    assert np.all(point.inertia.matrix == 0) and point.inertia.symmetry == "spherical"
    assert list(point.about((1, 2, 2)).moments) == [0, 2, 2]
    dumbbell = ph.MassProperties.from_points([1, 1], [(0, 0, 1), (0, 0, -1)])
    assert list(dumbbell.inertia.moments) == [0, 2, 2] and dumbbell.inertia.symmetry == "prolate"


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_bodies_scale_in_length_and_mass(scale):
    rng = np.random.default_rng(3)
    masses, positions = rng.uniform(1, 2, 5), rng.normal(size=(5, 3))
    one = ph.MassProperties.from_points(masses, positions)
    other = ph.MassProperties.from_points(masses * scale, positions * scale)
    np.testing.assert_allclose(other.inertia.matrix / scale**3, one.inertia.matrix, rtol=1e-13)
    np.testing.assert_allclose(other.com / scale, one.com, rtol=1e-13)
    np.testing.assert_allclose((other + other.moved(translation=other.com)).inertia.matrix / scale**3,
                               (one + one.moved(translation=one.com)).inertia.matrix, rtol=1e-13)


@pytest.mark.parametrize("call, name", [
    (lambda t: ph.MassProperties(0, (0, 0, 0), t), "mass"),
    (lambda t: ph.MassProperties(-1, (0, 0, 0), t), "mass"),
    (lambda t: ph.MassProperties(np.nan, (0, 0, 0), t), "mass"),
    (lambda t: ph.MassProperties(np.inf, (0, 0, 0), t), "mass"),
    (lambda t: ph.MassProperties((1, 2), (0, 0, 0), t), "mass"),
    (lambda t: ph.MassProperties(1, (0, 0), t), "com"),
    (lambda t: ph.MassProperties(1, (0, 0, np.nan), t), "com"),
    (lambda t: ph.MassProperties(1, (0, 0, 0), np.diag([1, 1, 3])), "inertia"),
    (lambda t: ph.MassProperties(1, (0, 0, 0), (1, 2, 3)), "inertia"),
    (lambda t: ph.MassProperties(1, (0, 0, 0), None), "inertia"),
    (lambda t: ph.MassProperties(1, (0, 0, 0), t).about((1, 2)), "point"),
    (lambda t: ph.MassProperties(1, (0, 0, 0), t).about((1, 2, np.inf)), "point"),
    (lambda t: ph.MassProperties(1, (0, 0, 0), t).about((1, 2, 1e200)), "inertia"),  # overflows
    (lambda t: ph.MassProperties(1, (0, 0, 0), t).moved((0, 0, 0, 1), (1, 2)), "translation"),
    (lambda t: ph.MassProperties.from_points([], np.zeros((0, 3))), "masses"),
    (lambda t: ph.MassProperties.from_points([1, 0], np.zeros((2, 3))), r"masses\[1\]"),
    (lambda t: ph.MassProperties.from_points([1, -2], np.zeros((2, 3))), r"masses\[1\]"),
    (lambda t: ph.MassProperties.from_points([1, np.nan], np.zeros((2, 3))), r"masses\[1\]"),
    (lambda t: ph.MassProperties.from_points([1, 2], np.zeros((3, 3))), "positions"),
    (lambda t: ph.MassProperties.from_points([1, 2], np.zeros((2, 2))), "positions"),
    (lambda t: ph.MassProperties.from_points(1, np.zeros(3)), "positions"),
    (lambda t: ph.MassProperties.from_points([1], [(0, 0, np.nan)]), "positions"),
    (lambda t: t.principal(gap=-1), "gap"),
    (lambda t: t.principal(gap=1), "gap"),
    (lambda t: t.principal(gap=np.nan), "gap"),
    (lambda t: ph.InertiaTensor.from_moments((1, 2, 5)), "inertia"),
    (lambda t: ph.InertiaTensor.from_moments((1, -2, 2)), "inertia"),
    (lambda t: ph.InertiaTensor.from_moments((1, 2)), "moments"),
    (lambda t: ph.InertiaTensor.from_moments((1, 2, np.nan)), "moments"),
])
def test_bad_input_names_the_argument(call, name):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(ph.InvalidInput, match=f"^{name}:"):
            call(ph.InertiaTensor(np.eye(3)))


def test_adding_something_else_is_a_type_error():
    with pytest.raises(TypeError):
        ph.shapes.rod(1, 1) + 1
