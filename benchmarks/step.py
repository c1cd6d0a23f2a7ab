"""The free step beside other steps: a racket's flips at 60 Hz, rigid molecules beside NO_SQUISH, the cost of a call.

    python benchmarks/step.py racket -o docs/pictures      # counts the flips and draws step_racket
    python benchmarks/step.py molecules -o docs/pictures   # charts the energy and draws step_molecules
    python benchmarks/step.py published                    # two steps of the literature that polhode has no method for
    python benchmarks/step.py errors                       # of one step, by kinds of bodies
    python benchmarks/step.py cost

NO_SQUISH: five rotations about the principal axes, 3-2-1-2-3 (Miller et al. 2002, J. Chem. Phys. 116, 8649), as LAMMPS
(fix rigid/nve, fix nve/asphere) and HOOMD-blue step rigid bodies (Kamberaj, Li & Hansen 2005, J. Chem. Phys. 122,
224114). Written anew here from the papers, in NumPy.
"""

import argparse
import pathlib
import time

import numpy as np

import polhode as ph
from polhode._plot import style

RACKET, RATE, STEP, SPAN = np.array((0.20, 0.40, 0.52)), 5.0, 1 / 60, 2000.0
METHODS = ("free", "dmv8", "rk4", "midpoint", "split", "buss", "catto", "jolt")


# ---- the racket

def count_flips(method, e, span=SPAN):
    """Return the times at which omega_2 changes its sign, by a method at 60 Hz."""
    if method == "closed form":
        return np.asarray(ph.FreeMotion(ph.InertiaTensor.from_moments(RACKET), (e, RATE, e)).flip_times(0, span))
    t = np.arange(0, span + STEP / 2, STEP)
    scene = ph.Scene(inertia=RACKET, omega=(e, RATE, e), times=t, want=("omega",))
    motion = ph.solve(scene, method=method, step=STEP, certify=False, max_steps=10**9)
    w = motion.omega[:, 1]
    at = np.flatnonzero(np.signbit(w[1:]) != np.signbit(w[:-1]))
    return motion.t[at + 1]


def racket(folder):
    rows = {}
    for e in (0.1, 0.01, 1e-4):
        rows[e] = {name: count_flips(name, e) for name in ("closed form", *METHODS)}
        print(f"e = {e:g}: " + ", ".join(f"{name} {len(times)}" for name, times in rows[e].items()), flush=True)
    L, q = (RACKET * np.array([(e, RATE, e) for e in rows])).astype(np.float32), np.tile(
        np.array((0, 0, 0, 1), np.float32), (len(rows), 1))
    sign, flips = np.ones(len(rows)), np.zeros(len(rows), int)
    for _ in range(round(SPAN / STEP)):
        ph.step(RACKET, L, q, STEP, frame="body", out=(L, q), threads=1)
        turned = L[:, 1] * sign < 0
        flips, sign = flips + turned, np.where(turned, -sign, sign)
    print("float32 free step: " + ", ".join(f"e = {e:g} {n}" for e, n in zip(rows, flips, strict=True)))
    draw_racket(rows[0.1], folder)


def draw_racket(times, folder):
    with style.used() as plt:
        figure, axes = plt.subplots(figsize=(8.6, 4.6))
        figure.subplots_adjust(left=0.09, right=0.76, bottom=0.12, top=0.80)
        ends = []
        for name, at in times.items():
            loud = name in ("closed form", "free")
            x, y = np.append(at[::4], SPAN), np.append(np.arange(1, len(at) + 1)[::4], len(at))   # fewer points to draw
            look = {"color": style.colour("free") if name == "free" else style.FLOOR if loud else style.PALE}
            axes.plot(x, y, linewidth=3.2 if name == "closed form" else 1.6,
                      linestyle=(0, (4, 2)) if name == "closed form" else "-", zorder=2 + (name == "free"), **look)
            ends.append((len(at), name, look["color"] if loud else style.QUIET))
        groups = {}
        for count, name, _ in ends:
            groups.setdefault(count, []).append(name)
        last = -1e9
        for count, names in sorted(groups.items()):
            words = [", ".join(names[k:k + 3]) for k in range(0, len(names), 3)]
            last = max(count, last + 52) + 22 * (len(words) - 1)
            axes.annotate(f"{count}: " + ",\n".join(words), (SPAN, count), xytext=(SPAN * 1.02, last), fontsize=9,
                          textcoords="data", va="center", annotation_clip=False,
                          color=style.colour("free") if "free" in names else style.QUIET)
            last += 22 * (len(words) - 1)
        axes.set_xlim(0, SPAN)
        axes.set_ylim(0, None)
        axes.set_xlabel("time [s]")
        axes.set_ylabel("flips so far")
        style.heading(figure, "A racket's flips at 60 steps a second",
                      "moments (0.2, 0.4, 0.52) kg m^2, start (0.1, 5, 0.1) rad/s; the closed form is dashed", 0.03)
        style.save(figure, folder, "step_racket")
        plt.close(figure)


# ---- molecules

