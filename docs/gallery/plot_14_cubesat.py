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

orbit = ph.Orbit.from_elements(
    3.986004418e14, a=6.86e6, e=0.01, inclination=0.9, node=0.4, periapsis=0.7
)
field = ph.MagneticField.dipole(orbit, 7.9e15, tilt=2.97, spin=7.292e-5)
up, down, centre = (0, 1, 0), (0, -1, 0), (0.02, 0.055, 0.03)
sun = (0.8, 0.48, 0.36)
dark = [ph.Plate(0.09, side, centre) for side in (up, down)]
bright = [
    ph.Plate(0.09, up, centre, specular=0.2, diffuse=0.1),
    ph.Plate(0.09, down, centre, specular=0.1, diffuse=0.5),
]
torques = [
    ph.torques.GravityGradient(orbit=orbit),
    ph.torques.Dipole((0.002, 0.001, -0.0015), field),
    ph.torques.Drag(
        dark, orbit, 2.2, density=2.4e-12, height_radius=6.828e6,
        scale_height=6e4, spin=7.292e-5,
    ),
    ph.torques.SolarPressure(
        bright, sun, 4.56e-6, orbit=orbit, shadow=6.378e6
    ),
]
scene = ph.Scene(
    inertia=(0.031, 0.05, 0.028),
    omega=(0.004, 0.06, -0.003),
    torques=torques,
    times=np.linspace(0, 86400, 1441),
)
motion = ph.solve(scene, accuracy=1e-8)
hours = motion.t / 3600
pole = motion.angular_momentum
size = np.linalg.norm(pole, axis=1)
moved = np.degrees(np.arccos(np.clip(pole @ pole[0] / size / size[0], -1, 1)))
lit = np.degrees(np.arccos(motion.rotation.apply(up) @ sun))

figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6, 5))
axes[0].plot(hours, moved, label="L from its start")
axes[0].plot(hours, lit, lw=0.6, label="panel from the sun")
axes[0].set_ylabel("degrees")
axes[0].legend()
axes[1].plot(hours, size / size[0])
axes[1].set_ylabel("|L| over its start")
axes[1].set_xlabel("time [h]")
plt.show()
