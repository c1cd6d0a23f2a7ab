"""Bounds of chains of pieces with stiff damping, which are compared with one coarser run."""

import numpy as np
import pytest
from measures import error

import polhode as ph

T = ph.torques
# The last six had false bounds, by up to 2.2, while the factor between two runs was that of a motion without stiffness.
SEEDS = (*range(40), 153, 312, 356, 1046, 1315, 1316)


def draw(rng):
    moments = rng.uniform(0.2, 1, 3) ** 2
    moments = moments.sum() - moments
    omega = rng.normal(size=3)
    rates = 10 ** rng.uniform(1.5, 3.5) * np.array([1, rng.uniform(0, 1), rng.uniform(0, 1)])
    begin, end = np.sort(rng.uniform(0, 10, 2))
    torques = [T.During(T.Damping(rates * moments.min()), [(begin, end)]),
               T.During(T.Constant(rng.normal(size=3) * 0.3 * moments.mean()), [(0, (begin + end) / 2), (end, 20)])]
    if rng.random() < 0.5:
        torques.append(T.Gravity(rng.uniform(0, 1), rng.normal(size=3)))
    return ph.Scene(inertia=moments, omega=omega, torques=torques, times=np.sort(rng.uniform(0, 12, 9)))


@pytest.mark.parametrize("seed", SEEDS)
def test_bounds_of_stiff_chains_hold(seed):
    rng = np.random.default_rng(seed)
    scene = draw(rng)
    truth = ph.solve(scene, 1e-12, method="taylor")
    for accuracy in 10.0 ** rng.uniform(-8, -2, 4):
        motion = ph.solve(scene, accuracy, method=None if rng.random() < 0.5 else "radau")
        found = error(motion.omega, motion.attitude, {"omega": truth.omega, "attitude": truth.attitude}, scene.omega)
        assert motion.error_kind == "bounded" and found <= motion.error + truth.error
