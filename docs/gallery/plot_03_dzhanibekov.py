"""
Dzhanibekov's nut
=================

A body that spins about its middle axis turns over again and again. A smaller
wobble only delays the flips.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

t = np.linspace(0, 40, 2000)
figure, axes = plt.subplots(3, 1, sharex=True, figsize=(6.4, 4.2))
for ax, wobble in zip(axes, (1e-1, 1e-3, 1e-6)):
    free = ph.FreeMotion((0.20, 0.40, 0.52), omega=(wobble, 5, wobble))
    _, attitude = free.at(t)
    middle = ph.Rotation.from_quat(attitude).apply((0, 1, 0))
    ax.plot(t, middle[:, 1])
    ax.set_title(f"wobble {wobble:g} rad/s", fontsize=9)
    ax.set_yticks([-1, 0, 1])
axes[1].set_ylabel("middle axis along its first direction")
axes[2].set_xlabel("time [s]")
plt.show()
