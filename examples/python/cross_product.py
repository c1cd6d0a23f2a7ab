"""A cubesat with a gyroscope turns itself down by the cross-product law, m = k w x B / |B|^2.

Wertz 1978, Spacecraft Attitude Determination and Control, section 18.3.
"""

import numpy as np

import polhode as ph

orbit = ph.Orbit.from_elements(3.986004418e14, a=6.878e6, e=0.0, inclination=1.7)
field = ph.MagneticField.dipole(orbit, 7.8e15, tilt=2.97, spin=7.292e-5)


def cross_product(t, m, s, p):
    return p.k * np.cross(m.omega, m.field) / np.dot(m.field, m.field)


def run(k):
    law = ph.Controller(1.0, cross_product, output="dipole", field=field, limit=0.05, parameters={"k": k},
                        measure=ph.Measure(omega_noise=1e-4, omega_quantum=1e-4, seed=2))
    scene = ph.Scene(name="cross product", inertia=(0.0065, 0.0063, 0.0021), omega=(0.09, -0.12, 0.1),
                     controllers=[law], times=np.linspace(0, orbit.period, 5))
    return ph.solve(scene, accuracy=1e-5)


for k in (2e-6, 6e-6, 2e-5):
    motion = run(k)
    rates = np.degrees(np.linalg.norm(motion.omega, axis=1))
    print(f"k = {k:.0e} N m s: " + ", ".join(f"{rate:.3f}" for rate in rates) + " deg/s at each quarter of an orbit")
print(f"{len(motion.ticks[0].t)} ticks a run")
print(f"largest moment {np.abs(motion.ticks[0].command).max():.3f} A m^2")
print(f"error {motion.error:.1e} ({motion.error_kind})")
