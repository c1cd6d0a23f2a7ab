"""Fits of free bodies to made measurements: derivatives, global starts, covariances, and what no data can tell."""

from statistics import NormalDist

import numpy as np
import pytest

import polhode as ph
from polhode import measured
from polhode._sensitivity import rotations
from polhode._sensitivity.least_squares import rho
from polhode._sensitivity.problem import Problem, State, ratios_of
from polhode._sensitivity.result import covariance

INERTIA, OMEGA = np.array([0.3, 0.5, 0.62]), np.array([1.0, -2.0, 0.7])
START = np.array([0.5, -0.1, 0.7, 0.5])
TURN = 2 * np.pi / np.linalg.norm(OMEGA)


def random_body(rng):
    half = rng.uniform(0.1, 1, 3) ** 2
    q = rng.normal(size=4)
    return half.sum() - half, rng.normal(size=3), q / np.linalg.norm(q)


def seen(motion, t, kind, sigma, rng):
    """Measurements of a motion with noise."""
    omega, q = motion.at(t)
    R = rotations.to_matrix(q)
    noise = sigma * rng.normal(size=(len(t), 3))
    if kind == "rates":
        return measured.Rates(t, omega + noise, sigma)
    if kind == "attitudes":
        return measured.Attitudes(t, rotations.product(q, rotations.exp(noise)), sigma)
    if kind == "axis":
        return measured.Axis(t, R[:, :, 2] + noise, sigma, (0, 0, 1))
    if kind == "direction":
        return measured.Direction(t, np.einsum("kji,j->ki", R, (0.6, 0, 0.8)) + noise, sigma, (0.6, 0, 0.8))
    return measured.Scalar(t, brightness(q) + noise[:, 0], sigma, brightness)


def brightness(q):
    return rotations.to_matrix(q)[:, 2, 0] ** 2 + 0.5 * rotations.to_matrix(q)[:, 0, 1]


def motion_of(inertia=INERTIA, omega=OMEGA, attitude=START):
    return ph.FreeMotion(inertia, omega, attitude)


@pytest.mark.parametrize("kinds", [("rates",), ("attitudes",), ("axis",), ("direction",), ("scalar",),
                                   ("rates", "direction", "scalar")])
def test_the_jacobian_is_that_of_the_residuals(kinds):
    rng = np.random.default_rng(4)
    data = [seen(motion_of(), np.linspace(0, 3, 7), kind, 0.3, rng) for kind in kinds]
    if "rates" in kinds:
        data[0] = measured.Rates(data[0].t, data[0].y, 0.02, bias=True)
    state = State(START, OMEGA, ratios_of(INERTIA), rotations.exp(np.array([0.2, -0.1, 0.4])), np.zeros(data[0].bias))
    problem = Problem(data, ("attitude", "omega", "inertia", "axes"), state)
    x = rng.normal(size=len(problem.names)) * 0.2
    found, step = problem.jac(x), 1e-5
    for k in range(x.size):
        unit = np.eye(x.size)[k] * step
        expected = (problem.fun(x + unit) - problem.fun(x - unit)) / (2 * step)
        assert found[:, k] == pytest.approx(expected, abs=3e-7 * np.abs(found).max()), problem.names[k]


@pytest.mark.parametrize("noise", [0.01, 0.1])
def test_rates_alone_need_no_start(noise):
    rng = np.random.default_rng(8)
    for _ in range(6):
        inertia, omega, q = random_body(rng)
        motion = ph.FreeMotion(inertia, omega, q)
        data = seen(motion, np.linspace(0, 4 * motion.period, 200), "rates", noise * np.linalg.norm(omega), rng)
        found = ph.fit(data, fit=("omega", "inertia"))
        assert found.success, found.message
        truth = np.concatenate([omega, ratios_of(inertia)])
        assert np.all(np.abs(found.x - truth) < 6 * found.stderr), found
        assert found.inertia.max() == 1.0 and 0.8 < found.chi2 / found.dof < 1.2
        assert found.unobservable[0] == "the scale of the inertia: a free motion does not depend on it"


def test_attitudes_alone_need_no_start():
    rng = np.random.default_rng(9)
    for k in range(3):
        inertia, omega, q = random_body(rng)
        span = 20 * 2 * np.pi / np.linalg.norm(omega)
        data = seen(ph.FreeMotion(inertia, omega, q), np.sort(rng.uniform(0, span, 50)), "attitudes", 0.01, rng)
        found = ph.fit(data, seed=k)
        assert found.success, found.message
        assert found.inertia == pytest.approx(inertia / inertia.max(), abs=0.02)
        assert np.linalg.norm(found.omega - omega) < 0.01 * np.linalg.norm(omega)
        assert (found.attitude.inv() * ph.Rotation.from_quat(q)).magnitude() < 0.03 and not found.twins


