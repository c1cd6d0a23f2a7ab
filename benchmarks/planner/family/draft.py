"""A scene in the making. Kinds change a draft; at the end it becomes a scene, in units of its own."""

from dataclasses import dataclass, field

import numpy as np

import polhode as ph


@dataclass
class Draft:
    """Times and windows are in spans until the end, so that a kind may still change the span."""

    moments: np.ndarray
    omega: np.ndarray
    attitude: np.ndarray
    pace: float                                     # rate that torques and the span are measured by [rad/s]
    turns: float                                    # span x pace / 2 pi
    grid: np.ndarray
    torques: list = field(default_factory=list)     # (torque, its windows or None)
    rotors: list = field(default_factory=list)      # (axis, its numbers by name, its windows or None)
    axes: ph.Rotation | None = None                 # of the principal axes in the body
    late: float = 0.0                               # time of the start, in spans
    want: tuple = ("omega", "attitude")
    inertia_unit: float = 1.0
    time_unit: float = 1.0
    near_edges: bool = False                        # samples at the ends of windows and next to them

    @property
    def span(self):
        return 2 * np.pi * self.turns / self.pace

    @property
    def push(self):
        """The torque that would change the body's motion within a radian."""
        return self.moments.max() * self.pace ** 2

    def add(self, torque, windows=None):
        self.torques.append((torque, windows))

    def add_rotor(self, axis, windows=None, **numbers):
        self.rotors.append((axis, numbers, windows))

    def finish(self, name):
        moments, span = self.inertia_unit * self.moments, self.time_unit * self.span
        inertia, omega = moments, self.omega
        if self.axes is not None:
            R = self.axes.as_matrix()
            tensor = R @ np.diag(moments) @ R.T
            inertia, omega = (tensor + tensor.T) / 2, R @ omega
        t0 = self.late * span
        torques = []
        for torque, windows in self.torques:
            torque = scale(torque, self.inertia_unit, self.time_unit)
            torques.append(torque if windows is None else ph.torques.During(torque, t0 + span * np.asarray(windows)))
        if any(isinstance(torque, ph.torques.GravityGradient) for torque, _ in self.torques):
            for _, numbers, _ in self.rotors:   # free ones are refused there
                numbers.pop("free", None)
        rotors = [ph.Rotor(axis, **scale_rotor(numbers, self.inertia_unit, self.time_unit),
                           during=None if windows is None else t0 + span * np.asarray(windows))
                  for axis, numbers, windows in self.rotors]
        times = t0 + span * self.grid
        if self.near_edges:
            times = add_edges(times, torques, rotors)
        return ph.Scene(inertia=inertia, omega=omega / self.time_unit, attitude=self.attitude, torques=torques, t0=t0,
                        rotors=rotors, times=times, want=self.want, name=name)


def add_edges(times, torques, rotors, most=12):
    """The last times, the ends of windows of torques, and their neighbours in float64 and those of rotors' ends.

    At the end of a rotor's window the rates jump, and at that very time the truth has those before.
    """
    own = {end for torque in torques if isinstance(torque, ph.torques.During) for window in torque.windows
           for end in window}
    jumps = {end for rotor in rotors if rotor.during is not None for window in rotor.during for end in window}
    ends = [np.array(sorted(end for end in some if times.min() < end < times.max())[:most]) for some in (own, jumps)]
    beside = np.concatenate(ends)
    return np.unique([*times[-5:], *ends[0], *np.nextafter(beside, -np.inf), *np.nextafter(beside, np.inf)])


def scale(torque, inertia, time):
    """The same torque in other units: what was 1 kg m^2 and 1 s becomes `inertia` and `time`."""
    match torque:
        case ph.torques.Constant():
            return ph.torques.Constant(np.asarray(torque.torque) * (inertia / time ** 2), torque.frame)
        case ph.torques.Gravity():
            return ph.torques.Gravity(torque.weight * (inertia / time ** 2), torque.arm)
        case ph.torques.GravityGradient():
            return ph.torques.GravityGradient(torque.mean_motion / time, torque.phase)
        case ph.torques.Damping():
            return ph.torques.Damping(np.asarray(torque.matrix) * (inertia / time))
        case ph.torques.AngularDamping():
            return ph.torques.AngularDamping(torque.rate / time)
        case ph.torques.Custom():
            return ph.torques.Custom(torque.function.scaled(inertia, time))


def scale_rotor(numbers, inertia, time):
    """The same rotor in other units."""
    units = {"momentum": inertia / time, "inertia": inertia, "speed": 1 / time}
    return {name: value * units[name] if name in units else value for name, value in numbers.items()}
