"""
A cat that turns itself over
============================

A cat falls without angular momentum. Its halves circle against each other,
which gives the inside a momentum. The body answers, and ends upside down
from where it was, at rest.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

inertia, turns, seconds = np.array([1.0, 1.2, 1.5]), 3, 1.0
t = np.linspace(0, seconds, 401)
knots = np.linspace(0, seconds, 61)


def circle(size):
    """Momentum of the halves, which circle `turns` times, as cubics."""
    angle = 2 * np.pi * turns * knots / seconds
    grown = np.sin(np.pi * knots / seconds) ** 2   # begins and ends at 0
    h = np.array([np.cos(angle), np.sin(angle), 0 * angle]).T
    h = size * grown[:, None] * h
    slope = np.gradient(h, knots, axis=0)
    pieces = []
    for k in range(len(knots) - 1):
        d = knots[k + 1] - knots[k]
        rise = (h[k + 1] - h[k]) / d
        second = (3 * rise - 2 * slope[k] - slope[k + 1]) / d
        third = (slope[k] + slope[k + 1] - 2 * rise) / d**2
        pieces.append(
            (knots[k], knots[k + 1], [h[k], slope[k], second, third])
        )
    return ph.Changing(pieces)


def fall(size):
    cat = ph.Scene(
        inertia=inertia, momentum=circle(size), omega=(0, 0, 0), times=t
    )
    return ph.solve(cat, accuracy=1e-7)


figure, ax = plt.subplots(figsize=(6, 4))
for size in (7.0, 14.0, 20.7):
    motion = fall(size)
    turn = np.degrees(motion.rotation.magnitude())
    ax.plot(motion.t, turn, label=f"h up to {size:.0f} N m s")
ax.set_xlabel("time [s]")
ax.set_ylabel("from the first attitude [degrees]")
ax.legend()
plt.show()
