"""
A cubesat for a day
===================

A cubesat with a panel spins. Gravity, its own magnetism, the air and the
light turn its axis through fifteen orbits. The Earth's shadow switches the
light off in each.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

scene = ph.Scene.load("S12")
motion = ph.solve(scene, accuracy=1e-8)
hours = motion.t / 3600
pole = motion.angular_momentum
size = np.linalg.norm(pole, axis=1)
moved = np.degrees(np.arccos(np.clip(pole @ pole[0] / size / size[0], -1, 1)))
panel = motion.rotation.apply((0, 1, 0))
lit = np.degrees(np.arccos(panel @ (0.8, 0.48, 0.36)))

figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6, 5))
axes[0].plot(hours, moved, label="L from its start")
axes[0].plot(hours, lit, lw=0.6, label="panel from the sun")
axes[0].set_ylabel("degrees")
axes[0].legend()
axes[1].plot(hours, size / size[0])
axes[1].set_ylabel("|L| over its start")
axes[1].set_xlabel("time [h]")
plt.show()
