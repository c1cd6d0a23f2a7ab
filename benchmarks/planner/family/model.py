"""A body under every torque of the library, for heyoka: its equations, and its coefficients with 50 digits.

In principal axes, with time in units of `unit`, w' = k w w + a + D w + (matrices) (rows of R) + turning vectors + drag:

    rows     r_x, r_y, r_z are the space axes in the body: weights and torques constant in space are linear in them
    turning  u = cos(a) r_x + sin(a) r_y, a = n t + phase: gravity gradients are 3 n^2 u x I u, turning fields m x b u

Every torque is linear in coefficients. Those that act at a time are added, so that windows change numbers alone.
A rotor's momentum h is a part of D: -w x h. The inertia is that without the axial moments of free rotors.
"""

from dataclasses import dataclass

import mpmath
import numpy as np

import polhode as ph

from .custom import Brake, Drag, Magnet, Wheel

mp = mpmath.mp.clone()
mp.dps = 50


@dataclass(frozen=True)
class Structure:
    """What decides the equations; all else is numbers."""

    rows: bool
    turning: int
    drag: bool


def build_equations(heyoka, structure):
    """The system of heyoka. Its parameters are k, a, D, rows, drag and, for each turning vector, n, phase, I, F."""
    w, q = heyoka.make_vars("wx", "wy", "wz"), heyoka.make_vars("x", "y", "z", "s")
    x, y, z, s = q
    used = 0

    def numbers(*shape):
        nonlocal used
        found = np.array([heyoka.par[used + i] for i in range(int(np.prod(shape)))], dtype=object).reshape(shape)
        used += found.size
        return found

    def times(matrix, v):
        return [heyoka.sum([matrix[i, j] * v[j] for j in range(3)]) for i in range(3)]

    k, a, D = numbers(3), numbers(3), numbers(3, 3)
    terms = [[k[i] * w[(i + 1) % 3] * w[(i + 2) % 3], a[i], damped] for i, damped in enumerate(times(D, w))]

    def add(vector):
        for i in range(3):
            terms[i].append(vector[i])

    r_x = [s * s + x * x - y * y - z * z, 2. * (x * y - s * z), 2. * (x * z + s * y)]
    r_y = [2. * (x * y + s * z), s * s - x * x + y * y - z * z, 2. * (y * z - s * x)]
    r_z = [2. * (x * z - s * y), 2. * (y * z + s * x), s * s - x * x - y * y + z * z]
    if structure.rows:
        for row in (r_x, r_y, r_z):
            add(times(numbers(3, 3), row))
    if structure.drag:
        square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2]
        add([c * square * w[i] for i, c in enumerate(numbers(3))])
    for _ in range(structure.turning):
        rate, phase = numbers(2)
        angle = rate * heyoka.time + phase
        cosine, sine = heyoka.cos(angle), heyoka.sin(angle)
        u = [cosine * r_x[i] + sine * r_y[i] for i in range(3)]
        add([c * u[(i + 1) % 3] * u[(i + 2) % 3] for i, c in enumerate(numbers(3))])
        add(times(numbers(3, 3), u))
    turn = [s * w[0] + y * w[2] - z * w[1], s * w[1] + z * w[0] - x * w[2], s * w[2] + x * w[1] - y * w[0],
            -(x * w[0]) - y * w[1] - z * w[2]]
    return [*((w[i], heyoka.sum(terms[i])) for i in range(3)), *((q[i], 0.5 * turn[i]) for i in range(4))]


def vector(values):
    return mp.matrix([mp.mpf(float(v)) for v in values])


def cross(v):
    """The matrix that takes u to v x u."""
    return mp.matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def multiply(p, q):
    """Hamilton's product, (x, y, z, s)."""
    (a, b, c, d), (x, y, z, s) = p, q
    return [d * x + a * s + b * z - c * y, d * y - a * z + b * s + c * x, d * z + a * y - b * x + c * s,
            d * s - a * x - b * y - c * z]


class Body:
    """A scene's body in its principal axes, exactly, but for the 50 digits."""

    def __init__(self, scene):
        tensor = mp.matrix(np.asarray(scene.inertia.matrix).tolist())
        for rotor in scene.rotors:
            if rotor.free and rotor.inertia is not None:
                axis = unit_axis(rotor)
                tensor -= mp.mpf(rotor.inertia) * axis * axis.T
        self.R = mp.eye(3)                # principal axes to body axes
        self.turn = [mp.mpf(0)] * 3 + [mp.mpf(1)]
        if all(tensor[i, j] == 0 for i in range(3) for j in range(3) if i != j):
            self.moments = mp.matrix([tensor[i, i] for i in range(3)])
        else:
            self.moments, self.R = mp.eigsy(tensor)
            if mp.det(self.R) < 0:
                self.R = -self.R
            self.turn = write_quaternion(self.R)
        I = self.moments
        self.k = [(I[(i + 1) % 3] - I[(i + 2) % 3]) / I[i] for i in range(3)]
        self.omega = self.R.T * vector(scene.omega)
        given = [mp.mpf(float(v)) for v in scene.attitude]
        length = mp.sqrt(sum(v * v for v in given))
        self.attitude = multiply([v / length for v in given], self.turn)
        self.start = vector(scene.omega)

    def momentum(self, rotor):
        """A rotor's part of h in principal axes."""
        axis, size = unit_axis(rotor), rotor.momentum
        if size is None:
            relative = mp.mpf(rotor.speed)
            own = (axis.T * self.start)[0] if rotor.free else 0
            size = mp.mpf(rotor.inertia) * (relative + own)
        return self.R.T * (mp.mpf(size) * axis)

    def accelerate(self, matrix):
        """Divide the rows by the moments."""
        return mp.matrix([[matrix[i, j] / self.moments[i] for j in range(matrix.cols)] for i in range(3)])

    def principal(self, values):
        return self.R.T * vector(values)


