"""
A twisting somersault
=====================

A diver somersaults. The arms tilt the principal axes at once, and the
somersault becomes a twist. With the arms back, the twist ends. The angular
momentum in space is constant.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

straight = np.diag([15.0, 15.5, 1.0])
c, s = np.cos(0.15), np.sin(0.15)
tilt = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
twisting = ph.InertiaTensor(tilt @ straight @ tilt.T)

# After two periods of the rates the arms take the twist away.
rates = np.linalg.solve(twisting.matrix, straight @ (6, 0, 0))
end = 0.3 + 2 * ph.FreeMotion(twisting, rates).period
dive = ph.Changing(
    [(0.3, end, [twisting.matrix])], before=straight, after=straight
)
diver = ph.Scene(inertia=dive, omega=(6, 0, 0), times=np.linspace(0, 1.6, 801))
motion = ph.solve(diver, accuracy=1e-9)

figure, axes = plt.subplots(2, 1, sharex=True, figsize=(6, 5))
for values, name in zip(motion.omega.T, ("somersault", "tilt", "twist")):
    axes[0].plot(motion.t, values, label=name)
for values, name in zip(motion.angular_momentum.T, "xyz"):
    axes[1].plot(motion.t, values, label=f"L{name}")
axes[0].set_ylabel("rate [rad/s]")
axes[1].set_ylabel("L in space [N m s]")
axes[1].set_xlabel("t [s]")
for ax in axes:
    ax.legend(loc="upper left")
plt.show()
