"""The exact motion of a scene's float64 inputs, by heyoka's Taylor series: another author's code, and 64-bit mantissas.

The second opinion is the same with 113 bits, another order and another tolerance. The attitude's start is the unit
quaternion of what the scene holds. The span is divided at the ends of windows. Where a rotor starts or stops there, the
momentum is continuous and the rates jump.
"""

import functools
from dataclasses import dataclass

import numpy as np

import polhode as ph

from .model import Body, Coefficients, Structure, build_equations, list_numbers, list_phases, mp, multiply
from .plane import compute_swing, find_plane

try:
    import heyoka
except ImportError:
    heyoka = None


@dataclass(frozen=True)
class Known:
    """Rates and attitudes at the scene's times as long doubles; the largest rate of the start and of these."""

    omega: np.ndarray
    attitude: np.ndarray
    omega_scale: float
    steps: int


def missing():
    """Why there is no truth on this machine; empty when there is."""
    return "" if heyoka is not None else "the truth needs heyoka: pip install heyoka"


def compute_truth(scene, digits="long", most_steps=40_000):
    """Return what is known of a scene; None where it takes more steps. `digits` is "long" or "quad"."""
    body = Body(scene)
    t0 = mp.mpf(scene.t0)
    lasting = [torque.torque if isinstance(torque, ph.torques.During) else torque for torque in scene.torques]
    torques = [Coefficients(body, one, t0) for one in (*lasting, *scene.rotors)]
    turning = [one for one in torques if one.turning is not None]
    unit = choose_unit(scene, body, torques)
    axis = find_plane(scene, body)
    if axis is not None:
        real = np.longdouble if digits == "long" else heyoka.real128
        states, steps = compute_swing(heyoka, scene, body, axis, real, convert, unit, most_steps)
        return None if states is None else finish(scene, body, states, unit, steps)
    structure = Structure(any(one.on_rows for one in torques), len(turning), any(one.on_drag for one in torques))
    real, integrator = make_integrator(structure, digits)
    slots = iter(range(len(turning)))
    acting = [convert(real, list_numbers(structure, [0] * 3, one, None if one.turning is None else next(slots), unit))
              for one in torques]
    base = convert(real, list_numbers(structure, body.k, Coefficients(body, None, t0), None, unit))
    base = base + convert(real, list_phases(structure, [one.turning[:2] for one in turning], unit))
    start = convert(real, [*(v * unit for v in body.omega), *body.attitude])
    windows = [torque.windows if isinstance(torque, ph.torques.During) else ((-np.inf, np.inf),)
               for torque in scene.torques]
    windows += [((-np.inf, np.inf),) if rotor.during is None else rotor.during for rotor in scene.rotors]
    jumps = [np.zeros(3).astype(real)] * len(lasting)
    jumps += [convert(real, [v * unit for v in body.accelerate(body.momentum(rotor))]) for rotor in scene.rotors]
    run = Run(integrator, base, acting, windows, jumps, lambda t: (t.astype(real) - np.array(scene.t0).astype(real)) /
              np.array(unit).astype(real))
    states = run(start, scene.t0, np.asarray(scene.times), most_steps)
    return None if states is None else finish(scene, body, states, unit, run.steps)


def choose_unit(scene, body, torques):
    """A power of two of seconds, in which the largest rates are about 1."""
    rate, span = float(np.linalg.norm(scene.omega)), float(np.abs(scene.times - scene.t0).max())
    push = max((one.size(rate) for one in torques), default=0.0)
    rate = max(rate, min(push * span, push ** 0.5))
    return 2.0 ** -round(np.log2(rate)) if rate > 0 else 1.0


def convert(real, values):
    return np.array([real(mp.nstr(mp.mpf(v), 45)) for v in values], dtype=real)


@functools.cache
def make_integrator(structure, digits):
    """A compiled integrator for one structure; compact, since that takes a fifth of a second in place of seconds."""
    real = np.longdouble if digits == "long" else heyoka.real128
    equations = build_equations(heyoka, structure)
    state = np.zeros(7).astype(real)
    tolerance = real("1e-23" if digits == "long" else "1e-28")
    return real, heyoka.taylor_adaptive(equations, state, fp_type=real, tol=tolerance, compact_mode=True)


class Run:
    """A motion in both directions from its start, piece by piece between the ends of windows. Times are the scene's."""

    def __init__(self, integrator, base, acting, windows, jumps, convert_times):
        self.integrator, self.base, self.acting, self.windows, self.jumps = integrator, base, acting, windows, jumps
        self.convert_times, self.steps = convert_times, 0

    def __call__(self, start, t0, times, most_steps):
        states = {t0: start}
        for sign in (1, -1):
            wanted = sorted({t for t in times if sign * t > sign * t0}, reverse=sign < 0)
            if not wanted:
                continue
            ends = {end for windows in self.windows for window in windows for end in window
                    if sign * t0 < sign * end < sign * wanted[-1]}
            now, still = t0, 0 * start[:3]
            spun = self.add(self.jumps, still, t0, np.nextafter(t0, np.inf))
            for end in [*sorted(ends, reverse=sign < 0), wanted[-1]]:
                grid = [now, *(t for t in wanted if sign * now < sign * t < sign * end), end]
                begin, before, spun = states[now].copy(), spun, self.add(self.jumps, still, *sorted((now, end)))
                begin[:3] -= spun - before
                found = self.go(begin, grid, most_steps - self.steps)
                if found is None:
                    return None
                states.update(zip(grid[1:], found[1:], strict=True))
                now = end
        return np.array([states[t] for t in times], dtype=start.dtype)

    def add(self, rows, start, low, high):
        """The start and the rows of what acts throughout a stretch of time."""
        return sum((row for row, windows in zip(rows, self.windows, strict=True)
                    if any(begin <= low and high <= end for begin, end in windows)), start)

    def go(self, state, grid, most_steps):
        """States at a grid of times, throughout which the same torques act."""
        self.integrator.pars[:] = self.add(self.acting, self.base, *sorted((grid[0], grid[-1])))
        grid = self.convert_times(np.array(grid))
        self.integrator.time, self.integrator.state[:] = grid[0], state
        outcome, _, _, steps, _, found = self.integrator.propagate_grid(grid, max_steps=max(most_steps, 1))
        self.steps += steps
        return found if outcome == heyoka.taylor_outcome.time_limit else None


def finish(scene, body, states, unit, steps):
    """Back to the body's axes and to seconds, in long doubles."""
    if states.dtype != np.longdouble:
        states = np.array([[np.longdouble(str(v)) for v in row] for row in states])
    R = np.array([[np.longdouble(mp.nstr(body.R[i, j], 30)) for j in range(3)] for i in range(3)])
    omega = states[:, :3] @ R.T / unit
    back = [np.longdouble(mp.nstr(v, 30)) for v in (-body.turn[0], -body.turn[1], -body.turn[2], body.turn[3])]
    attitude = np.array(multiply(states[:, 3:].T, back)).T
    if not np.isfinite(omega).all() or not np.isfinite(attitude).all():
        return None
    attitude /= np.sqrt((attitude ** 2).sum(axis=1))[:, None]
    rates = np.concatenate([omega, [scene.omega]])
    return Known(omega, attitude, float(np.sqrt((rates ** 2).sum(axis=1).max())), steps)
