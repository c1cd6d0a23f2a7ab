"""
Detumbling by thrusters
=======================

Three firings take out the momentum that a satellite has at that moment. Between
them it coasts, which costs nothing to compute. The plan cuts the span at each
switch.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

body = ph.InertiaTensor.from_moments((12.0, 18.0, 25.0))
start = omega = np.array([0.06, -0.04, 0.09])
attitude, now, firings = (0, 0, 0, 1), 0.0, []
for length, coast in ((20.0, 120.0), (10.0, 120.0), (5.0, 120.0)):
    firings.append(
        ph.torques.During(
            ph.torques.Constant(-body.matrix @ omega / length),
            (now, now + length),
        )
    )
    scene = ph.Scene(
        inertia=body,
        omega=omega,
        attitude=attitude,
        torques=[firings[-1]],
        t0=now,
        times=[now + length + coast],
    )
    motion = ph.solve(scene, accuracy=1e-10)
    omega, attitude, now = (
        motion.omega[-1],
        motion.attitude[-1],
        scene.times[-1],
    )

motion = ph.solve(
    ph.Scene(
        inertia=body,
        omega=start,
        torques=firings,
        times=np.linspace(0, now, 2001),
    ),
    accuracy=1e-9,
)
figure, ax = plt.subplots()
ax.semilogy(motion.t, np.linalg.norm(motion.omega, axis=1))
for piece in motion.plan.pieces:
    if piece.method != "exact":
        ax.axvspan(piece.begin, piece.end, alpha=0.2, color="C1", lw=0)
ax.set(xlabel="time [s]", ylabel="rate [rad/s]")
plt.show()
