"""The search of light curves: quadratic functions of the attitude, pairs of frequencies, a curve without a start."""

import numpy as np
import pytest

import polhode as ph
from polhode import measured
from polhode._sensitivity import curves, rotations
from polhode._sensitivity.problem import Problem, State
from polhode._spectrum import light

AXES = (2.0, 1.2, 0.8)
MOMENTS = np.sum(np.square(AXES)) - np.square(AXES)
SEEN = dict(body=AXES, sun=(0.6, 0, 0.8), observer=(0, 0, 1), law="lommel-seeliger")


def curve(seed, omega=(0.9, 0.5, -1.6), count=300, span=36.0):
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0, span, count))
    q = ph.FreeMotion(MOMENTS, omega, (0.5, -0.1, 0.7, 0.5)).at(t)[1]
    made = measured.Brightness(t, np.ones(count), 1.0, **SEEN).model(q)
    sigma = 0.05 * made.mean()
    return measured.Brightness(t, made + sigma * rng.normal(size=count), sigma, **SEEN)


def problem_of(data):
    state = State(np.array([0.0, 0, 0, 1]), np.zeros(3), np.zeros(2), np.array([0.0, 0, 0, 1]), np.zeros(0))
    return Problem([data], ("omega", "attitude", "inertia"), state)


def test_attitudes_of_the_spirals_are_even():
    """The mean of R is 0, and the mean of its elements' squares 1/3."""
    R = rotations.to_matrix(light.uniform_attitudes(500))
    assert np.abs(R.mean(axis=0)).max() < 0.02 and (R**2).mean(axis=0) == pytest.approx(1 / 3, abs=0.01)


def test_a_quadratic_function_is_found_exactly_and_rotated_with_the_frame():
    rng = np.random.default_rng(1)
    W = rng.normal(size=(3, 3, 3))

    def fun(q):
        R = rotations.to_matrix(q)
        return np.einsum("npi,ipq,nqi->n", R, W, R)

    function, left = light.quadratic(fun)
    assert left < 1e-20
    S, q = rng.normal(size=(2, 4))
    S, q = S / np.linalg.norm(S), q / np.linalg.norm(q)
    values = light._columns(rotations.to_matrix(q[None])) @ light._rotated(function, S[None])[0]
    assert values == pytest.approx(fun(rotations.product(S, q)[None]))


def test_the_two_frequencies_of_a_curve_leave_the_noise():
    data = curve(8)
    samples, _ = light.light_of(data)
    nu = 2 * np.pi / ph.FreeMotion(MOMENTS, (0.9, 0.5, -1.6)).period
    found = light.pairs(samples, np.pi * 300 / 36 / 2)
    assert any(abs(mu - 2 * nu) < 0.3 / 36 * 2 * np.pi and left < 400 for left, _, mu in found)


def test_a_light_curve_gives_its_body_without_a_start():
    data = curve(8)
    found = ph.fit(data)
    assert found.success and "two frequencies of a light curve" in found.message
    truth = ph.Scene(inertia=tuple(MOMENTS), omega=(0.9, 0.5, -1.6), attitude=(0.5, -0.1, 0.7, 0.5), times=data.t)
    best = ph.fit(data, truth, start="scene")
    assert found.chi2 == pytest.approx(best.chi2, abs=0.1)
    assert found.inertia / found.inertia.max() == pytest.approx(best.inertia / best.inertia.max(), abs=0.01)
    assert np.abs(found.omega) == pytest.approx(np.abs(best.omega), abs=0.02)


def test_which_data_the_search_takes():
    data = curve(3, count=80)
    assert curves.suits(problem_of(data))
    assert not curves.suits(problem_of(data.taken(slice(0, 40))))
    steep = measured.Scalar(data.t, data.y, 1.0, lambda q: np.sign(rotations.to_matrix(q)[:, 0, 2]) * 1.0)
    assert light.light_of(steep) is None and not curves.suits(problem_of(steep))
    gyro = measured.Rates(np.linspace(0, 9, 99), np.ones((99, 3)), 0.1)
    both = Problem([data, gyro], ("omega", "attitude", "inertia"), problem_of(data).base)
    assert not curves.suits(both)
