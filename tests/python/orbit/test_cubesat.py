"""The example of a cubesat, with all torques of an orbit, against its equations in plain NumPy and SciPy's DOP853."""

import pathlib
import sys
import tomllib

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
import orbit_laws  # noqa: E402

FILE = ROOT / "examples/cubesat.toml"
TIMES = np.array([0.0, 600.0, 1500.0, 2400.0])   # through an eclipse


def matrix_of(q):
    return ph.Rotation.from_quat(q).as_matrix()


@pytest.mark.parametrize("left_out", [None, "dipole", "drag", "solar_pressure"])
def test_the_cubesat_obeys_its_equations(left_out):
    given = tomllib.loads(FILE.read_text(encoding="utf-8"))
    scene = ph.Scene.load(FILE)
    tables = given["torques"]
    keep = [i for i, table in enumerate(tables) if table["kind"] != left_out]
    motion = ph.solve(scene.replace(times=TIMES, torques=[scene.torques[i] for i in keep]), accuracy=1e-9)
    moments, orbit = np.array(given["body"]["moments"]), given["orbits"]["main"]

    def rates(t, y):
        w, q = y[:3], y[3:]
        tau = sum(orbit_laws.torque(table, orbit, t, matrix_of(q / np.linalg.norm(q)), moments) for table in tables)
        turn = [*(q[3] * w + np.cross(q[:3], w)), -q[:3] @ w]
        return np.concatenate([(tau - np.cross(w, moments * w)) / moments, 0.5 * np.array(turn)])

    start = [*given["start"]["omega"], *given["start"]["attitude"]]
    found = solve_ivp(rates, (0, TIMES[-1]), start, method="DOP853", t_eval=TIMES, rtol=1e-10, atol=1e-12).y.T
    apart = (ph.Rotation.from_quat(found[:, 3:]).inv() * motion.rotation).magnitude()
    assert motion.success
    if left_out is None:   # DOP853 at 1e-10 is 1e-8 off where the light ends
        assert np.abs(found[:, :3] - motion.omega).max() < 1e-7 * motion.omega_scale and apart.max() < 1e-6
    else:
        assert apart.max() > 1e-4   # each torque counts
