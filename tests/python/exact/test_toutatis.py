"""4179 Toutatis as a free body from 1992 to 2008, beside the residuals that Principia has from the same numbers.

Takahashi, Busch and Scheeres (2013), Spin state and moment of inertia characterization of 4179 Toutatis: the start,
the moments and the radar's attitudes and rates, in axes x, y, z with the moments 3.0836, 3.235 and 1. The residuals
stand in Principia's physics/euler_solver_test.cpp: of the size of the rate, of its direction, and of the axes of the
least, the middle and the largest moment [deg]. In 2008 they are large: the tides of the Earth and the Sun are left out.
"""

import datetime
import pathlib
import sys

import numpy as np
import pytest

import polhode as ph

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "derivative"))
import toutatis  # noqa: E402

MOMENTS = np.array([3.0836, 3.235, 1.0])
START = datetime.datetime(1992, 11, 9, 17, 49, 47)
RESIDUALS = """
0.011 4.5 7.9 5.4 5.9
0.076 0.5 6.6 7.7 4.7
0.005 5.0 13  15  9.4
0.064 1.1 9.4 4.3 8.4
0.032 0.8 2.0 0.6 2.1
0.028 24  5.7 15  15
0.0001 2.7 3.0 2.6 2.6
0.028 3.4 3.4 3.4 1.1
0.0009 0.8 3.1 1.4 3.4
0.022 1.0 2.8 1.6 2.7
0.025 2.2 2.0 3.2 2.6
0.013 3.4 2.5 5.3 5.3
0.119 22  4.1 3.8 4.5
0.026 4.9 3.2 8.2 8.0
0.052 2.6 7.3 5.8 8.0
0.045 2.1 0.8 1.1 1.2
0.036 2.1 5.6 6.3 4.1
0.0005 40 29  122 131
"""


def observed():
    """Seconds since the start, attitudes and rates [rad/s] of the seventeen rows of 1992 and the one of 2008."""
    days, attitudes, rates = toutatis.read()
    first = (datetime.datetime(1992, 12, 2, 21, 40) - START).total_seconds()
    late = (datetime.datetime(2008, 11, 23, 10, 45) - START).total_seconds() + 6   # leap seconds from 1993 to 2005
    times = np.append(first + days * 86400, late)
    last = ph.Rotation.from_euler("ZXZ", np.radians([86.2, 85.0, 0.3]))
    quaternions = np.vstack([attitudes.as_quat(), last.as_quat()])
    rates = np.vstack([rates, np.radians([-0.4, -36.2, -98.9])]) / 86400
    return times, ph.Rotation.from_quat(quaternions), rates


def angle(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def unit_of(text):
    """One unit of the last digit."""
    return 10.0 ** -len(text.partition(".")[2])


@pytest.mark.parametrize("row", range(18))
def test_the_free_motion_has_the_published_residuals(row):
    times, attitudes, rates = observed()
    omega = np.radians([14.51, 33.529, -98.709]) / 86400
    start = ph.Rotation.from_euler("ZXZ", np.radians([145.498, 65.865, 241.524]))
    body = ph.FreeMotion(MOMENTS, omega=omega, attitude=start)
    own_rate, own_attitude = body.at(times[row])
    turn = ph.Rotation.from_quat(own_attitude)
    found = [abs(np.linalg.norm(own_rate) / np.linalg.norm(rates[row]) - 1), angle(own_rate, rates[row])]
    found += [angle(turn.apply(axis), attitudes[row].apply(axis)) for axis in np.eye(3)[[2, 0, 1]]]
    for value, printed in zip(found, RESIDUALS.strip().splitlines()[row].split()):
        assert abs(value - float(printed)) <= unit_of(printed)
