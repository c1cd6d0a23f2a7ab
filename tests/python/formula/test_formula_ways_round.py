"""The ways round on the page "Where you come from" give the motions that they stand for."""

import re
from pathlib import Path

import numpy as np
import pytest

import polhode as ph

PAGE = Path(__file__).parents[3] / "docs/about/coming_from.md"


@pytest.fixture(scope="module")
def laws():
    block = next(code for code in re.findall(r"```python\n(.*?)```", PAGE.read_text(), re.S) if "def motor" in code)
    names = {}
    exec(block, names)
    return names


def test_a_motor_keeps_the_momentum_in_space(laws):
    inertia, times = np.array((1, 2, 2.5)), np.linspace(0, 20, 9)
    torque = ph.torques.Formula(laws["motor"], u=0.02, states={"h": 0.0})
    motion = ph.solve(ph.Scene(inertia=inertia, omega=(0.1, 0.2, 0.3), times=times, torques=[torque]), 1e-10)
    spin = np.outer(motion.states["h"], (0, 0, 1))
    assert motion.success and np.abs(motion.states["h"] - 0.02 * times).max() < 1e-15
    momentum = motion.rotation.apply(motion.omega * inertia + spin)
    assert np.abs(momentum - inertia * (0.1, 0.2, 0.3)).max() < 1e-10


def test_an_inclined_orbit_is_the_built_in_one_in_a_turned_frame(laws):
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(0.001, 0.002, 0.003), times=np.linspace(0, 9000, 7),
                     torques=[ph.torques.Formula(laws["gradient"], n=0.001, i=0.5)])
    frame = ph.Rotation.from_rotvec((0.5, 0, 0))
    turned = scene.replace(torques=[ph.torques.GravityGradient(0.001)], attitude=frame.inv().as_quat())
    motion, built_in = ph.solve(scene, 1e-10), ph.solve(turned, 1e-10)
    assert motion.success and built_in.success
    assert np.abs(motion.omega - built_in.omega).max() < 1e-9 * 0.004
    assert (motion.rotation.inv() * (frame * built_in.rotation)).magnitude().max() < 1e-9