WATER = np.array((0.615e-47, 1.155e-47, 1.77e-47)) * 1e47   # about the centre of mass, 1e-47 kg m^2
FEMTOSECOND = 1e-3                                          # times are in ps, energies in 1e-23 J


def make_field(n, rng):
    """A dipole field of its own for each molecule, as neighbours make it: torque and energy of an attitude."""
    field = rng.normal(size=(n, 3)) * 300.0   # [1e-23 J], about 0.7 kT

    def dipole(q):   # along the molecule's z, in space
        x, y, z, w = q.T
        return np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], 1)

    return (lambda q: np.cross(dipole(q), field)), (lambda q: -(dipole(q) * field).sum(1))


def squish(moments, L, q, h):
    """NO_SQUISH: rotations about axes 3-2-1-2-3, in place. L in principal axes."""
    for axis, part in ((2, 0.5), (1, 0.5), (0, 1.0), (1, 0.5), (2, 0.5)):
        j, k = (axis + 1) % 3, (axis + 2) % 3
        a = part * h * L[:, axis] / moments[axis]
        c, s = np.cos(a / 2), np.sin(a / 2)
        x, y, z, w = q[:, axis].copy(), q[:, j].copy(), q[:, k].copy(), q[:, 3].copy()
        q[:, axis], q[:, j], q[:, k], q[:, 3] = c * x + s * w, c * y + s * z, c * z - s * y, c * w - s * x
        ca, sa, b = np.cos(a), np.sin(a), L[:, j].copy()
        L[:, j], L[:, k] = ca * b + sa * L[:, k], ca * L[:, k] - sa * b


def to_body(q, v):
    t = 2 * np.cross(v, q[:, :3])
    return v + q[:, 3:] * t + np.cross(t, q[:, :3])


def molecules(folder, n=100_000, steps=100):
    rng = np.random.default_rng(1)
    q0 = rng.normal(size=(n, 4))
    q0 /= np.linalg.norm(q0, axis=1, keepdims=True)
    kT = 1.380649 * 300   # 1e-23 J
    # L = I omega with omega in 1/ps: I [1e-47 kg m^2] (1e12/s)^2 = 1e-23 J.
    L0 = rng.normal(size=(n, 3)) * np.sqrt(WATER * kT)
    torque, potential = make_field(n, rng)

    def energy(L_B, q):
        return (0.5 * L_B**2 / WATER).sum(1) + potential(q)

    curves = {}
    for h in (FEMTOSECOND, 4 * FEMTOSECOND):
        for name in ("free step", "NO_SQUISH"):
            L, q, start, drift, spent = L0.copy(), q0.copy(), energy(L0, q0), [0.0], 0.0
            for _ in range(steps):
                L += 0.5 * h * to_body(q, torque(q))
                begin = time.process_time()
                if name == "free step":
                    ph.step(WATER, L, q, h, frame="body", out=(L, q), threads=1)
                else:
                    squish(WATER, L, q, h)
                spent += time.process_time() - begin
                L += 0.5 * h * to_body(q, torque(q))
                error = energy(L, q) - start
                drift.append(float(np.sqrt((error**2).mean()) / kT))
            curves[name, h] = np.array(drift)
            print(f"{name}, {h * 1e3:g} fs: rms energy error {max(drift):.2e} kT, "
                  f"{1e9 * spent / n / steps:.1f} ns a step (NumPy's own for NO_SQUISH)", flush=True)
    draw_molecules(curves, n, folder)


def draw_molecules(curves, n, folder):
    with style.used() as plt:
        figure, axes = plt.subplots(figsize=(8.6, 4.4))
        figure.subplots_adjust(left=0.1, right=0.8, bottom=0.13, top=0.8)
        for (name, h), drift in curves.items():
            t = np.arange(len(drift)) * h
            ink = style.colour("free") if name == "free step" else style.QUIET
            axes.plot(t[1:], drift[1:], color=ink, linewidth=1.4)
            axes.annotate(f"{name}, {h * 1e3:g} fs", (t[-1], drift[-1]), xytext=(6, 0), textcoords="offset points",
                          fontsize=9, va="center", color=ink, annotation_clip=False)
        axes.set_yscale("log")
        axes.set_xlabel("time [ps]")
        axes.set_ylabel("rms error of a molecule's energy [kT]")
        style.heading(figure, f"{n:,} rigid molecules with torques from a field",
                      "moments of water, 300 K; kick, free motion, kick", 0.03)
        style.save(figure, folder, "step_molecules")
        plt.close(figure)


# ---- published steps that polhode has no method for

def exponential(r):
    """The unit quaternion of a rotation vector."""
    half = np.linalg.norm(r) / 2
    return np.append(np.sinc(half / np.pi) / 2 * r, np.cos(half))


def multiply(p, q):
    return np.append(p[3] * q[:3] + q[3] * p[:3] + np.cross(p[:3], q[:3]), p[3] * q[3] - p[:3] @ q[:3])


def exponential_midpoint(moments, L, q, h):
    """Turn by h omega at the middle, from the momentum turned by half a step: one iteration."""
    middle = to_body(exponential(h / 2 * L / moments)[None], L[None])[0] / moments
    p = exponential(h * middle)
    return to_body(p[None], L[None])[0], multiply(q, p)


