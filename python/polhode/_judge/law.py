"""The law of a motion: its right-hand side, its exact flow over short times, and the flow's derivatives."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import cached_property

import numpy as np

from .._batch.closed_forms import free_motion
from .._batch.solve_many import solve_many
from .._core import InertiaTensor, Rotor
from .._scene.scene import Scene
from .._sensitivity.free import free_sensitivity
from ..torques import Custom
from .states import Array, State, difference, displace, rms

Field = Callable[[Array, Array, Array], State]
ACCURACY = 1e-13


def _tensor(matrix: Array) -> InertiaTensor:
    return InertiaTensor(matrix, physical=False)


@dataclasses.dataclass(frozen=True, eq=False)
class Law:
    """Euler's equations of one body, I w' = gyro (I w + h) x w + torque.

    `matrix` is the inertia in body axes [kg m^2]. `scene` has the torques and rotors, or is None for a free body.
    `gyro` is 1, 0 without the gyroscopic term, -1 with its sign reversed. `extra` is one more torque in body axes.
    """

    matrix: Array
    scene: Scene | None = None
    gyro: float = 1.0
    extra: Callable[[Array, Array, Array], Array] | None = None

    @staticmethod
    def of_scene(scene: Scene) -> Law:
        """Return the law of a scene. Free rotors become held ones with the same momentum, at any start of a step."""
        matrix: Array = scene.inertia.matrix
        if not scene.torques and not scene.rotors:
            return Law(matrix)
        if any(rotor.free for rotor in scene.rotors):
            rotors = [Rotor(rotor.axis, momentum=_momentum(rotor, scene.omega), during=rotor.during)
                      for rotor in scene.rotors]
            matrix = scene.carrier_inertia.matrix
            scene = scene.replace(rotors=rotors, inertia=_tensor(matrix))
        return Law(matrix, scene)

    @property
    def free(self) -> bool:
        """True for a body without torques and rotors."""
        return self.scene is None

    @property
    def plain(self) -> bool:
        """True if the flow is that of the scene itself."""
        return self.gyro == 1.0 and self.extra is None

    def field(self, t: Array, omega: Array, attitude: Array) -> State:
        """Return the derivatives of rates and quaternions, of any length, at many states."""
        torque = np.zeros_like(omega)
        momentum = omega @ self.matrix
        if self.scene is not None:
            if self.scene.torques:
                size = np.sqrt(np.einsum("ni,ni->n", attitude, attitude))
                good = (size > 0) & (size < 1e100) & (np.abs(omega).max(axis=1) < 1e100)
                at, some = np.broadcast_to(t, size.shape), slice(None) if good.all() else good
                torque[~good] = np.nan  # a trial that ran away
                torque[some] = self.scene.torque(at[some], omega[some], attitude[some] / size[some, None])
            for rotor in self.scene.rotors:
                momentum = momentum + _rotates(rotor, t)[..., None] * (_momentum(rotor, self.scene.omega) * rotor.axis)
        if self.extra is not None:
            torque += self.extra(t, omega, attitude)
        slope = (self.gyro * cross(momentum, omega) + torque) @ self._inverse
        vector, scalar = attitude[:, :3], attitude[:, 3:]
        rates = np.concatenate([scalar * omega + cross(vector, omega), -np.sum(vector * omega, 1, keepdims=True)], 1)
        return slope, 0.5 * rates

    def flow(self, t: Array, dt: Array, state: State) -> State:
        """Return the states at `t` + `dt` of bodies that start at `t`, one for each row."""
        if not self.plain:
            return extrapolated(self.field, t, dt, state)
        if self.scene is None:
            found: State = free_motion(_tensor(self.matrix), state[0], state[1], dt)
            return found
        omega, attitude = state[0].copy(), state[1].copy()
        some = np.flatnonzero(dt)
        if len(some):
            done = self._solved(t[some], dt[some, None], (omega[some], attitude[some]))
            omega[some], attitude[some] = done[0][:, 0], done[1][:, 0]
        return omega, attitude

    def rates_inside(self, t: Array, dt: Array, state: State, steps: int) -> list[Array]:
        """Return the rates at the ends of equal steps within each `dt`, without the last."""
        parts = np.arange(1, steps) / steps
        if self.plain and self.scene is not None and steps > 1 and np.all(dt):
            return list(np.moveaxis(self._solved(t, dt[:, None] * parts, state)[0], 1, 0))
        return [self.flow(t, dt * part, state)[0] for part in parts]

    def _solved(self, t: Array, dt: Array, state: State) -> State:
        """Return the scene's states at `t` + `dt`, shape (n, k), for each start."""
        threads = None if self._method == "taylor" else 1  # functions of Python run one at a time
        done = solve_many(self._body, omega=state[0], attitude=state[1], t0=t, times=t[:, None] + dt, rtol=ACCURACY,
                          method=self._method, threads=threads)
        assert done.attitude is not None and done.omega is not None
        return np.asarray(done.omega, dtype=float), np.asarray(done.attitude, dtype=float)

    @cached_property
    def _inverse(self) -> Array:
        return np.asarray(np.linalg.inv(self.matrix), dtype=float)

    @cached_property
    def _body(self) -> Scene:
        """The scene with the inertia of this law."""
        assert self.scene is not None
        return self.scene.replace(inertia=_tensor(self.matrix), want=("omega", "attitude"))

    @cached_property
    def _method(self) -> str:
        return "dop853" if any(isinstance(torque, Custom) for torque in self._body.torques) else "taylor"

    def slopes(self, t: Array, dt: Array, state: State) -> tuple[State, Array]:
        """Return the flow, and its derivatives by the start, shape (n, 6, 6)."""
        if self.free and self.plain:
            found = free_sensitivity(
                _tensor(self.matrix), state[0], state[1], dt, wrt=("omega", "attitude"), side="body"
            )
            return (found.omega, found.attitude), found.transition
        size = 1e-6 * np.array([rms(state[0]) or 1.0] * 3 + [1.0] * 3)
        steps = np.concatenate([np.zeros((1, 6)), np.diag(size)])[:, None]  # the start itself, and six beside it
        starts = displace((np.tile(state[0], (7, 1, 1)), np.tile(state[1], (7, 1, 1))),
                          np.broadcast_to(steps, (7, len(state[0]), 6)))
        done = self.flow(np.tile(t, 7), np.tile(dt, 7), (starts[0].reshape(-1, 3), starts[1].reshape(-1, 4)))
        ends = done[0].reshape(7, -1, 3), done[1].reshape(7, -1, 4)
        end = ends[0][0], ends[1][0]
        change = difference(end, (ends[0][1:], ends[1][1:])) / size[:, None, None]
        return end, np.moveaxis(change, 0, -1)