def test_one_axis_finds_the_body_up_to_its_named_twins():
    rng = np.random.default_rng(10)
    data = seen(motion_of(), np.sort(rng.uniform(0, 10 * TURN, 80)), "axis", 0.01, rng)
    found = ph.fit(data, seed=1)
    assert found.success, found.message
    exact = INERTIA / INERTIA.max()
    assert min(np.abs(found.inertia / found.inertia.max() - twin).max() for twin in (exact, exact[[1, 0, 2]])) < 0.05
    assert len(found.twins) == 1 and "exchanged" in found.twins[0]


def test_a_direction_and_rates_with_a_bias_are_fitted_together():
    rng = np.random.default_rng(11)
    t = np.linspace(0, 4 * TURN, 240)
    rates = measured.Rates(t, motion_of().at(t)[0] + [0.05, -0.02, 0.03] + 0.01 * rng.normal(size=(240, 3)), 0.01,
                           bias=True)
    found = ph.fit([rates, seen(motion_of(), t[::4], "direction", 0.02, rng)])
    assert found.success, found.message
    assert np.all(np.abs(found.bias - [0.05, -0.02, 0.03]) < 5 * found.stderr[-3:])
    assert found.parameters[-1] == "bias_z" and found.inertia == pytest.approx(INERTIA / 0.62, abs=0.02)
    assert "a linear start from the rates and growing windows" in found.message   # no search was needed


def test_principal_axes_that_are_turned_in_the_body_are_found():
    rng = np.random.default_rng(12)
    E = ph.Rotation.from_rotvec([0.3, -0.2, 0.5]).as_matrix()
    tensor = ph.InertiaTensor(E @ np.diag(INERTIA) @ E.T)
    t = np.linspace(0, 5 * TURN, 300)
    y = ph.FreeMotion(tensor, OMEGA).at(t)[0] + 0.01 * rng.normal(size=(300, 3))
    found = ph.fit(measured.Rates(t, y, 0.01), fit=("omega", "inertia", "axes"))
    assert found.success, found.message
    assert found.inertia.matrix == pytest.approx(tensor.matrix / 0.62, abs=0.02)
    assert any("relabelled" in text for text in found.twins)
    assert found.scene.inertia.matrix == pytest.approx(found.inertia.matrix)   # not the moments alone


def test_intervals_cover_the_truth_as_often_as_they_say():
    rng = np.random.default_rng(13)
    t = np.linspace(0, 3 * TURN, 60)
    scene = ph.Scene(inertia=tuple(INERTIA), omega=tuple(OMEGA), times=t)
    truth = np.concatenate([OMEGA, ratios_of(INERTIA)])
    inside = [np.abs(f.x - truth) <= 1.96 * f.stderr for f in (
        ph.fit(seen(motion_of(), t, "rates", 0.02, rng), scene, fit=("omega", "inertia"), start="scene")
        for _ in range(100))]
    assert np.all((np.mean(inside, axis=0) > 0.87) & (np.mean(inside, axis=0) <= 1.0))
    assert 0.91 < np.mean(inside) < 0.98


def test_the_minimum_is_scipys():
    scipy = pytest.importorskip("scipy.optimize")
    rng = np.random.default_rng(14)
    t = np.linspace(0, 3 * TURN, 80)
    scene = ph.Scene(inertia=(0.31, 0.5, 0.6), omega=tuple(OMEGA + 0.02), attitude=START, times=t)
    data = seen(motion_of(), t, "attitudes", 0.02, rng)
    data.y[5] = START   # an outlier
    for loss in ("linear", "soft_l1", "huber", "cauchy"):
        found = ph.fit(data, scene, start="scene", loss=loss)
        other = scipy.least_squares(found.problem.fun, 1e-4 * rng.normal(size=8), found.problem.jac, loss=loss,
                                    x_scale="jac", xtol=1e-12, ftol=1e-12)
        assert found.cost == pytest.approx(other.cost, rel=1e-6), loss
        assert found.state.displaced(other.x, found.problem.slices).omega == pytest.approx(found.omega, abs=1e-4)


def test_an_outlier_does_little_under_a_robust_loss():
    rng = np.random.default_rng(15)
    t = np.linspace(0, 3 * TURN, 100)
    data = seen(motion_of(), t, "rates", 0.01, rng)
    data.y[::9] += 1.0
    plain, robust = (ph.fit(data, fit=("omega", "inertia"), loss=loss) for loss in ("linear", "soft_l1"))
    assert np.abs(robust.omega - OMEGA).max() < 0.01 < np.abs(plain.omega - OMEGA).max()
    assert not plain.success and "does not fit" in plain.message


