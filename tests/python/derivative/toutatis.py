"""4179 Toutatis in 1992: attitudes and rates by radar, as a table.

The numbers are those of Takahashi, Busch and Scheeres (2013), Spin state and moment of inertia characterization of 4179
Toutatis, as the test of Principia's Euler solver gives them. Euler angles z-x-z [deg] take the body to space, in axes
x, y, z whose moments are in the ratios 3.0836, 3.235 and 1. Rates are in deg a day. Times are in UTC of December 1992.
"""

import numpy as np

import polhode as ph

RATIOS = np.array([3.0836, 3.235, 1.0]) / 3.235
ROWS = """
02 21:40 122.2 86.5 107.0 -35.6   7.2  -97.0
03 19:30  86.3 81.8  24.5 -16.4 -29.1  -91.9
04 18:10  47.8 60.7 284.0  29.1 -23.2  -97.8
05 18:50  14.6 39.4 207.1  33.3   8.2  -92.2
06 17:30 331.3 23.7 151.6   6.6  34.5  -95.8
07 17:20 222.5 25.4 143.9  12.8  25.4 -104.1
08 16:40 169.8 45.5 106.9 -31.1 -21.9  -97.7
09 17:50 137.3 71.3  22.3  11.8 -36.9  -94.9
10 17:20 103.1 85.2 292.6  35.8  -8.9  -97.9
11 09:40  77.0 85.7 225.5  31.0  17.0  -96.3
12 09:20  42.8 70.2 133.2  -1.3  37.0  -95.9
13 08:10  13.7 44.4  51.9 -38.3  17.9  -97.3
14 07:50 323.7 14.0   0.0 -70.5 -30.6  -91.1
15 07:50 193.2 24.4  21.4  22.1 -26.6  -96.6
16 07:10 165.1 46.4 310.6  33.4  -3.4  -93.7
17 06:49 130.6 76.1 234.9  12.6  33.9  -94.0
18 07:09  91.6 81.6 142.4 -24.3  29.6 -102.0
"""


def read():
    """Return times since the first row [days], attitudes, and rates [rad/day]."""
    rows = [line.split() for line in ROWS.strip().splitlines()]
    t = np.array([int(day) + int(clock[:2]) / 24 + int(clock[3:]) / 1440 for day, clock, *_ in rows])
    numbers = np.radians(np.array([row[2:] for row in rows], dtype=float))
    return t - t[0], ph.Rotation.from_euler("ZXZ", numbers[:, :3]), numbers[:, 3:]