def _momentum(rotor: Rotor, omega: Array) -> float:
    """Return the momentum of a rotor about its axis: relative to the body if it is held, absolute if it is free."""
    if rotor.momentum is not None:
        return float(rotor.momentum)
    assert rotor.speed is not None and rotor.inertia is not None
    return float(rotor.inertia * (rotor.speed + (rotor.axis @ omega if rotor.free else 0.0)))


def _rotates(rotor: Rotor, t: Array) -> Array:
    """Return 1 for the times at which a rotor rotates, 0 for the others."""
    if rotor.during is None:
        return np.ones(np.shape(t))
    windows = np.reshape(rotor.during, (-1, 2))
    inside: Array = np.any([(begin <= t) & (t < end) for begin, end in windows], axis=0) if len(windows) else 0 * t
    return inside * 1.0


def cross(a: Array, b: Array) -> Array:
    """Return vector products of rows, faster than NumPy's for few rows."""
    x, y, z = a.T
    u, v, w = b.T
    out = np.empty((len(a), 3))
    out[:, 0], out[:, 1], out[:, 2] = y * w - z * v, z * u - x * w, x * v - y * u
    return out


def extrapolated(field: Field, t: Array, dt: Array, state: State, levels: int = 6) -> State:
    """Integrate many states over their own steps by Gragg's midpoint rule, extrapolated to order 2 `levels`.

    W. Gragg, SIAM J. Numer. Anal. 2 (1965) 384; R. Bulirsch and J. Stoer, Numer. Math. 8 (1966) 1.
    """
    reach = float(np.max(np.linalg.norm(state[0], axis=1) * np.abs(dt), initial=0.0))
    pieces = max(1, int(np.ceil(reach / 0.8)))
    time, length = np.array(t, float), np.asarray(dt, float) / pieces
    omega, attitude = state
    with np.errstate(over="ignore", invalid="ignore"):  # what runs away is not finite, and is left out
        for _ in range(pieces):
            omega, attitude = _extrapolate(field, time, length, omega, attitude, levels)
            time = time + length
    return omega, attitude


def _extrapolate(field: Field, t: Array, dt: Array, omega: Array, attitude: Array, levels: int) -> State:
    start = np.concatenate([omega, attitude], axis=1)

    def slope(at: Array, y: Array) -> Array:
        return np.concatenate(field(at, y[:, :3], y[:, 3:]), axis=1)

    first = slope(t, start)
    table: list[list[Array]] = []
    for level in range(1, levels + 1):
        count = 2 * level
        h = (dt / count)[:, None]
        before, now = start, start + h * first
        for k in range(1, count):
            before, now = now, before + 2 * h * slope(t + k * h[:, 0], now)
        row = [0.5 * (now + before + h * slope(t + dt, now))]
        for k, above in enumerate(table[-1] if table else []):
            ratio = (level / (level - k - 1)) ** 2
            row.append(row[-1] + (row[-1] - above) / (ratio - 1))
        table.append(row)
    end = table[-1][-1]
    return end[:, :3], end[:, 3:] / np.linalg.norm(end[:, 3:], axis=1, keepdims=True)
