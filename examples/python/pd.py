"""A satellite points by PD feedback of the quaternion, sampled at 5 Hz, and its gains by the derivatives of the loop.

Wie 2008, Space Vehicle Dynamics and Control, section 7.3.
"""

import numpy as np

import polhode as ph

J = np.array((3.0, 2.4, 4.0))


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def run(kp, kd, **options):
    law = ph.Controller(0.2, pd, delay=0.1, limit=0.5, parameters={"kp": kp, "kd": kd})
    scene = ph.Scene(name="PD", inertia=J, omega=(0.02, -0.03, 0.01),
                     attitude=ph.Rotation.from_rotvec((0.9, -0.4, 0.3)), controllers=[law], times=np.linspace(0, 30, 7))
    return ph.solve(scene, accuracy=1e-10, **options)


motion = run(0.6, 2.2, sensitivity=("controllers.0.kp", "controllers.0.kd"))
angle = 2 * np.degrees(np.arccos(np.abs(motion.attitude[:, 3]).clip(max=1)))
for t, one in zip(motion.t, angle, strict=True):
    print(f"{t:5.1f} s  {one:8.4f} deg from the target")
slopes = motion.sensitivity
by_kp, by_kd = np.linalg.norm(np.moveaxis(slopes.d_attitude[-1], -1, 0), axis=1)
print(f"the attitude at 30 s moves by {by_kp:.2e} rad a unit of kp, and by {by_kd:.2e} rad a unit of kd")
again = (run(0.6001, 2.2).omega - run(0.5999, 2.2).omega) / 2e-4
print(f"two runs apart give the same within {np.abs(again - slopes.d_omega[..., 0]).max():.0e}")
print(f"error {motion.error:.1e} ({motion.error_kind})")
