"""Derivatives of free motions: the stored table of every regime, and identities that hold without a table."""

import csv
import pathlib

import levels
import numpy as np
import pytest

import polhode as ph

TABLE = pathlib.Path(__file__).parents[2] / "reference" / "free_sensitivity.csv"
E = 2.2e-16
BLOCK = np.array([0.20, 0.40, 0.52])
PARTS = ("o1", "o2", "o3", "a1", "a2", "a3")
START = (0.5, -0.1, 0.7, 0.5)
BODIES = [(BLOCK, (1, 2, 3)), (BLOCK, (3, 2, 0.1)), (BLOCK, (1e-4, 5, 1e-4)), ((0.52, 0.2, 0.4), (1e-9, 0.1, 3)),
          ((1, 1, 2), (1, 0.5, 1)), ((2, 1, 2), (1, -3, 0.1)), ((1, 1 + 1e-9, 1.6), (1, 0.3, 1e-5)),
          ((1, 1 + 1e-7, 1 + 3e-7), (0.3, 0.9, 0.7)), ((1, 1, 1), (1, 2, 3)), ((2, 5, 6), (1, 7, -1)),
          (BLOCK, (0, 2, 0)), (BLOCK, (0, 0, 2)), (BLOCK, (1, 1e-160, 1e-160)), ((1e-9, 1, 1 + 3e-10), (3, 1, -2))]
TIMES = np.array([0.0, 1e-9, 0.04, 0.3, -0.7, 1.9, 7.0, -12.0])


def rotation(q):
    return ph.Rotation.from_quat(q).as_matrix()


def read_table():
    with TABLE.open() as file:
        return list(csv.DictReader(file))


def ratios(row):
    """Of nine columns the error over 20 (cond + 4e).

    cond: what half a unit in the last place of every input moves the column by, relative to its size.
    """
    def number(*names):
        return np.array([float(row[name]) for name in names])

    inputs, q0 = number("I1", "I2", "I3", "w1", "w2", "w3", "t"), number("x", "y", "z", "w")
    names = [f"{group}{c}" for group in ("omega", "inertia", "axes") for c in (1, 2, 3)]
    exact = np.array([number(*(f"{name}_{part}" for part in PARTS)) for name in names]).T
    fast = np.abs(inputs[3:6]).max()
    exact[:3] /= fast
    unit = np.abs(exact).max(axis=0)   # columns of 1e-180 and 1e180 have no squares in float64
    unit[unit == 0] = 1.0

    def columns(values):
        inertia = ph.InertiaTensor.from_moments(values[:3], physical=False)
        s = ph.FreeMotion(inertia, values[3:6], q0).sensitivity(values[6], ("omega", "inertia", "axes"))
        return np.concatenate([s.d_omega / fast, s.d_attitude]) / unit

    def size_of(column):
        speed = np.linalg.norm(inputs[3:6] / fast)
        return np.maximum(np.linalg.norm(column[:3], axis=0) / speed, np.linalg.norm(column[3:], axis=0))

    found, size = columns(inputs), size_of(exact / unit)
    size[size == 0] = 1.0
    cond = np.zeros(9)
    for k in np.flatnonzero(inputs):
        moved = inputs.copy()
        moved[k] = np.nextafter(moved[k], 2 * moved[k])
        cond += 0.5 * size_of(columns(moved) - found) / size
    return size_of(found - exact / unit) / size / (20 * (cond + 4 * E))


def test_every_regime_is_exact_to_twenty_times_what_float64_can_say():
    rows = read_table()
    assert len(rows) > 250
    assert {row["family"] for row in rows} >= {"boxes", "separatrix", "across", "near-symmetric", "near-equatorial",
                                               "near-sphere", "needle", "near-steady", "scales", "planar", "exact",
                                               "switch", "short"}
    worst = {}
    for row in rows:
        found = ratios(row)
        assert found.max() <= 1, (row["family"], [row[k] for k in ("I1", "I2", "I3", "w1", "w2", "w3", "t")], found)
        worst[row["family"]] = max(worst.get(row["family"], 0), found.max())
    assert 0.01 < max(worst.values()), worst


