"""Laws of torques as functions that formulas are traced from."""

import numpy as np

from polhode.formula import norm, to_body


def pd(t, omega, attitude, p):
    return -p.kp * attitude[:3] * attitude[3] - p.kd * omega


def drag(t, omega, attitude, p):
    return -p.c * norm(omega) * omega


def spring(t, omega, attitude, p):
    aim = to_body(attitude, (0, 1, 0))
    across = np.cross((0, 0, 1), aim)
    sine = norm(across)
    return p.k * np.arctan2(sine, aim[2]) / sine * across - p.c * omega


def dipole(t, omega, attitude, p):
    field = (0.6 * np.cos(p.n * t), 1.1 * np.sin(p.n * t), 0.3)
    return np.cross(p.moment, to_body(attitude, field))


def mixture(t, omega, attitude, p):
    size = p.a + omega[0] ** 2 + omega[1] ** 2
    return np.array([0.2 * np.exp(-p.b * t) * np.sin(omega[2]) - 0.1 * omega[0],
                     0.1 * np.log(size) * attitude[0] - 0.05 * omega[1] ** 3,
                     0.3 * size**-1.3 * np.cos(0.7 * t)])
