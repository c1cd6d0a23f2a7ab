"""
A toy gyroscope
===============

A frame with a wheel is released at rest. Without a wheel it swings like a
pendulum. A faster wheel makes it nod less and precess more slowly.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

t, tilt = np.linspace(0, 30, 4000), ph.Rotation.from_euler("ZXZ", (0, 0.7, 0))
figure, axes = plt.subplots(1, 4, figsize=(8, 2.5), sharex=True, sharey=True)
for ax, wheel in zip(axes, (0.0, 2.0, 4.0, 8.0)):
    toy = ph.HeavyTop(
        (1.0, 1.0, 0.4),
        weight_arm=2.0,
        omega=(0, 0, 0),
        attitude=tilt,
        rotor=wheel,
    )
    axis = ph.Rotation.from_quat(toy.at(t)[1]).apply((0, 0, 1))
    ax.plot(axis[:, 0], axis[:, 1], lw=1)
    ax.set(title=f"wheel {wheel:g}", aspect="equal", xticks=[], yticks=[])
plt.show()
