"""
Polhodes
========

A free body's momentum runs along curves on a sphere. Blue curves go round the
axis of the greatest moment, green ones round that of the least. The orange one
is next to the separatrix.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

moments = np.array([0.20, 0.40, 0.52])


def draw(ax, direction, **style):
    """Draw the path that starts at a direction of the momentum."""
    free = ph.FreeMotion(moments, omega=direction / moments)
    omega, _ = free.at(np.linspace(0, min(free.period, 60.0), 500))
    ax.plot(*(omega * moments / np.linalg.norm(direction)).T, **style)


figure = plt.figure(figsize=(5, 5))
ax = figure.add_subplot(projection="3d", proj_type="ortho")
for angle in np.radians([5, 15, 27, 40, 55, 70]):
    for sign in (1, -1):
        draw(
            ax,
            np.array([0, np.sin(angle), sign * np.cos(angle)]),
            color="C1",
            lw=1,
        )
        draw(
            ax,
            np.array([sign * np.cos(angle), np.sin(angle), 0]),
            color="C2",
            lw=1,
        )
draw(ax, np.array([0.001, 1, 0.001]), color="C0", lw=2.5)
ax.view_init(25, 35)
ax.set_axis_off()
ax.set_box_aspect((1, 1, 1), zoom=1.3)
plt.show()
