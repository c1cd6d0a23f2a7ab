"""The law of a motion: its right-hand side, its exact flow over short times, and the flow's derivatives."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from .._batch.closed_forms import free_motion
from .._batch.solve_many import solve_many
from .._core import InertiaTensor
from .._scene.scene import Scene
from .._sensitivity.free import free_sensitivity
from ..torques import Custom
from .states import Array, State, difference, displace, rms

Field = Callable[[Array, Array, Array], State]
GROUPS = ("omega", "attitude", "inertia", "axes")


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
            size = np.linalg.norm(attitude, axis=1)
            good = (size > 0) & (size < 1e100) & np.all(np.abs(omega) < 1e100, axis=1)
            torque[~good] = np.nan  # a trial that ran away
            rows = zip(np.broadcast_to(t, size.shape)[good], omega[good], attitude[good] / size[good, None])
            torque[good] = np.reshape([self.scene.torque(*row) for row in rows], (-1, 3))
            momentum = momentum + self.scene.rotor_momentum if self.scene.rotors else momentum
        if self.extra is not None:
            torque += self.extra(t, omega, attitude)
        slope = (self.gyro * cross(momentum, omega) + torque) @ np.linalg.inv(self.matrix)
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
        body, none = _tensor(self.matrix), np.flatnonzero(dt)
        scenes = [
            self.scene.replace(
                inertia=body,
                omega=state[0][k],
                attitude=state[1][k],
                t0=t[k],
                times=[t[k] + dt[k]],
                want=("omega", "attitude"),
            )
            for k in none
        ]
        omega, attitude = state[0].copy(), state[1].copy()
        if scenes:
            method = "dop853" if any(isinstance(torque, Custom) for torque in self.scene.torques) else "taylor"
            done = solve_many(scenes, rtol=1e-13, method=method)
            assert done.attitude is not None and done.omega is not None
            omega[none], attitude[none] = done.omega[:, 0], done.attitude[:, 0]
        return omega, attitude

    def slopes(self, t: Array, dt: Array, state: State) -> tuple[State, Array]:
        """Return the flow, and its derivatives by the start, shape (n, 6, 6)."""
        if self.free and self.plain:
            found = free_sensitivity(
                _tensor(self.matrix), state[0], state[1], dt, wrt=("omega", "attitude"), side="body"
            )
            return (found.omega, found.attitude), found.transition
        end = self.flow(t, dt, state)
        size = 1e-6 * np.array([rms(state[0]) or 1.0] * 3 + [1.0] * 3)
        columns = []
        for k in range(6):
            step = np.zeros(6)
            step[k] = size[k]
            columns.append(
                difference(end, self.flow(t, dt, displace(state, np.broadcast_to(step, (len(t), 6))))) / size[k]
            )
        return end, np.stack(columns, axis=-1)


def cross(a: Array, b: Array) -> Array:
    """Return vector products of rows, faster than NumPy's for few rows."""
    x, y, z = a[:, 0], a[:, 1], a[:, 2]
    u, v, w = b[:, 0], b[:, 1], b[:, 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=1)


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