def simo_wong(moments, L, q, h):
    """ALGO_C1 of Simo & Wong 1991, Int. J. Numer. Meth. Eng. 31, 19: turn by h (omega + omega') / 2, L kept in space.

    Its implicit equation is solved to rounding by iteration.
    """
    end = L / moments
    for _ in range(200):
        p = exponential(h / 2 * (L / moments + end))
        last, end = end, to_body(p[None], L[None])[0] / moments
        if np.abs(end - last).max() <= 1e-16 * np.abs(end).max():
            break
    return end * moments, multiply(q, p)


def published(_):
    """Error per turn [rad] and change of the energy after ten turns of scene S1's body, omega (1, 2, 3) rad/s."""
    omega = np.array((1.0, 2.0, 3.0))
    rate = np.linalg.norm(omega)
    for angle in (rate / 60, 0.5, 1.0):
        steps = round(10 * 2 * np.pi / angle)
        h = angle / rate
        _, truth = ph.FreeMotion(ph.InertiaTensor.from_moments(RACKET), omega).at(steps * h)
        for name, advance in (("exponential midpoint, one iteration", exponential_midpoint),
                              ("Simo & Wong, ALGO_C1", simo_wong),
                              ("free step", lambda I, L, q, h: ph.step(I, L, q, h, frame="body"))):
            L, q = RACKET * omega, np.array((0.0, 0.0, 0.0, 1.0))
            for _ in range(steps):
                L, q = advance(RACKET, L, q, h)
            error = 4 * np.arcsin(min(1, min(np.linalg.norm(q - truth), np.linalg.norm(q + truth)) / 2)) / 10
            energy = (L**2 / RACKET).sum() / (RACKET * omega**2).sum() - 1
            print(f"{angle:.3g} rad a step, {name}: {error:.1e} rad a turn, energy {energy:.1e}")


# ---- cost

def draw_moments(kind, n, rng):
    if kind == "second moments uniform in 0.1 to 1":
        second = rng.uniform(0.1, 1, (n, 3))
    elif kind == "boxes, sides over a decade":
        second = 10 ** (2 * rng.uniform(0, 1, (n, 3)))
    else:
        second = 10 ** rng.uniform(0, 4, (n, 3))
    return second.sum(axis=1, keepdims=True) - second


def errors(_, n=200_000):
    """Print the largest rotation by which one step at 1 rad/s misses the closed form."""
    kinds = "second moments uniform in 0.1 to 1", "boxes, sides over a decade", "second moments over four decades"
    for kind in kinds:
        rng = np.random.default_rng(1)
        moments, omega, attitude = draw_moments(kind, n, rng), rng.normal(size=(n, 3)), rng.normal(size=(n, 4))
        moments /= moments.max(axis=1, keepdims=True)
        omega /= np.linalg.norm(omega, axis=1, keepdims=True)
        attitude /= np.linalg.norm(attitude, axis=1, keepdims=True)
        for dtype in (np.float64, np.float32):
            # The float32 inputs are the truth's inputs, too.
            given = moments.astype(dtype), (moments * omega).astype(dtype), attitude.astype(dtype)
            exact = [one.astype(float) for one in given]
            exact[2] /= np.linalg.norm(exact[2], axis=1, keepdims=True)
            found = []
            for h in (0.01, 0.1, 0.5, 1.0, 2.0, 3.0):
                _, q = ph.step(*given, h, frame="body")
                truth = ph.free_motion(exact[0], exact[1] / exact[0], exact[2], h, want="attitude")
                q = q / np.linalg.norm(q.astype(float), axis=1, keepdims=True)
                apart = np.minimum(*(np.linalg.norm(q + sign * truth, axis=1) for sign in (-1, 1)))
                found.append(2 * apart.max())
            print(f"| {kind}, {np.dtype(dtype).name} | " + " | ".join(f"{error:.0e}" for error in found) + " |")


def cost(_, n=100_000, repeats=25):
    rng = np.random.default_rng(0)
    for dtype in (np.float32, np.float64):
        moments = np.tile(RACKET, (n, 1)).astype(dtype)
        L, tau = rng.normal(size=(n, 3)).astype(dtype), np.zeros((n, 3), dtype)
        q = np.tile(np.array((0, 0, 0, 1), dtype), (n, 1))
        for label, options in (("free", {}), ("with a torque", {"torque": tau}), ("100 steps a call", {"count": 100})):
            least = 1e9
            for _ in range(repeats if "count" not in options else 3):
                begin = time.process_time()
                ph.step(moments, L, q, 0.01, out=(L, q), threads=1, **options)
                least = min(least, (time.process_time() - begin) / options.get("count", 1))
            print(f"{np.dtype(dtype).name}, {label}: {1e9 * least / n:.2f} ns a body and step")


KINDS = {"racket": racket, "molecules": molecules, "published": published, "errors": errors, "cost": cost}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=KINDS)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("."))
    options = parser.parse_args()
    KINDS[options.what](options.output)


if __name__ == "__main__":
    main()
