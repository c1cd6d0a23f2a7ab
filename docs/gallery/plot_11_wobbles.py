"""
A thousand throws
=================

The hand adds a wobble to each throw. The time of the first flip spreads, with a
long tail of clean throws.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

rng = np.random.default_rng(1)
figure, ax = plt.subplots()
for wobble in (0.1, 0.01, 0.001):
    starts = np.array([0, 5, 0]) + rng.normal(scale=wobble, size=(1000, 3))
    first = [
        ph.FreeMotion((0.20, 0.40, 0.52), omega=w).flip_times(0, 60)[0]
        for w in starts
    ]
    ax.hist(
        first,
        bins=np.linspace(0, 10, 80),
        alpha=0.7,
        label=f"wobble {wobble:g} rad/s",
    )
ax.set(xlabel="first flip [s]", ylabel="throws")
ax.legend()
plt.show()