@pytest.mark.parametrize(("inertia", "omega"), BODIES)
def test_the_columns_obey_the_symmetries_of_the_equations(inertia, omega):
    inertia, w0 = np.array(inertia, float), np.array(omega, float)
    motion = ph.FreeMotion(ph.InertiaTensor.from_moments(inertia, physical=False), w0, ph.Rotation.from_quat(START))
    s = motion.sensitivity(TIMES, ("omega", "attitude", "inertia", "time"))
    speed = np.linalg.norm(w0)
    rates, moments, time = slice(0, 3), slice(6, 9), 9
    # The moments have no scale.
    size = np.abs(s.d_omega[..., moments] * inertia).sum(axis=-1).max(axis=-1) / speed
    size += np.abs(s.d_attitude[..., moments] * inertia).sum(axis=-1).max(axis=-1) + 1e-300
    assert np.all(np.abs(s.d_omega[..., moments] @ inertia).max(axis=-1) / speed <= 20 * E * size)
    assert np.all(np.abs(s.d_attitude[..., moments] @ inertia).max(axis=-1) <= 20 * E * size)
    # omega and time scale together: sum omega_c col_c = (omega + t omega', t R omega)
    size = np.abs(s.d_omega[..., rates] * w0).sum(axis=-1).max(axis=-1) / speed
    size += np.abs(s.d_attitude[..., rates] * w0).sum(axis=-1).max(axis=-1) + 1
    lhs = s.d_omega[..., rates] @ w0, s.d_attitude[..., rates] @ w0
    assert np.all(np.abs(lhs[0] - s.omega - TIMES[:, None] * s.d_omega[..., time]).max(axis=1) / speed <= 50 * E * size)
    assert np.all(np.abs(lhs[1] - TIMES[:, None] * s.d_attitude[..., time]).max(axis=1) <= 50 * E * size)


@pytest.mark.parametrize(("inertia", "omega"), BODIES)
def test_energy_and_momentum_change_by_what_the_start_changes_them(inertia, omega):
    inertia, w0 = np.array(inertia, float), np.array(omega, float)
    motion = ph.FreeMotion(ph.InertiaTensor.from_moments(inertia, physical=False), w0, START)
    s = motion.sensitivity(TIMES)
    m0 = inertia * w0
    dm = inertia[:, None] * s.d_omega
    dm[..., 3:] += s.omega[..., None] * np.eye(3)
    dT = np.einsum("ti,tij->tj", s.omega, dm)
    dT[:, 3:] -= 0.5 * s.omega**2
    expected = np.concatenate([m0, 0.5 * w0**2])
    size = np.linalg.norm(s.omega, axis=1)[:, None] * np.linalg.norm(dm, axis=1) + np.abs(expected)
    assert np.all(np.abs(dT - expected) <= 50 * E * (size + 1e-300))
    # L in space changes as at the start: R (dm + d theta_B x m)
    R, R0 = rotation(s.attitude), rotation(START)
    L = np.einsum("tij,tj->ti", R, inertia * s.omega)
    dL = np.einsum("tij,tjk->tik", R, dm) + np.cross(s.d_attitude, L[:, :, None], axis=1)
    expected = np.concatenate([R0 * inertia, R0 * w0], axis=1)
    size = (np.linalg.norm(dm, axis=1) + np.linalg.norm(s.d_attitude, axis=1) * np.linalg.norm(m0))[:, None]
    size[..., 3:] += np.linalg.norm(w0)   # dm holds omega itself, known to this
    assert np.all(np.abs(dL - expected) <= 50 * E * (size + np.abs(expected)))


@pytest.mark.parametrize(("inertia", "omega"), BODIES[:9])
def test_the_transition_of_two_spans_is_the_product(inertia, omega):
    motion = ph.FreeMotion(inertia, omega, START)
    for side in ("space", "body"):
        whole, part = (motion.sensitivity(t, ("omega", "attitude"), side) for t in (7.0, 3.1))
        later = ph.FreeMotion(inertia, part.omega, part.attitude).sensitivity(3.9, ("attitude", "omega"), side)
        product = later.transition @ part.transition
        assert np.abs(product - whole.transition).max() <= 1e-12 * np.abs(whole.transition).max()
        assert np.linalg.det(whole.transition) == pytest.approx(1, abs=1e-12 * np.abs(whole.transition).max()**2)


