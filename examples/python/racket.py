"""A brick thrown with a spin about its middle axis, as a tennis racket is: it flips, again and again.

The closed form tells where it is at any time; rk45 follows it step by step, and the table shows how far it strays. The
same program in C++, with the same output: examples/cpp/racket.cpp.
"""

import numpy as np

import polhode as ph

block = ph.shapes.box(12.0, (0.3, 0.2, 0.1))   # kg, half sides in m
omega = (1e-2, 5.0, 1e-2)                      # rad/s, body axes
rtol = 1e-8

exact = ph.FreeMotion(block.inertia, omega)
scene = ph.Scene(inertia=block.inertia, omega=omega, times=np.arange(1.0, 16.0))
motion = ph.solve(scene, method="rk45", rtol=rtol)

print("moments {:.4f} {:.4f} {:.4f} kg m^2,".format(*block.inertia.moments),
      "omega {:g} {:g} {:g} rad/s".format(*omega))
flips = " ".join(f"{t:.6f}" for t in exact.flip_times(0.0, 15.0))
print(f"closed form: motion {exact.kind}, period {exact.period:.9f} s, flips at {flips} s")
print(f"rk45: rtol {rtol:.0e}, {motion.stats['steps']} steps\n")

true_omega, true_attitude = exact.at(motion.t)
angle = (ph.Rotation.from_quat(true_attitude).inv() * motion.rotation).magnitude()
largest = np.linalg.norm(true_omega, axis=1).max()   # of |omega|, the measure of its error
error = np.maximum(np.linalg.norm(motion.omega - true_omega, axis=1) / largest, angle)
drift = abs(motion.energy / exact.energy - 1.0)

print("   t        omega_x    omega_y    omega_z    energy drift  rk45's error")
for t, (x, y, z), moved, far in zip(motion.t, true_omega, drift, error):
    print(f"{t:6.1f}   {x:10.6f} {y:10.6f} {z:10.6f}    {moved:9.1e}     {far:9.1e}")
