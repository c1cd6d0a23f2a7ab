"""
Settling to the greatest moment
===============================

Inner friction takes energy and leaves the length of L. The body then ends in a
spin about the axis of its greatest moment. Here a torque across the momentum
stands for the friction.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

moments = np.array([0.20, 0.40, 0.52])


def friction(t, omega, attitude):
    """Take energy and keep the length of L: a torque across L."""
    L = moments * omega
    return 0.01 * np.cross(L, np.cross(L, omega)) / np.dot(L, L)


scene = ph.Scene(
    inertia=moments,
    omega=(5, 0.1, 0.1),
    times=np.linspace(0, 120, 6000),
    want=("omega",),
    torques=[ph.torques.Custom(friction, uses_time=False, uses_attitude=False)],
)
motion = ph.solve(scene, method="dop853", rtol=1e-9)
path = motion.omega * moments
path /= np.linalg.norm(path, axis=1)[:, None]

figure = plt.figure(figsize=(5, 5))
ax = figure.add_subplot(projection="3d", proj_type="ortho")
ax.plot(*path.T, lw=0.7)
ax.view_init(25, 35)
ax.set_axis_off()
ax.set_box_aspect((1, 1, 1), zoom=1.3)
plt.show()
