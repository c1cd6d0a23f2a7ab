"""
Three kinds of nutation
=======================

The axis of a top seen from above. A push along the precession gives waves, none
gives cusps, and a push against it gives loops.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

tilt = ph.Rotation.from_euler("ZXZ", (0, 0.5, 0))
t = np.linspace(0, 16, 3000)
figure, axes = plt.subplots(1, 3, figsize=(7.5, 2.8), sharex=True, sharey=True)
for ax, push, colour in zip(axes, (0.35, 0.0, -0.5), ("C0", "C1", "C2")):
    top = ph.HeavyTop(
        (1.0, 1.0, 0.5), weight_arm=2.0, omega=(0, push, 6), attitude=tilt
    )
    axis = ph.Rotation.from_quat(top.at(t)[1]).apply((0, 0, 1))
    ax.plot(axis[:, 0], axis[:, 1], color=colour)
    ax.set(title=top.kind, aspect="equal", xticks=[], yticks=[])
plt.show()