def test_losses_have_their_derivatives():
    z, step = np.array([0.01, 0.5, 2.0, 30.0]), 1e-6
    for loss in ("linear", "soft_l1", "huber", "cauchy"):
        value, first, second = rho(z, loss)
        assert first == pytest.approx((rho(z + step, loss)[0] - rho(z - step, loss)[0]) / (2 * step), abs=1e-7)
        assert second == pytest.approx((rho(z + step, loss)[1] - rho(z - step, loss)[1]) / (2 * step), abs=1e-7)
        assert value[0] == pytest.approx(0.01, rel=0.01)


def test_a_prediction_spreads_and_its_covariance_is_that_of_other_fits():
    rng = np.random.default_rng(16)
    t = np.linspace(0, 2 * TURN, 60)
    scene = ph.Scene(inertia=tuple(INERTIA), omega=tuple(OMEGA), attitude=START, times=t)
    later = np.array([0.0, 30.0, 300.0, 1e5])
    fits = [ph.fit(seen(motion_of(), t, "attitudes", 0.02, rng), scene, start="scene").predict(later)
            for _ in range(60)]
    assert np.all(np.diff(fits[0].spread) > 0) and fits[0].unknown_after() == 300.0
    back = rotations.conjugate(motion_of().at(later)[1])
    off = np.array([rotations.log(rotations.product(f.attitude, back))[1] for f in fits])
    assert np.sqrt((off**2).sum(axis=1).mean()) == pytest.approx(
        np.sqrt(np.mean([np.trace(f.cov_attitude[1]) for f in fits])), rel=0.3)


def test_what_the_data_cannot_tell_is_said():
    rng = np.random.default_rng(17)
    t = np.linspace(0, 2 * TURN, 100)
    found = ph.fit(seen(motion_of(), t, "rates", 0.01, rng))
    assert found.success and any(text.startswith("the attitude") for text in found.unobservable)
    assert np.isinf(found.stderr[found.parameters.index("attitude_x")])
    top = motion_of(inertia=(0.5, 0.5, 0.3))
    found = ph.fit(seen(top, t, "rates", 0.01, rng), fit=("omega", "inertia"))
    assert found.success and any("moments 1 and 2 differ" in text for text in found.unobservable)
    scene = ph.Scene(inertia=(3.0, 5.0, 6.2), omega=tuple(OMEGA), attitude=START, times=t)
    found = ph.fit(seen(motion_of(), t, "rates", 0.01, rng), scene, fit=("omega", "inertia"), start="scene")
    assert not found.unobservable and found.inertia.max() == pytest.approx(6.2)
    assert found.scene.inertia.moments.max() == pytest.approx(6.2)


@pytest.mark.parametrize(("angle", "seen_"), [(1.5e-10, False), (3e-10, True)])
def test_columns_at_one_part_in_ten_thousand_million_are_one(angle, seen_):
    """The singular values of two unit columns at a small angle are in the ratio of half of it."""
    cov, hidden = covariance(np.array([[1.0, np.cos(angle)], [0.0, np.sin(angle)], [0.0, 0.0]]), ("a", "b"))
    assert np.isfinite(cov).all() == seen_ and hidden == ([] if seen_ else ["a combination of a, b"])


def test_a_motion_is_found_though_the_noise_is_larger_than_told(monkeypatch):
    """Half as large again: chi2 is 2.25 for each number, which is no reason to go on searching."""
    monkeypatch.setattr("polhode._sensitivity.start.STAGES", ((20_000, 5),))
    rng = np.random.default_rng(9)
    inertia, omega, q = random_body(rng)
    times = np.sort(rng.uniform(0, 20 * 2 * np.pi / np.linalg.norm(omega), 50))
    data = seen(ph.FreeMotion(inertia, omega, q), times, "attitudes", 0.015, rng)
    found = ph.fit(measured.Attitudes(times, data.y, 0.01), seed=0)
    assert found.inertia == pytest.approx(inertia / inertia.max(), abs=0.03)
    assert found.chi2 / found.dof == pytest.approx(2.25, rel=0.3)


def test_bounds_hold():
    rng = np.random.default_rng(18)
    t = np.linspace(0, 2 * TURN, 100)
    found = ph.fit(seen(motion_of(), t, "rates", 0.01, rng), fit=("omega", "inertia"), bounds={"omega_x": (1.05, 2)})
    assert found.omega[0] == pytest.approx(1.05, abs=1e-9)
    # The others are at the minimum with that one fixed.
    gradient = found.jac.T @ found.fun
    assert np.abs(gradient[1:]).max() < 1e-3 * np.abs(gradient[0])
    with pytest.raises(ph.InvalidInput, match="bounds: must name"):
        ph.fit(seen(motion_of(), t, "rates", 0.01, rng), fit=("omega", "inertia"), bounds={"attitude_x": (0, 1)})


