"""
Chaos of a heavy body
=====================

A heavy body without symmetry has no closed form. Two starts that differ by
1e-10 rad/s part by a factor of e again and again. The certificate of an answer
shows how far it can be known.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

scene = ph.Scene.load("S5c")
scene = scene.replace(times=np.linspace(0, scene.times[-1], 600))
here = ph.solve(scene, method="taylor", rtol=1e-14)
there = ph.solve(
    scene.replace(omega=scene.omega + np.array([1e-10, 0, 0])),
    method="taylor",
    rtol=1e-14,
)
apart = np.linalg.norm(here.omega - there.omega, axis=1)

figure, ax = plt.subplots()
ax.semilogy(here.t[1:], apart[1:])
ax.set(xlabel="time [s]", ylabel="distance of the rates [rad/s]")
plt.show()