def unit_axis(rotor):
    axis = vector(rotor.axis)
    return axis / mp.sqrt((axis.T * axis)[0])


def write_quaternion(R):
    """The unit quaternion of a rotation, by its largest component."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    sizes = [R[0, 0], R[1, 1], R[2, 2], trace]
    best = max(range(4), key=lambda i: sizes[i])
    if best == 3:
        q = [R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1], 1 + trace]
    else:
        i, j, k = best, (best + 1) % 3, (best + 2) % 3
        q = [mp.mpf(0)] * 4
        q[i], q[j], q[k] = 1 + 2 * R[i, i] - trace, R[j, i] + R[i, j], R[k, i] + R[i, k]
        q[3] = R[k, j] - R[j, k]
    length = mp.sqrt(sum(v * v for v in q))
    return [v / length for v in q]


class Coefficients:
    """The numbers of one torque or rotor, by the names of the parameters; what is not there is 0."""

    def __init__(self, body, torque, t0):
        self.a, self.D, self.drag = mp.zeros(3, 1), mp.zeros(3), mp.zeros(3, 1)
        self.rows = [mp.zeros(3) for _ in range(3)]
        self.turning = None               # rate, phase at t0, of u u, of u
        one = mp.eye(3)
        match torque:
            case None:
                pass
            case ph.torques.Constant(frame="body"):
                self.a = body.accelerate(body.principal(torque.torque))
            case ph.torques.Constant():
                self.rows = [body.accelerate(one * mp.mpf(float(c))) for c in torque.torque]
            case ph.torques.Gravity():
                arm = body.principal(torque.arm)
                self.rows[2] = body.accelerate(cross(arm) * mp.mpf(-float(torque.weight)))
            case ph.torques.GravityGradient():
                n = mp.mpf(float(torque.mean_motion))
                self.turning = n, n * t0 + float(torque.phase), [-3 * n * n * k for k in body.k], mp.zeros(3)
            case ph.torques.Damping():
                C = mp.matrix(np.asarray(torque.matrix).tolist())
                self.D = body.accelerate(-(body.R.T * C * body.R))
            case ph.torques.AngularDamping():
                self.D = one * mp.mpf(-float(torque.rate))
            case ph.torques.AngularDamping():
                self.D = one * mp.mpf(-torque.rate)
            case ph.Rotor():
                self.D = body.accelerate(cross(body.momentum(torque)))
            case ph.torques.Custom(function=Brake() as own):
                self.D = body.accelerate(one * mp.mpf(-own.c))
            case ph.torques.Custom(function=Wheel() as own):
                self.D = body.accelerate(cross(body.principal(own.h)))
            case ph.torques.Custom(function=Drag() as own):
                self.drag = body.accelerate(mp.matrix([-mp.mpf(own.c)] * 3))
            case ph.torques.Custom(function=Magnet() as own):
                m, n = body.accelerate(cross(body.principal(own.m))), mp.mpf(own.n)
                self.rows[2] = m * mp.mpf(own.bz)
                self.turning = n, n * t0, [mp.mpf(0)] * 3, m * mp.mpf(own.b)
            case _:
                raise ValueError(f"no exact form is known of {torque!r}")

    @property
    def on_rows(self):
        return any(entry != 0 for matrix in self.rows for entry in matrix)

    @property
    def on_drag(self):
        return any(entry != 0 for entry in self.drag)

    def size(self, spin):
        """The largest acceleration of a body that turns at this rate."""
        entries = [*self.a, *(v for row in self.rows for v in row), *(v * spin for v in self.D),
                   *(v * spin ** 3 for v in self.drag)]
        entries += [] if self.turning is None else [*self.turning[2], *self.turning[3]]
        return float(max(abs(v) for v in entries))


def list_numbers(structure, k, one, slot, unit):
    """One torque's parameters in the order of `build_equations`, in units of time; `slot` is its turning vector's.

    Rates and phases belong to the body's motion and not to a window: `list_phases` has them.
    """
    found = [*k, *(v * unit ** 2 for v in one.a), *(v * unit for v in one.D)]
    if structure.rows:
        found += [v * unit ** 2 for row in one.rows for v in row]
    if structure.drag:
        found += [v / unit for v in one.drag]
    for i in range(structure.turning):
        found += [0, 0]
        found += [0] * 12 if i != slot else [v * unit ** 2 for v in (*one.turning[2], *one.turning[3])]
    return found


def list_phases(structure, turning, unit):
    """What is the same at all times: rates and phases of the turning vectors, with 0 for all else."""
    found = [0] * (15 + 27 * structure.rows + 3 * structure.drag)
    for rate, phase in turning:
        found += [rate * unit, mp.fmod(phase, 2 * mp.pi), *([0] * 12)]
    return found
