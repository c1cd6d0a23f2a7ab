"""The truth of a heavy body that swings in a vertical plane.

The plane is invariant, but the motion across it may be unstable. Rounding, however fine, then grows in any series of
the body's own equations. The equation of the plane pendulum has no motion across.
"""

import functools

import numpy as np

import polhode as ph

from .model import mp, multiply


def find_plane(scene, body):
    """The axis of the swing, 0 to 2, where the float64 inputs are exactly in its plane; None elsewhere."""
    if len(scene.torques) != 1 or scene.rotors or not isinstance(scene.torques[0], ph.torques.Gravity):
        return None
    if body.turn[3] != 1:   # a full tensor: its principal axes are rounded
        return None
    arm, up = scene.torques[0].arm, find_up(scene)
    for axis in range(3):
        across = [i for i in range(3) if i != axis]
        if arm[axis] == 0 and up[axis] == 0 and all(scene.omega[i] == 0 for i in across):
            return axis
    return None


def find_up(scene):
    """The vertical in body axes, times the square of the quaternion's length."""
    x, y, z, s = (mp.mpf(float(v)) for v in scene.attitude)
    return [2 * (x * z - s * y), 2 * (y * z + s * x), s * s + z * z - x * x - y * y]


@functools.cache
def make_pendulum(heyoka, real):
    """angle'' = a cos(angle) + b sin(angle)."""
    angle, rate = heyoka.make_vars("angle", "rate")
    a, b = heyoka.par[0], heyoka.par[1]
    equations = [(angle, rate), (rate, a * heyoka.cos(angle) + b * heyoka.sin(angle))]
    tolerance = real("1e-23" if real is np.longdouble else "1e-28")
    return heyoka.taylor_adaptive(equations, np.zeros(2).astype(real), fp_type=real, tol=tolerance)


def compute_swing(heyoka, scene, body, axis, real, convert, unit, most_steps):
    """States (n, 7) as the general equations give them, in units of time; None where it takes more steps."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    gravity, up = scene.torques[0], find_up(scene)
    size = mp.sqrt(up[i] ** 2 + up[j] ** 2)
    arm = [mp.mpf(float(v)) for v in gravity.arm]
    scale = -mp.mpf(gravity.weight) * unit ** 2 / (body.moments[axis] * size)
    integrator = make_pendulum(heyoka, real)
    integrator.pars[:] = convert(real, [scale * (arm[i] * up[j] - arm[j] * up[i]),
                                        -scale * (arm[i] * up[i] + arm[j] * up[j])])
    start = convert(real, [0, body.omega[axis] * unit])
    found, steps = {scene.t0: start}, 0
    for sign in (1, -1):
        wanted = sorted({t for t in scene.times if sign * t > sign * scene.t0}, reverse=sign < 0)
        if not wanted:
            continue
        grid = np.array([convert(real, [(mp.mpf(t) - mp.mpf(scene.t0)) / unit])[0] for t in (scene.t0, *wanted)])
        integrator.time, integrator.state[:] = grid[0], start
        outcome, _, _, taken, _, states = integrator.propagate_grid(grid, max_steps=max(most_steps - steps, 1))
        steps += taken
        if outcome != heyoka.taylor_outcome.time_limit:
            return None, steps
        found.update(zip(wanted, states[1:], strict=True))
    rows = []
    for t in scene.times:
        angle, rate = (mp.mpf(str(v)) for v in found[t])
        omega, turn = [mp.mpf(0)] * 3, [mp.mpf(0)] * 3 + [mp.cos(angle / 2)]
        omega[axis], turn[axis] = rate, mp.sin(angle / 2)
        rows.append(convert(real, [*omega, *multiply(body.attitude, turn)]))
    return np.array(rows, dtype=real), steps
