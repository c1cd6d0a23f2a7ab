"""Many bodies with samples next to the ends of windows: exact rates, and the bits of one body."""

import numpy as np
import pytest
from ball_edges import KINDS, SPANS, Ball

import polhode as ph

METHODS = ({}, {"method": "taylor", "rtol": 1e-12}, {"rtol": 1e-10})   # the last two have lanes where nothing starts


@pytest.mark.parametrize("options", METHODS)
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("windows", ["one", "touching", "whole"])
def test_rates_next_to_edges(options, kind, windows):
    for name in SPANS:
        ball = Ball(kind, name, windows=windows)
        free = ball.scene.replace(torques=[], rotors=[])
        many = ph.solve_many([ball.scene, free, ball.scene], **options)
        rates = np.array([float(rate) for rate in ball.rates()])
        assert np.abs(many.omega[[0, 2], :, 2] - rates).max() < 1e-14 * np.abs(rates).max()
        assert np.abs(many.omega[1, :, 2] / float(ball.start) - 1).max() < 1e-15
        one = ph.solve(ball.scene, **options)
        assert (many.omega[0] == one.omega).all() and (many.attitude[2] == one.attitude).all()


@pytest.mark.parametrize("want", [("omega",), ("attitude",)])
@pytest.mark.parametrize("name", ["backward", "middle", "farther", "least"])
def test_half_of_the_outputs_next_to_edges(name, want):
    scenes = [Ball(kind, name, windows="touching", want=want).scene for kind in KINDS]
    many = ph.solve_many(scenes)
    assert (many.omega is None) == (want != ("omega",)) and (many.attitude is None) == (want != ("attitude",))
    for kind, i in zip(KINDS, range(3), strict=True):
        ball = Ball(kind, name, windows="touching")
        if many.omega is not None:
            rates = np.array([float(rate) for rate in ball.rates()])
            assert np.abs(many.omega[i, :, 2] - rates).max() < 1e-14 * np.abs(rates).max()
        else:
            half = 0.5 * np.array([float(angle) for angle in ball.angles()])
            exact = np.stack([np.sin(half), np.cos(half)], axis=1)
            near = 4e-15 * max(1, np.abs(half).max())
            assert np.abs(np.abs((many.attitude[i][:, 2:] * exact).sum(axis=1)) - 1).max() < near


@pytest.mark.parametrize("kind", KINDS)
def test_columns_of_many_bodies_next_to_edges(kind):
    balls = [Ball(kind, name, windows="touching") for name in ("forward", "middle", "farther")]
    for ball in balls:
        many = ph.solve_many([ball.scene, ball.scene], accuracy=1e-9, sensitivity=ball.groups())
        one = ph.solve(ball.scene, 1e-9, sensitivity=ball.groups()).sensitivity
        assert (many.sensitivity.d_omega[1] == one.d_omega).all()
        assert (many.sensitivity.d_attitude[0] == one.d_attitude).all()
