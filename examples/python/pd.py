"""A satellite points by PD feedback of the quaternion, sampled at 5 Hz, with the delay of its computer.

Wie 2008, Space Vehicle Dynamics and Control, section 7.3.
"""

import numpy as np

import polhode as ph

J = np.array((3.0, 2.4, 4.0))


def pd(t, m, s, p):
    return -p.kp * m.attitude[:3] * m.attitude[3] - p.kd * m.omega


def run(delay):
    law = ph.Controller(0.2, pd, delay=delay, limit=2.0, parameters={"kp": 3.0, "kd": 5.0})
    scene = ph.Scene(name="PD", inertia=J, omega=(0.02, -0.03, 0.01),
                     attitude=ph.Rotation.from_rotvec((0.9, -0.4, 0.3)), controllers=[law],
                     times=np.linspace(0, 20, 6))
    return ph.solve(scene, accuracy=1e-9)


for delay in (0.0, 0.3, 0.9):
    motion = run(delay)
    angle = 2 * np.degrees(np.arccos(np.abs(motion.attitude[:, 3]).clip(max=1)))
    print(f"a delay of {delay:.1f} s: " + ", ".join(f"{one:.4f}" for one in angle) + " deg from the target each 4 s")
    print(f"  {len(motion.ticks[0].t)} ticks; error {motion.error:.1e} ({motion.error_kind})")
