"""
Judge your own integrator
=========================

A closed form is a reference that costs nothing. Here it judges a Runge-Kutta
step as one writes it in an afternoon, on a calm body and on a racket.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

moments = np.array([0.20, 0.40, 0.52])


def slope(omega):
    """Euler's equations."""
    return -np.cross(omega, moments * omega) / moments


def runge_kutta(omega, h, steps):
    """Your integrator."""
    for _ in range(steps):
        a = slope(omega)
        b = slope(omega + h / 2 * a)
        c = slope(omega + h / 2 * b)
        d = slope(omega + h * c)
        omega = omega + h / 6 * (a + 2 * b + 2 * c + d)
    return omega


figure, ax = plt.subplots()
counts = 2 ** np.arange(6, 13)
for name, start in (("calm", (0.3, 0.2, 5.0)), ("racket", (1e-4, 5.0, 1e-4))):
    exact, _ = ph.FreeMotion(moments, omega=start).at(20.0)
    errors = [
        np.linalg.norm(runge_kutta(np.array(start), 20 / n, n) - exact) / 5
        for n in counts
    ]
    ax.loglog(20 / counts, errors, "o-", label=name)
ax.set(xlabel="step [s]", ylabel="relative error after 20 s")
ax.legend()
plt.show()
