"""A tumbling satellite, slowed down by three firings of its thrusters; between them it coasts, which costs nothing."""

import numpy as np

import polhode as ph

tensor = ph.InertiaTensor.from_moments((12.0, 18.0, 25.0))
omega, attitude, now = np.array((0.06, -0.04, 0.09)), (0.0, 0.0, 0.0, 1.0), 0.0
firings = []

# Each firing takes out the angular momentum of its moment, as far as the body axes hold still meanwhile.
for length, coast in ((20.0, 600.0), (10.0, 600.0), (5.0, 600.0)):
    torque = ph.torques.Constant(-tensor.matrix @ omega / length)
    firings.append(ph.torques.During(torque, (now, now + length)))
    scene = ph.Scene(inertia=tensor, omega=omega, attitude=attitude, torques=[firings[-1]],
                     times=[now + length + coast], t0=now)
    motion = ph.solve(scene, accuracy=1e-10)
    omega, attitude, now = motion.omega[-1], motion.attitude[-1], now + length + coast

# The whole story in one scene: four thousand samples, certified from end to end.
scene = ph.Scene(name="detumble", inertia=tensor, omega=(0.06, -0.04, 0.09), torques=firings,
                 times=np.linspace(0.0, now, 4001))
motion = ph.solve(scene, accuracy=1e-9)

print(motion.plan)
print(motion)
spin = np.linalg.norm(motion.omega, axis=1)
for piece in motion.plan.pieces:
    at = spin[np.searchsorted(motion.t, piece.end, side="right") - 1]
    print(f"{piece.begin:7.1f} to {piece.end:7.1f} s by {piece.model:9} {at:.6f} rad/s at its end")
print(f"largest error {motion.error:.1e}, {motion.error_kind}")
