"""Principal moments and axes: against mpmath in 50 digits, and the rules that choose among equal answers."""

import itertools

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import polhode as ph

fixed = settings(derandomize=True, deadline=None, max_examples=30)
quaternions = st.tuples(*[st.floats(-1, 1)] * 4).filter(lambda q: np.linalg.norm(q) > 0.1)
rotations = quaternions.map(Rotation.from_quat)
# Right-handed frames along the given axes: all 24.
SIGNED = itertools.product(itertools.permutations(range(3)), itertools.product((1, -1), repeat=3))
ALONG = [frame for frame in (np.eye(3)[:, list(p)] * s for p, s in SIGNED) if np.linalg.det(frame) > 0]


def symmetric(a):
    return (a + np.swapaxes(a, -1, -2)) / 2


def turned(moments, R):
    R = R.as_matrix() if isinstance(R, Rotation) else R
    return symmetric(R @ np.diag(moments) @ R.T)


def families(count):
    """Tensors by kind, the hard ones included."""
    rng = np.random.default_rng(5)
    rotation = Rotation.random(count, random_state=rng).as_matrix()

    def spectrum(*moments):
        return symmetric(rotation * np.array(moments) @ rotation.transpose(0, 2, 1))

    general = np.array([turned(rng.uniform(1, 2, 3), R) for R in rotation])
    factor = rng.normal(size=(count, 3, 3)) * 10.0 ** rng.uniform(-6, 0, (count, 3, 1))
    return {
        "general": general, "1e300": general * 5e299, "1e-300": general * 1e-300,
        "needle": spectrum(1e-8, 1, 1 + 1e-3), "rod": spectrum(0, 1, 1), "graded": spectrum(1e-12, 1e-6, 1),
        "badly scaled": symmetric(factor @ factor.transpose(0, 2, 1)), "indefinite": spectrum(-1, 0.5, 2),
        "gap 1e-6": spectrum(1, 1 + 1e-6, 1.5), "gap 1e-10": spectrum(1, 1 + 1e-10, 1.5),
        "gap 1e-13": spectrum(1, 1 + 1e-13, 1 + 2e-13), "gap 1e-15": spectrum(1, 1 + 1e-15, 1.9),
        "almost diagonal": np.diag([1, 1.5, 1.7]) + symmetric(rng.normal(size=(count, 3, 3)))
        * 10.0 ** rng.uniform(-17, -2, (count, 1, 1)),
    }


FAMILIES = families(19)


@pytest.mark.parametrize("kind", FAMILIES)
def test_moments_axes_and_frame_are_accurate_to_rounding(kind):
    """Bounds just above what is measured; numpy.linalg.eigh reaches 1.1e-15, 2.2e-15 and 1.8e-15 on the same."""
    matrices = FAMILIES[kind]
    moments, axes = ph.inertia.principal_axes(matrices)
    largest = np.abs(matrices).max((1, 2), keepdims=True)
    with mp.workdps(50):
        for matrix, found in zip(matrices, moments):
            exact = sorted(mp.eigsy(mp.matrix(matrix.tolist()), eigvals_only=True))
            top = max(abs(x) for x in exact)
            assert max(abs(mp.mpf(f) - x) / top for f, x in zip(found, exact)) < 5e-16
    residual = matrices / largest @ axes - axes * (moments / largest[..., 0])[:, None, :]
    # Where moments coincide, the chosen axes may be off by half the gap of 16 roundings.
    assert np.abs(residual).max() < (1.8e-15 if kind in ("gap 1e-15", "rod") else 1e-15)
    assert np.abs(axes.transpose(0, 2, 1) @ axes - np.eye(3)).max() < 1e-15
    assert np.all(np.linalg.det(axes) > 0.999)
    assert np.all(np.diff(moments) >= 0)


@pytest.mark.parametrize("kind", FAMILIES)
def test_many_are_the_same_bits_as_one(kind):
    matrices = FAMILIES[kind]
    moments, axes = ph.inertia.principal_axes(matrices)
    for count in (1, 2, 7, 8, 9):
        m, a = ph.inertia.principal_axes(matrices[:count])
        assert np.array_equal(m, moments[:count]) and np.array_equal(a, axes[:count])
    if kind != "indefinite":
        for matrix, m, a in zip(matrices, moments, axes):
            tensor = ph.InertiaTensor(matrix, physical=False)
            assert np.array_equal(tensor.moments, np.maximum(m, 0)) and np.array_equal(tensor.axes, a)


def test_small_moments_keep_their_digits():
    """For a positive tensor that is graded along its axes, Jacobi finds small moments to a part of themselves."""
    scale = np.array([1, 1e-5, 1e-10])
    matrix = np.array([[2, 0.3, 0.4], [0.3, 1, 0.2], [0.4, 0.2, 3]]) * np.outer(scale, scale)
    with mp.workdps(60):
        exact = sorted(mp.eigsy(mp.matrix(matrix.tolist()), eigvals_only=True))
    moments, _ = ph.inertia.principal_axes(matrix)
    np.testing.assert_allclose(moments, [float(x) for x in exact], rtol=4e-15)


