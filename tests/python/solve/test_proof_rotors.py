"""Proofs of bodies with rotors: held, free, and in windows, where the rates jump."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest
from mpmath import mp, mpf

import polhode as ph

REFERENCE = Path(__file__).parents[2] / "reference"
BLOCK = (0.20, 0.40, 0.52)
OMEGA = (1.0, 2.0, 3.0)
AXES = {"axis": (0, 1, 0), "skew": (1, -2, 2)}


# mpmath 1.4 warns of the order of coefficients that older versions know alone.
pytestmark = pytest.mark.filterwarnings("ignore:Descending:DeprecationWarning")


@pytest.fixture(scope="module")
def series():
    """Power series of a gyrostat's rates and attitude, 30 digits."""
    sys.path.insert(0, str(REFERENCE))
    spec = importlib.util.spec_from_file_location("gyrostat_routes", REFERENCE / "gyrostat_routes.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    sys.path.pop(0)
    return module.Taylor


def unit(axis):
    """The exact direction, 30 digits."""
    size = mp.sqrt(sum(mpf(c) ** 2 for c in axis))
    return [mpf(c) / size for c in axis]


def follow(series, edges, momenta, times, start=OMEGA, moments=BLOCK):
    """Exact rows at times along pieces with constant h; the rates jump by -J^-1 dh at each edge."""
    moments = [mpf(c) for c in moments]
    state, rows, before = ([mpf(c) for c in start], [mpf(0), mpf(0), mpf(0), mpf(1)]), [], momenta[0]
    for k, h in enumerate(momenta):
        state = ([w - (b - a) / i for w, a, b, i in zip(state[0], before, h, moments, strict=True)], state[1])
        begin, end = mpf(edges[k]), mpf(edges[k + 1])
        motion = series(moments, h, state[0], state[1], order=30)
        for t in times:
            if (begin <= t < end) or (k + 1 == len(momenta) and t == end):
                w, q = motion.advance(state, mpf(t) - begin)
                rows.append([*w, *q])
        state, before = motion.advance(state, end - begin), h
    return rows


def count_outside(motion, rows):
    lower = np.hstack([motion.omega_lower, motion.attitude_lower])
    upper = np.hstack([motion.omega_upper, motion.attitude_upper])
    return sum(not mpf(float(lo)) <= x <= mpf(float(up)) for line, low, high in zip(rows, lower, upper, strict=True)
               for x, lo, up in zip(line, low, high, strict=True))


@pytest.mark.parametrize("name", ["S10", "S11"])
def test_the_stored_truth_lies_inside(name):
    """The truth is rounded to float64, so a bound may miss it by half a unit in the last place."""
    times = slice(0, 101, 10)
    scene = ph.Scene.load(name)
    truth = np.load(Path(ph._core.__file__).parent / "scenes" / "reference" / f"{name}.npz")
    motion = ph.solve(scene.replace(times=scene.times[times]), 1e-9, certify="proof")
    assert motion.error_kind == "proved" and motion.success
    for kind in ("omega", "attitude"):
        lower, upper = getattr(motion, f"{kind}_lower"), getattr(motion, f"{kind}_upper")
        found = truth[kind][times]
        if kind == "attitude":
            found = found * np.sign(np.sum(found * motion.attitude, axis=1))[:, None]
        rounding = 2**-53 * np.abs(found)
        assert np.all(lower - rounding <= found) and np.all(found <= upper + rounding)
        assert np.all(upper - lower < 1e-11 * max(1, np.abs(found).max()))


@pytest.mark.parametrize("kind", AXES)
def test_held_and_free_rotors(series, kind):
    axis, times = AXES[kind], [0.0, 0.4, 1.0]
    with mp.workdps(30):
        a = unit(axis)
        held = ph.Scene(inertia=BLOCK, omega=OMEGA, times=times, rotors=[ph.Rotor(axis, inertia=0.05, speed=6.0)])
        motion = ph.solve(held, 1e-10, certify="proof")
        h = [mpf(0.05) * 6 * c for c in a]
        rows = follow(series, (0, 1), [h], times)
        assert motion.error_kind == "proved" and count_outside(motion, rows) == 0
        wrong = follow(series, (0, 1), [[-c for c in h]], times)
        assert count_outside(motion, wrong) > 7
    if kind == "skew":
        return   # the carrier's axes are then not the body's, which this series needs
    with mp.workdps(30):
        free = ph.Scene(inertia=BLOCK, omega=OMEGA, times=times,
                        rotors=[ph.Rotor(axis, inertia=0.05, speed=6.0, free=True)])
        motion = ph.solve(free, 1e-10, certify="proof")
        moments = [mpf(i) - mpf(0.05) * c for i, c in zip(BLOCK, axis, strict=True)]
        h = [mpf(0.05) * (6 + mpf(OMEGA[1])) * c for c in a]
        rows = follow(series, (0, 1), [h], times, moments=moments)
        assert motion.error_kind == "proved" and count_outside(motion, rows) == 0


def test_windows_where_the_rates_jump(series):
    """Forward over two commands and their end; a sample at a jump has the rates after it."""
    steps = [ph.Rotor((0, 1, 0), momentum=0.3, during=(0.5, 1.25)), ph.Rotor((0, 1, 0), momentum=0.7, during=(1.25, 2)),
             ph.Rotor((0, 0, 1), momentum=-0.2, during=(1, 9)), ph.Rotor((1, 0, 0), momentum=0.1, during=(1, 9))]
    times = [0.0, 0.25, 0.5, 1.0, 1.25, 1.75, 2.0, 2.5]
    scene = ph.Scene(inertia=BLOCK, omega=OMEGA, times=times, rotors=steps)
    motion = ph.solve(scene, 1e-10, certify="proof")
    with mp.workdps(30):
        zero, x, y, z = mpf(0), mpf(0.1), [mpf(0.3), mpf(0.7)], mpf(-0.2)
        momenta = [[zero, zero, zero], [zero, y[0], zero], [x, y[0], z], [x, y[1], z], [x, zero, z]]
        rows = follow(series, (0, 0.5, 1, 1.25, 2, 2.5), momenta, times)
        assert motion.error_kind == "proved" and count_outside(motion, rows) == 0
    assert (motion.omega_upper - motion.omega_lower).max() < 1e-12
    # Backwards from the end, with the rates after the last jump.
    back = scene.replace(omega=motion.omega[-1], attitude=motion.attitude[-1], t0=2.5)
    proof = ph.solve(back, 1e-9, certify="proof")
    assert proof.error_kind == "proved"
    assert np.abs(proof.omega - motion.omega).max() < 1e-13 and np.abs(proof.attitude - motion.attitude).max() < 1e-13
    # From a start at which a rotor begins, backwards.
    middle = ph.solve(scene.replace(omega=motion.omega[2], attitude=motion.attitude[2], t0=0.5), 1e-9, certify="proof")
    assert np.abs(middle.omega - motion.omega).max() < 1e-13


def test_a_last_sample_at_a_jump():
    steps = [ph.Rotor((0, 1, 0), momentum=0.3, during=(0.5, 1))]
    scene = ph.Scene(inertia=BLOCK, omega=OMEGA, times=[0.75, 1.0], rotors=steps)
    proof, motion = ph.solve(scene, 1e-10, certify="proof"), ph.solve(scene, 1e-10, method="exact")
    assert np.all(proof.omega_lower - 1e-14 <= motion.omega) and np.all(motion.omega <= proof.omega_upper + 1e-14)


def test_rotors_beside_torques():
    for torques in ([ph.torques.Gravity(2.0, (0.1, 0.2, 0.3))], [ph.torques.AngularDamping(0.3)],
                    [ph.torques.Constant((0.1, 0.2, 0.3), frame="space"), ph.torques.Damping((0.1, 0.2, 0.3))]):
        scene = ph.Scene(inertia=BLOCK, omega=OMEGA, times=np.linspace(0, 3, 7), torques=torques,
                         rotors=[ph.Rotor((1, 2, 2), momentum=0.4)])
        proof, motion = ph.solve(scene, 1e-10, certify="proof"), ph.solve(scene, 1e-11, method="taylor")
        assert proof.error_kind == "proved"
        assert np.abs(proof.omega - motion.omega).max() < 1e-10
        assert np.abs(proof.attitude - motion.attitude).max() < 1e-10
