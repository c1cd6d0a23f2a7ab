"""
Held by the Earth
=================

The gravity gradient turns a long satellite towards the vertical. It swings in
the plane of its orbit like a pendulum. Above a certain rate it tumbles over.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

n = 0.0011  # mean motion of a low orbit [rad/s]
figure, ax = plt.subplots()
for push in (0.2, 0.5, 0.8, 0.98, 1.04, 1.2):
    # of the swing that just reaches the horizontal
    fastest = n * np.sqrt(3 * (18.0 - 12.0) / 25.0)
    scene = ph.Scene(
        inertia=(12, 18, 25),
        omega=(0, 0, n + push * fastest),
        torques=[ph.torques.GravityGradient(n)],
        times=np.linspace(0, 3 * 2 * np.pi / n, 1500),
    )
    motion = ph.solve(scene, accuracy=1e-8)
    along = motion.rotation.apply((1, 0, 0))
    angle = np.unwrap(np.arctan2(along[:, 1], along[:, 0])) - n * motion.t
    ax.plot(
        np.degrees(angle),
        (motion.omega[:, 2] - n) / n,
        color="C1" if push < 1 else "C0",
    )
ax.set(
    xlabel="off the vertical [degrees]",
    ylabel="rate of the swing / mean motion",
    xlim=(-100, 400),
)
plt.show()
