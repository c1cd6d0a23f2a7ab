"""
A wheel that spins up
=====================

A motor spins up a wheel. The wheel sticks, slides with a growing torque, has
the full torque, and reaches its top speed. The angular momentum of wheel and
body stays.
"""

import matplotlib.pyplot as plt

import polhode as ph

scene = ph.Scene.load("S15")
motion = ph.solve(scene, accuracy=1e-12)
speed = motion.rotor_speed[:, 0]
begins = (0.0, motion.t[speed > 1e-6][0], 30.0, motion.t[speed > 99.999][0])

figure, axes = plt.subplots(3, 1, sharex=True, figsize=(6, 6))
axes[0].plot(motion.t, speed)
axes[0].set_ylabel("wheel [rad/s]")
axes[1].plot(motion.t, motion.omega)
axes[1].set_ylabel("body [rad/s]")
axes[2].plot(motion.t, motion.angular_momentum)
axes[2].set_ylabel("L in space [N m s]")
axes[2].set_xlabel("time [s]")
for begin, name in zip(begins, ("", "slides", "full torque", "top speed")):
    for ax in axes:
        ax.axvline(begin, color="0.8", zorder=0)
    axes[0].text(begin + 1, 102, name, va="bottom", fontsize=8)
axes[0].set_ylim(-5, 118)
plt.show()
