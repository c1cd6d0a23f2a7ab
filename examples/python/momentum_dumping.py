"""Three wheels hold a satellite against a constant push, and three coils take the momentum out of them.

m = k h x B / |B|^2 with h the momentum of the wheels: Camillo and Markley 1980, Journal of Guidance and Control 3, 567.
"""

import numpy as np

import polhode as ph

orbit = ph.Orbit.from_elements(3.986004418e14, a=6.878e6, e=0.0, inclination=1.2)
field = ph.MagneticField.dipole(orbit, 7.8e15, tilt=2.97, spin=7.292e-5)
WHEEL = 2e-4   # moment about its axis [kg m^2]


def point(t, m, s, p):
    """The motors: what turns a wheel one way turns the body the other."""
    return p.kp * m.attitude[:3] * m.attitude[3] + p.kd * m.omega


def dump(t, m, s, p):
    return p.k * np.cross(p.inertia * m.speed, m.field) / np.dot(m.field, m.field)


def run(k):
    rotors = [ph.Rotor(axis, inertia=WHEEL, speed=0.0, free=True) for axis in np.eye(3)]
    wheels = ph.Controller(0.5, point, output="rotor_torque", parameters={"kp": 0.02, "kd": 0.2})
    coils = ph.Controller(2.0, dump, output="dipole", field=field, rotors=3, limit=1.0,
                          parameters={"k": k, "inertia": WHEEL})
    scene = ph.Scene(name="dumping", inertia=(0.9, 0.7, 0.5), omega=(1e-3, -5e-4, 8e-4), rotors=rotors,
                     controllers=[wheels, coils], torques=[ph.torques.Constant((2e-6, -1e-6, 1e-6), frame="space")],
                     times=np.linspace(0, orbit.period, 7))
    return ph.solve(scene, accuracy=1e-6)


without, with_coils = run(0.0), run(2e-3)
print("momentum of the wheels [N m s], without and with the coils")
for t, a, b in zip(without.t, without.rotor_speed, with_coils.rotor_speed, strict=True):
    print(f"{t / orbit.period:5.2f} orbits  {WHEEL * np.linalg.norm(a):.5f}  {WHEEL * np.linalg.norm(b):.5f}")
angle = 2 * np.degrees(np.arccos(np.abs(with_coils.attitude[:, 3]).clip(max=1))).max()
print(f"largest angle {angle:.4f} deg; error {with_coils.error:.1e} ({with_coils.error_kind})")
