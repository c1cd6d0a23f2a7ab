"""A cubesat turns itself down by B-dot: a moment against the change of the field between two samples.

The law and its gain are those of Avanzini and Giulietti 2012, Journal of Guidance, Control, and Dynamics 35, 1326.
"""

import numpy as np

import polhode as ph

orbit = ph.Orbit.from_elements(3.986004418e14, a=6.878e6, e=0.0, inclination=1.7)
field = ph.MagneticField.dipole(orbit, 7.8e15, tilt=2.97, spin=7.292e-5)
J = np.array((0.0065, 0.0063, 0.0021))   # a 3U cubesat [kg m^2]
rate = np.sqrt(3.986004418e14 / 6.878e6**3)
gain = 2 * rate * (1 + np.sin(1.5)) * J.min()   # times 1 / |B|^2 below


def bdot(t, m, s, p):
    """The change of the field's direction; nothing before there are two samples."""
    size = np.sqrt(m.field[0] ** 2 + m.field[1] ** 2 + m.field[2] ** 2)
    b = m.field / size
    change = np.where(s.n > 0, (b - s.old) / p.period, 0.0 * b)
    return -p.gain * change / size, {"old": b, "n": s.n + 1}


law = ph.Controller(0.5, bdot, output="dipole", field=field, limit=0.05, states={"old": (0, 0, 0), "n": 0.0},
                    parameters={"gain": gain, "period": 0.5}, measure=ph.Measure(field_noise=5e-8, seed=1))
scene = ph.Scene(name="B-dot", inertia=J, omega=(0.09, -0.12, 0.1), controllers=[law],
                 times=np.linspace(0, 2 * orbit.period, 9))
motion = ph.solve(scene, accuracy=1e-6)

for t, omega in zip(motion.t, np.linalg.norm(motion.omega, axis=1), strict=True):
    print(f"{t / orbit.period:5.2f} orbits  {np.degrees(omega):7.3f} deg/s")
print(f"{len(motion.ticks[0].t)} ticks, largest moment {np.abs(motion.ticks[0].command).max():.3f} A m^2")
print(f"error {motion.error:.1e} ({motion.error_kind})")