# ---- the rules


def nearest(frame):
    """The frame along the given axes that a frame lies nearest to."""
    return max(ALONG, key=lambda along: np.sum(along * frame))


@pytest.mark.parametrize("moments", list(itertools.permutations((1, 2, 2.5))))
def test_a_diagonal_tensor_has_its_entries_and_the_given_axes(moments):
    tensor = ph.InertiaTensor.from_moments(moments)
    order = np.argsort(moments)
    assert list(tensor.moments) == [1, 2, 2.5]
    assert np.array_equal(np.abs(tensor.axes), np.eye(3)[:, order])
    assert tensor.axes[order[0], 0] == tensor.axes[order[2], 2] == 1
    assert np.linalg.det(tensor.axes) == 1
    assert not np.any(np.signbit(tensor.axes) & (tensor.axes == 0))
    if list(order) == [0, 1, 2]:
        assert np.array_equal(tensor.axes, np.eye(3))


@fixed
@given(rotations, st.floats(0, 0.78))
def test_a_frame_turned_by_less_than_45_degrees_is_found_as_it_is(rotation, angle):
    R = Rotation.from_rotvec(angle * rotation.as_matrix()[0])
    tensor = ph.InertiaTensor(turned((1, 1.3, 1.7), R))
    np.testing.assert_allclose(tensor.axes, R.as_matrix(), atol=1e-14)


@fixed
@given(rotations, st.permutations((1, 1.3, 1.7)), st.floats(0, 0.78), st.floats(0, 0.78))
def test_no_axis_flips_within_45_degrees_of_the_given_axes(rotation, moments, one, other):
    """Whichever way round the axes are: from diagonal to turned by up to 45 degrees about anything, no sign changes."""
    home = ph.InertiaTensor.from_moments(moments).axes
    for angle in (one, other):
        R = Rotation.from_rotvec(angle * rotation.as_matrix()[0]).as_matrix()
        tensor = ph.InertiaTensor(turned(moments, R))
        np.testing.assert_allclose(tensor.axes, R @ home, atol=1e-14)


@fixed
@given(rotations, st.sampled_from([0, 1e-17, 1e-16, 1e-15, 1e-14, 1e-12, 1e-8, 1e-3]), st.floats(0, 6.3),
       st.sampled_from(ALONG), st.floats(0, 0.78))
def test_the_axis_that_stands_apart_never_flips(rotation, gap, angle, along, tilt):
    """However small the other two moments' difference, and however they turn about it."""
    tip = Rotation.from_rotvec(tilt * rotation.as_matrix()[0]).as_matrix() @ along
    spin = Rotation.from_euler("z", angle).as_matrix()
    normal = tip[:, 2] * np.sign(tip[np.argmax(np.abs(tip[:, 2])), 2])
    oblate = ph.InertiaTensor(turned((1, 1 + gap, 1.5), tip @ spin))
    np.testing.assert_allclose(oblate.axes[:, 2], normal, atol=1e-14)
    prolate = ph.InertiaTensor(turned((1.4, 1.4 * (1 + gap), 1), tip @ spin))
    np.testing.assert_allclose(prolate.axes[:, 0], normal, atol=1e-14)
    if gap <= 1e-16:
        assert (oblate.symmetry, prolate.symmetry) == ("oblate", "prolate")
    if gap >= 1e-14:
        assert oblate.symmetry == prolate.symmetry == "triaxial"


@fixed
@given(rotations, st.sampled_from([(1, 1, 1.5), (1, 1.5, 1.5)]), st.floats(1e-30, 1e30))
def test_of_two_equal_moments_the_axes_are_the_given_ones_turned_least(rotation, moments, scale):
    principal = ph.InertiaTensor(scale * turned(moments, rotation)).principal()
    apart = 2 if moments[1] == 1 else 0
    normal = principal.axes[:, apart]
    assert principal.arbitrary == "plane" and np.array_equal(principal.normal, normal)
    assert principal.symmetry == ("oblate" if apart == 2 else "prolate")
    k = np.argmax(np.abs(normal) + 1e-6 > np.abs(normal).max())  # of equal ones the first
    along = np.roll(np.eye(3), apart - k, axis=1)  # the given axes in cyclic order, the nearest one in its place
    assert normal[k] > 0 and np.linalg.det(along) > 0
    turn = principal.axes @ along.T
    # no angle beyond what takes the given axis to the normal
    assert (np.trace(turn) - 1) / 2 == pytest.approx(normal[k], abs=2e-15)
    np.testing.assert_allclose(turn[:, k], normal, atol=1e-15)


@fixed
@given(rotations, st.floats(1e-30, 1e30))
def test_three_equal_moments_leave_the_given_axes(rotation, scale):
    principal = ph.InertiaTensor(scale * turned((1, 1, 1), rotation)).principal()
    assert np.array_equal(principal.axes, np.eye(3))
    assert (principal.symmetry, principal.arbitrary, principal.normal) == ("spherical", "sphere", None)