def test_a_full_tensor_is_its_principal_body_turned():
    turn = ph.Rotation.from_euler("ZXZ", (0.3, 0.9, -0.4))
    R = turn.as_matrix()
    w = np.array([1.0, 2.0, 3.0])
    principal = ph.FreeMotion(BLOCK, R.T @ w, ph.Rotation.from_quat(START) * turn)
    full = ph.FreeMotion(ph.InertiaTensor(R @ np.diag(BLOCK) @ R.T), w, START)
    wrt = ("omega", "inertia", "axes", "time", "attitude")
    for side in ("space", "body"):
        a, b = principal.sensitivity(TIMES, wrt, side), full.sensitivity(TIMES, wrt, side)
        for k, columns in enumerate((slice(0, 3), slice(3, 6), slice(6, 9))):
            back = R.T if k != 1 else np.eye(3)
            left = R if side == "body" else np.eye(3)
            assert b.d_omega[..., columns] == pytest.approx(R @ a.d_omega[..., columns] @ back, rel=1e-9, abs=1e-12)
            assert b.d_attitude[..., columns] == pytest.approx(left @ a.d_attitude[..., columns] @ back, rel=1e-9,
                                                               abs=1e-12)
    # The axes columns are differences of motions with the body's tensor turned.
    step = 1e-5
    for c in range(3):
        ends = [ph.FreeMotion(ph.InertiaTensor(E @ full.inertia.matrix @ E.T), w, START).at(7.0)
                for E in (ph.Rotation.from_rotvec(s * step * np.eye(3)[c]).as_matrix() for s in (1, -1))]
        found = full.sensitivity(7.0, "axes")
        assert (ends[0][0] - ends[1][0]) / (2 * step) == pytest.approx(found.d_omega[:, c], abs=1e-6)
        turned = ph.Rotation.from_quat(ends[0][1]) * ph.Rotation.from_quat(ends[1][1]).inv()
        assert turned.as_rotvec() / (2 * step) == pytest.approx(found.d_attitude[:, c], abs=1e-6)


def test_a_small_rotation_of_the_start_stays_in_space():
    s = ph.FreeMotion(BLOCK, (1, 2, 3), START).sensitivity(TIMES, ("attitude", "omega"), "space")
    assert np.array_equal(s.d_attitude[..., :3], np.broadcast_to(np.eye(3), (8, 3, 3))) and not s.d_omega[..., :3].any()
    b = ph.FreeMotion(BLOCK, (1, 2, 3), START).sensitivity(TIMES, ("attitude", "omega"), "body")
    R = rotation(s.attitude)
    assert b.d_attitude[..., :3] == pytest.approx(R.transpose(0, 2, 1) @ rotation(START), abs=1e-14)
    assert b.d_attitude[..., 3:] == pytest.approx(R.transpose(0, 2, 1) @ s.d_attitude[..., 3:], abs=1e-13)


def test_at_rest_the_attitude_turns_by_t():
    s = ph.FreeMotion(BLOCK, (0, 0, 0), START).sensitivity(2.5, ("omega", "inertia", "attitude", "axes", "time"))
    assert np.array_equal(s.d_omega[:, :3], np.eye(3)) and not s.d_omega[:, 3:].any()
    assert s.d_attitude[:, :3] == pytest.approx(2.5 * rotation(START), abs=1e-15)
    assert not s.d_attitude[:, 3:6].any() and not s.d_attitude[:, 9:].any()


def test_the_state_is_that_of_the_motion_and_columns_have_their_bits_anyhow():
    for inertia, omega in (BODIES[0], BODIES[2], BODIES[7], BODIES[9]):
        motion = ph.FreeMotion(inertia, omega, START)
        t = np.linspace(-3, 40, 301)
        s = motion.sensitivity(t)
        assert all(np.array_equal(a, b) for a, b in zip((s.omega, s.attitude), motion.at(t), strict=True))
        for k in (0, 7, 100, 300):
            one = motion.sensitivity(t[k])
            assert np.array_equal(one.d_omega, s.d_omega[k])
        mixed = motion.sensitivity(t, ("inertia", "time", "omega"))
        assert np.array_equal(mixed.d_omega[..., :3], s.d_omega[..., 3:])
        assert np.array_equal(mixed.d_attitude[..., 4:], s.d_attitude[..., :3])
        assert np.array_equal(motion.sensitivity(t, "axes").d_omega,
                              motion.sensitivity(t, ("axes", "omega")).d_omega[..., :3])


def many(n=500):
    rng = np.random.default_rng(5)
    half = rng.uniform(0.1, 1, (n, 3)) ** 2
    q = rng.normal(size=(n, 4))
    return (half.sum(axis=1, keepdims=True) - half, rng.normal(size=(n, 3)), q / np.linalg.norm(q, axis=1)[:, None],
            rng.choice([-1, 1], n) * 10 ** rng.uniform(-3, 4, n))


