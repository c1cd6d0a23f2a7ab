"""The example of a cubesat, with all torques of an orbit, against its equations in plain NumPy and SciPy's DOP853."""

import pathlib
import sys
import tomllib

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests/support"))
import orbit_laws  # noqa: E402

FILE = ROOT / "examples/cubesat.toml"
TIMES = np.array([0.0, 600.0, 1500.0, 2000.0])   # through an eclipse


def find_edges(orbit, light):
    """The times at which the light comes and goes."""
    sun = np.array(light["sun"]) / np.linalg.norm(light["sun"])

    def outside(t):
        r = orbit_laws.place(orbit, t)[0]
        return np.sum(r * r, -1) - (r @ sun) ** 2 - light["shadow"] ** 2

    grid = np.arange(TIMES[0], TIMES[-1] + 10.0, 10.0)
    changes = np.flatnonzero(np.diff(np.sign(outside(grid))))
    edges = [brentq(outside, grid[i], grid[i + 1], xtol=1e-9) for i in changes]
    return [t for t in edges if orbit_laws.place(orbit, t)[0] @ sun < 0]


def matrix_of(q):
    return ph.Rotation.from_quat(q).as_matrix()


@pytest.fixture(scope="module")
def found():
    """Rates and attitudes of all torques at TIMES."""
    given = tomllib.loads(FILE.read_text(encoding="utf-8"))
    tables, moments, orbit = given["torques"], np.array(given["body"]["moments"]), given["orbits"]["main"]

    def rates(t, y):
        w, q = y[:3], y[3:]
        tau = sum(orbit_laws.torque(table, orbit, t, matrix_of(q / np.linalg.norm(q)), moments) for table in tables)
        turn = [*(q[3] * w + np.cross(q[:3], w)), -q[:3] @ w]
        return np.concatenate([(tau - np.cross(w, moments * w)) / moments, 0.5 * np.array(turn)])

    edges = find_edges(orbit, next(table for table in tables if table["kind"] == "solar_pressure"))
    assert edges
    # DOP853 loses digits in steps across the ends of the light, so none crosses one.
    y, rows, begin = np.array([*given["start"]["omega"], *given["start"]["attitude"]]), [], 0.0
    for end in sorted({*TIMES, *edges}):
        if end > begin:
            y = solve_ivp(rates, (begin, end), y, method="DOP853", rtol=1e-12, atol=1e-15).y[:, -1]
        begin = end
        if end in TIMES:
            rows.append(y)
    return np.array(rows)


@pytest.mark.parametrize("left_out", [None, "dipole", "drag", "solar_pressure"])
def test_the_cubesat_obeys_its_equations(found, left_out):
    tables = tomllib.loads(FILE.read_text(encoding="utf-8"))["torques"]
    scene = ph.Scene.load(FILE)
    keep = [i for i, table in enumerate(tables) if table["kind"] != left_out]
    motion = ph.solve(scene.replace(times=TIMES, torques=[scene.torques[i] for i in keep]), accuracy=1e-9)
    apart = (ph.Rotation.from_quat(found[:, 3:]).inv() * motion.rotation).magnitude()
    assert motion.success
    if left_out is None:
        assert np.abs(found[:, :3] - motion.omega).max() < 1e-9 * motion.omega_scale and apart.max() < 1e-9
    else:
        assert apart.max() > 1e-4   # each torque counts