@pytest.mark.parametrize("moments, symmetry, arbitrary, normal", [
    ((3, 3, 3), "spherical", "sphere", None), ((0, 0, 0), "spherical", "sphere", None),
    ((2, 2, 3), "oblate", "plane", (0, 0, 1)), ((2, 3, 2), "oblate", "plane", (0, 1, 0)),
    ((3, 2, 2), "oblate", "plane", (1, 0, 0)), ((0, 2, 2), "prolate", "plane", (1, 0, 0)),
    ((2, 0, 2), "prolate", "plane", (0, 1, 0)), ((2, 2, 1), "prolate", "plane", (0, 0, 1)),
    ((2, 3, 4), "triaxial", "none", None),
])
def test_classes_and_arbitrary_directions(moments, symmetry, arbitrary, normal):
    tensor = ph.InertiaTensor.from_moments(moments)
    principal = tensor.principal()
    assert principal.symmetry == tensor.symmetry == symmetry and principal.arbitrary == arbitrary
    assert (principal.normal is None) if normal is None else list(principal.normal) == list(normal)
    assert np.all(tensor.axes >= 0) and np.linalg.det(tensor.axes) == 1  # cyclic, so that nothing need be turned round
    assert symmetry in repr(principal) and arbitrary in repr(principal)


def test_the_gap_is_relative_and_the_callers():
    data = ph.InertiaTensor.from_moments((1.000001, 1, 1.7))  # six digits of a round body
    assert data.symmetry == "triaxial"
    assert data.principal(gap=2e-6).symmetry == "oblate" and data.principal(gap=0.5e-6).symmetry == "triaxial"
    tiny = ph.InertiaTensor.from_moments((1.000001e-12, 1e-12, 1.7e-12))
    assert tiny.symmetry == "triaxial" and tiny.principal(gap=2e-6).symmetry == "oblate"
    chain = ph.InertiaTensor.from_moments((1, 1 + 1e-9, 1 + 2.1e-9))  # ends apart, neighbours not: the closer pair
    assert chain.principal(gap=1.5e-9).symmetry == "oblate"
    assert chain.principal(gap=3e-9).symmetry == "spherical"


def test_halfway_between_two_axes_the_first_counts_and_rounding_does_not_choose():
    rng = np.random.default_rng(1)
    exact = np.array([[2.0, 1, 0], [1, 2, 0], [0, 0, 2.5]])
    axes = ph.InertiaTensor(exact).axes
    np.testing.assert_allclose(axes[:, 0], (0.5**0.5, -(0.5**0.5), 0), atol=1e-15)
    for _ in range(50):
        noise = 1e-9 * symmetric(rng.normal(size=(3, 3)))
        np.testing.assert_allclose(ph.InertiaTensor(exact + noise).axes, axes, atol=1e-8)


# ---- many at once


def test_any_shape_goes_in():
    matrices = FAMILIES["general"]
    moments, axes = ph.inertia.principal_axes(matrices.reshape(19, 1, 1, 3, 3))
    assert moments.shape == (19, 1, 1, 3) and axes.shape == (19, 1, 1, 3, 3)
    assert ph.inertia.principal_axes(np.zeros((0, 3, 3)))[1].shape == (0, 3, 3)
    strided = np.asfortranarray(matrices)[::2]
    assert np.array_equal(ph.inertia.principal_axes(strided)[0], ph.inertia.principal_axes(matrices)[0][::2])
    uneven = matrices.copy()
    uneven[:, 0, 1] *= 1 + 2e-13
    one = ph.InertiaTensor(uneven[3])
    moments, axes = ph.inertia.principal_axes(uneven)
    assert np.array_equal(one.moments, moments[3]) and np.array_equal(one.axes, axes[3])


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_matrix_that_is_not_finite_gives_nan_and_one_warning(bad):
    matrices = FAMILIES["general"].copy()
    for row, i, j in ((3, 0, 0), (11, 2, 1)):
        matrices[row, i, j] = bad
    with pytest.warns(RuntimeWarning, match="matrices: 2 not finite") as caught:
        moments, axes = ph.inertia.principal_axes(matrices)
    assert len(caught) == 1
    wrong = np.isnan(moments).all(-1)
    assert list(np.flatnonzero(wrong)) == [3, 11] and np.isnan(axes[wrong]).all()
    expected = ph.inertia.principal_axes(FAMILIES["general"])
    assert np.array_equal(moments[~wrong], expected[0][~wrong]) and np.array_equal(axes[~wrong], expected[1][~wrong])


def test_bad_batches_are_refused():
    for bad in (np.eye(2), np.zeros(3), "x", [[1, 2, 3]], np.eye(3) * 1j):
        with pytest.raises(ph.InvalidInput, match="^matrices:"):
            ph.inertia.principal_axes(bad)
    matrices = FAMILIES["general"].copy()
    matrices[13, 0, 1] += 1e-9
    with pytest.raises(ph.InvalidInput, match=r"^matrices\[13\]: must be symmetric"):
        ph.inertia.principal_axes(matrices)