def test_samples_with_nan_are_left_out_and_counted():
    rng = np.random.default_rng(19)
    t = np.linspace(0, 2 * TURN, 100)
    y = motion_of().at(t)[0] + 0.01 * rng.normal(size=(100, 3))
    y[3, 1], y[50] = np.nan, np.nan
    found = ph.fit(measured.Rates(t, y, 0.01), fit=("omega", "inertia"))
    assert found.success and found.left_out == 2 and "2 samples were left out" in found.message
    for (low, high), value, error in zip(found.interval().values(), found.x, found.stderr, strict=True):
        half = NormalDist().inv_cdf(0.975) * error   # of 95 % of a normal distribution
        assert (low, high) == pytest.approx((value - half, value + half), rel=1e-4)
    low, high = found.interval(1.0)["omega_x"]
    assert (high - low) / 2 == pytest.approx(found.stderr[0])
    assert found.dof == 3 * 98 - 5


def test_the_picture_of_a_fit_has_its_panels_apart():
    """The ellipses of each pair of five parameters, the motion, the residuals and the spread."""
    pytest.importorskip("matplotlib")
    rng = np.random.default_rng(20)
    found = ph.fit(seen(motion_of(), np.linspace(0, 2 * TURN, 60), "rates", 0.01, rng), fit=("omega", "inertia"))
    panels = [axes.get_position() for axes in found.plot().axes]
    assert len(panels) == 3 + 5 * 4 / 2
    for i, a in enumerate(panels):
        assert 0 <= a.x0 < a.x1 <= 1 and 0 <= a.y0 < a.y1 <= 1
        for b in panels[:i]:
            assert min(a.x1, b.x1) <= max(a.x0, b.x0) or min(a.y1, b.y1) <= max(a.y0, b.y0)


def test_the_inertia_alone_is_fitted_with_the_rates_of_the_scene():
    rng = np.random.default_rng(21)
    t = np.linspace(0, 3 * TURN, 100)
    scene = ph.Scene(inertia=(0.28, 0.5, 0.63), omega=tuple(OMEGA), attitude=START, times=t)
    found = ph.fit(seen(motion_of(), t, "rates", 0.01, rng), scene, fit="inertia")
    assert found.success and np.array_equal(found.omega, OMEGA)
    assert found.inertia / found.inertia.max() == pytest.approx(INERTIA / 0.62, abs=0.02)


@pytest.mark.parametrize(("make", "text"), [
    (lambda: measured.Rates([0, 1], [[1, 2, 3]], 0.1), r"y: must be of shape \(2, 3\)"),
    (lambda: measured.Rates([0, 1], np.ones((2, 3)), 0.0), "sigma: must be positive"),
    (lambda: measured.Rates([0, 1], np.ones((2, 3)), -np.eye(3)), "sigma: a covariance"),
    (lambda: measured.Rates([0, 1], np.ones((2, 3)), np.ones(5)), "sigma: must be a number"),
    (lambda: measured.Attitudes([0, 1], np.ones((2, 4)), 0.1), "y: attitudes must be unit"),
    (lambda: measured.Axis([0, 1], np.ones((2, 3)), 0.1, (0, 0, 0)), "axis: must be three numbers"),
    (lambda: ph.fit(measured.Rates([0, 1], np.ones((2, 3)), 0.1)), "data: 6 numbers cannot give 8 parameters"),
    (lambda: ph.fit([]), "data: must be"),
    (lambda: ph.fit(measured.Rates([0, 1, 2], np.ones((3, 3)), 0.1), fit="mass"), "fit: must be some of"),
    (lambda: ph.fit(measured.Rates([0, 1, 2], np.ones((3, 3)), 0.1), fit="omega"), "scene: needed for inertia"),
    (lambda: ph.fit(measured.Rates([0, 1, 2], np.ones((3, 3)), 0.1), loss="l3"), "loss: must be one of"),
    (lambda: ph.fit(measured.Rates([0, 1, 2], np.ones((3, 3)), 0.1), start="scene"), "start: must be"),
])
def test_bad_data_are_refused_with_the_reason(make, text):
    with pytest.raises(ph.InvalidInput, match=text):
        make()


def test_sigma_may_be_a_covariance_or_differ_by_sample_and_component():
    t, y = np.arange(4.0), np.ones((4, 3))
    r = np.ones((4, 3))
    for sigma, expected in ((2.0, 0.5), ((1.0, 2.0, 4.0), (1, 0.5, 0.25)), (np.array([1, 2, 4, 5.0]), None),
                            (np.diag([1.0, 4, 16]), (1, 0.5, 0.25))):
        whitened = measured.Rates(t, y, sigma).whiten(r)
        if expected is None:
            assert whitened[:, 1] == pytest.approx([1, 0.5, 0.25, 0.2])
        else:
            assert whitened[0] == pytest.approx(np.broadcast_to(expected, 3))
