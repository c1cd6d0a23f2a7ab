"""
An asteroid flies by
====================

Tumbling asteroids pass the Earth at 38 000 km, as Apophis will in 2029. They
differ in their attitude alone. The tide gives each another rate and another
pole.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

scene = ph.Scene.load("S13")
count, rng = 24, np.random.default_rng(2029)
times = np.linspace(1.5, 2.5, 201) * 86400
many = ph.solve_many(
    scene.replace(times=times),
    omega=np.tile(scene.omega, (count, 1)),
    attitude=ph.Rotation.random(count, rng=rng),
    accuracy=1e-7,
)
momentum = np.array(scene.inertia.moments) * many.omega
size = np.linalg.norm(momentum, axis=2)
rate = (momentum * many.omega).sum(axis=2) / size

figure, ax = plt.subplots(figsize=(6, 4))
ax.plot((times / 86400 - 2) * 24, (rate / rate[:, :1]).T, lw=0.8)
ax.axvline(0, color="0.8", zorder=0)
ax.set_xlabel("hours from the closest approach")
ax.set_ylabel("effective rate over that before")
plt.show()