def test_many_bodies_are_as_one_and_threads_leave_the_bits():
    moments, omega, q, t = many()
    s = ph.free_sensitivity(moments, omega, q, t, threads=1)
    u = ph.free_sensitivity(moments, omega, q, t, threads=4)
    assert np.array_equal(s.d_omega, u.d_omega) and np.array_equal(s.d_attitude, u.d_attitude)
    w, _ = ph.free_motion(moments, omega, q, t)
    assert np.array_equal(s.omega, w)
    for k in range(0, 500, 9):
        one = ph.FreeMotion(moments[k], omega[k], q[k]).sensitivity(t[k])
        size = np.maximum(np.linalg.norm(one.d_omega, axis=0) / np.linalg.norm(omega[k]),
                          np.linalg.norm(one.d_attitude, axis=0))
        assert np.all(np.abs(s.d_omega[k] - one.d_omega) / np.linalg.norm(omega[k]) <= 2e-13 * size)
        assert np.all(np.abs(s.d_attitude[k] - one.d_attitude) <= 2e-13 * size)
    tensor = ph.InertiaTensor([[0.4, 0.02, 0], [0.02, 0.5, 0.03], [0, 0.03, 0.3]])
    s = ph.free_sensitivity(tensor, omega[:20, None], q[:20, None], TIMES, wrt=("inertia", "axes"), side="body")
    one = ph.FreeMotion(tensor, omega[3], q[3]).sensitivity(TIMES, ("inertia", "axes"), "body")
    assert s.d_attitude.shape == (20, 8, 3, 6) and np.array_equal(s.d_attitude[3], one.d_attitude)


def test_results_go_where_they_are_wanted():
    moments, omega, q, _ = many(6)
    t = np.linspace(1, 2, 5)[:, None]
    s = ph.free_sensitivity(moments, omega, q, t, wrt="time")
    out = (np.empty((5, 6, 3)), np.empty((5, 6, 4)), np.empty((5, 6, 3, 1)), np.empty((5, 6, 3, 1)))
    assert ph.free_sensitivity(moments, omega, q, t, wrt="time", out=out).d_omega is out[2]
    assert np.array_equal(out[2], s.d_omega) and s.columns == ("time",)
    with pytest.raises(ph.InvalidInput, match=r"out: .*\(5, 6, 3, 1\)"):
        ph.free_sensitivity(moments, omega, q, t, wrt="time", out=(*out[:3], np.empty(3)))


def test_a_row_that_is_not_finite_becomes_nan():
    moments, omega, q, t = many(200)
    omega[3, 1], t[7] = np.nan, np.inf
    with pytest.warns(RuntimeWarning, match="2 rows"):
        s = ph.free_sensitivity(moments, omega, q, t)
    bad = np.isnan(s.d_omega).any(axis=(1, 2))
    assert list(np.flatnonzero(bad)) == [3, 7] and np.isnan(s.d_attitude[[3, 7]]).all()
    assert np.isfinite(s.d_attitude[~bad]).all()


def test_the_warning_of_the_scalars_place_is_at_the_line_of_the_caller():
    with pytest.warns(UserWarning, match="half turn about x") as caught:
        ph.free_sensitivity(BLOCK, (1, 2, 3), (1, 0, 0, 0), 1.0)
    assert [warning.filename for warning in caught] == [__file__]


def test_refusals_name_what_is_wrong():
    motion = ph.FreeMotion(BLOCK, (1, 2, 3))
    for arguments, text in ((("mass",), "wrt: .*mass"), (((),), "wrt: "), ((("omega", "omega"),), "wrt: .*once"),
                            (("omega", "left"), "side: .*'left'")):
        with pytest.raises(ph.InvalidInput, match=text):
            motion.sensitivity(1.0, *arguments)
    with pytest.raises(ph.InvalidInput, match="1e25"):
        motion.sensitivity(1e30)
    with pytest.raises(ph.InvalidInput, match=r"ask for wrt=\('omega', 'attitude'\)"):
        motion.sensitivity(1.0).transition  # noqa: B018
    with pytest.raises(ph.InvalidInput, match="columns"):
        motion.sensitivity(1.0).column("omega_w")
    assert motion.sensitivity(1.0).column("inertia_2")[0].shape == (3,)


PRINT_BITS = """
import hashlib, numpy as np, polhode as ph, test_free_sensitivity as t
moments, omega, q, times = t.many(200)
parts = [ph.free_sensitivity(moments, omega, q, times)]
parts += [ph.FreeMotion(ph.InertiaTensor.from_moments(I, physical=False), w, t.START).sensitivity(
    np.linspace(-3, 40, 203), ("omega", "inertia", "axes", "time")) for I, w in t.BODIES]
print(hashlib.sha256(b"".join(a.tobytes() for s in parts for a in (s.d_omega, s.d_attitude))).hexdigest())
"""


def test_avx2_and_avx512_give_the_same_bits():
    assert len(set(levels.outputs(PRINT_BITS).values())) == 1
