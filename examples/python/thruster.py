"""A thruster that fires in pulses, as a torque of one's own, with damping beside it; an event finds the spin wanted."""

import numpy as np

import polhode as ph


def pulses(t, omega, attitude):
    """Half a second in every two, smooth at both ends [N m]."""
    phase = t % 2.0
    return (0.0, 0.0, 0.4 * np.sin(2.0 * np.pi * phase) ** 2 if phase < 0.5 else 0.0)


thruster = ph.torques.Custom(pulses, uses_attitude=False, uses_rates=False)
drag = ph.torques.Damping((1e-3, 1e-3, 1e-3))
fast_enough = ph.Event(lambda t, omega, attitude: omega[2] - 1.0, direction=1, terminal=True)

scene = ph.Scene(inertia=(0.2, 0.4, 0.52), omega=(0.0, 0.0, 0.1), torques=[thruster, drag],
                 times=np.linspace(0.0, 60.0, 121), want=("omega",))
motion = ph.solve(scene, accuracy=1e-8, events=[fast_enough])

print(motion)
print(motion.message)
hit = motion.events[0]
print(f"1 rad/s about z after {hit.t:.6f} s")
for t, (_, _, spin) in list(zip(motion.t, motion.omega))[::2]:
    print(f"{t:6.1f} s   {spin:.6f} rad/s")
