"""Lagrange's top, released with its axis tilted and nothing but spin: it nods between two tilts and leaves cusps.

Integrated to nine digits and compared with the closed form.
"""

import numpy as np

import polhode as ph

moments = (1.0, 1.0, 0.5)   # about the pivot, symmetry axis last [kg m^2]
weight, arm = 2.0, 1.0      # N, and the distance of the centre of mass from the pivot along the axis, m
omega = (0.0, 0.0, 6.0)     # rad/s, body axes
attitude = ph.Rotation.from_euler("ZXZ", (0.0, 0.5, 0.0))

scene = ph.Scene(inertia=moments, omega=omega, attitude=attitude, times=np.linspace(0.0, 10.0, 11),
                 torques=[ph.torques.Gravity(weight, (0.0, 0.0, arm))])
motion = ph.solve(scene, accuracy=1e-9)
top = ph.HeavyTop(moments, weight * arm, omega, attitude)
true_omega, true_attitude = top.at(motion.t)

print(" t [s]   precession   tilt [deg]   height of the axis")
for t, (phi, theta, _) in zip(motion.t, np.degrees(motion.rotation.as_euler("ZXZ"))):
    print(f"{t:6.1f}   {phi:10.4f}   {theta:10.6f}   {np.cos(np.radians(theta)):10.6f}")

error = np.max((ph.Rotation.from_quat(true_attitude).inv() * motion.rotation).magnitude())
print(f"farthest from the closed form: {error:.0e} rad in {motion.stats['steps']} steps of {motion.plan.method}")
print("drift:", ", ".join(f"{name} {value:.0e}" for name, value in motion.drift.items()))
