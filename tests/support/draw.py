"""Random bodies, the same for the same generator."""

import polhode as ph


def draw_bodies(rng, n, slowest):
    """Moments that bodies can have, rates from slow to fast, so that bodies of many steps are beside some of few, and
    attitudes."""
    squares = rng.uniform(0.1, 1, (n, 3)) ** 2
    rates = rng.normal(size=(n, 3)) * rng.uniform(slowest, 5, (n, 1))
    attitudes = ph.Rotation.from_rotvec(rng.normal(size=(n, 3))).as_quat()
    return squares.sum(axis=1, keepdims=True) - squares, rates, attitudes
