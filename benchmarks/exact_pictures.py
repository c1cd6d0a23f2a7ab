"""The pictures of the closed forms' pages, each drawn by the class it shows.

    python benchmarks/exact_pictures.py      # docs/pictures/gyrostat.svg, damped_free.svg, pendulum.svg, gyroscope.svg
"""

import pathlib

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import polhode as ph  # noqa: E402

PICTURES = pathlib.Path(__file__).parents[1] / "docs" / "pictures"
BLUE, ORANGE, INK, QUIET = "#0072b2", "#d55e00", "#1d2733", "#9aa4ae"
BLOCK = (0.20, 0.40, 0.52)


def find_steady_turns(moments, h):
    """The directions M with M parallel to omega on the sphere |M| = 1, and whether each is stable.

    omega = rate M gives M_i = h_i / (1 - rate I_i), and |M| = 1 fixes the rate.
    """
    moments, h = np.array(moments), np.array(h)
    if not h.any():
        return [(side * axis, k != 1) for k, axis in enumerate(np.eye(3)) for side in (-1, 1)]
    poles, found = np.sort(1 / moments), []
    for low, high in zip([-400, *poles], [*poles, 400], strict=True):
        rate = low + (high - low) * (0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 40001)[1:-1]))
        size = np.sum((h / (1 - rate[:, None] * moments)) ** 2, axis=1) - 1
        for k in np.nonzero(size[:-1] * size[1:] < 0)[0]:
            mean = (rate[k] * size[k + 1] - rate[k + 1] * size[k]) / (size[k + 1] - size[k])
            M = h / (1 - mean * moments)
            basis = np.linalg.svd(M[None])[2][1:]
            hessian = basis @ np.diag(1 / moments - mean) @ basis.T        # of the energy along the sphere
            found.append((M, np.linalg.det(hessian) > 0))
    return found


def draw_gyrostat():
    """Polhodes of a body with a growing rotor on the momentum sphere; separatrices through the saddles."""
    moments, direction = np.array([1.0, 1.6, 2.2]), np.array([0.25, 0.95, 0.2])
    direction /= np.linalg.norm(direction)
    view = ph.Rotation.from_euler("ZX", [-0.55, -1.25])
    figure, axes = plt.subplots(1, 5, figsize=(14, 3.3))
    rng = np.random.default_rng(3)
    for axis, size in zip(axes, (0.0, 0.1, 0.2, 0.27, 0.6), strict=True):
        h = size * direction

        def add(M, colour, width, h=h, axis=axis):
            motion = ph.Gyrostat(moments, momentum=h, omega=(M - h) / moments)
            period = motion.period if 0 < motion.period < 500 else 500.0
            points = view.apply(motion.polhode(np.linspace(0, period, 240)))
            points[points[:, 2] < -0.02] = np.nan
            kind = BLUE if motion.kind == "paired" else ORANGE
            axis.plot(points[:, 0], points[:, 1], lw=width, color=colour or kind)

        turns = find_steady_turns(moments, h)
        for M, stable in turns:
            rings = (0.15, 0.3, 0.45, 0.6, 0.8, 1.0, *((1.2, 1.4, 1.6) if len(turns) == 2 else ()))
            for fraction in rings if stable else ():   # about the centres
                tangent = np.cross(M, rng.normal(size=3))
                side = M * np.cos(fraction) + tangent / np.linalg.norm(tangent) * np.sin(fraction)
                add(side / np.linalg.norm(side), None, 0.6)
        for M, stable in turns:
            if not stable:
                basis = np.linalg.svd(M[None])[2][1:]
                for side in (*basis, *-basis, basis[0] + basis[1], basis[0] - basis[1]):
                    add((M + 1e-5 * side) / np.linalg.norm(M + 1e-5 * side), INK, 1.0)
            x, y, z = view.apply(M)
            if z > 0:
                axis.plot(x, y, "o" if stable else "X", color=INK, ms=5 if stable else 7, zorder=3)
        axis.add_patch(plt.Circle((0, 0), 1, fill=False, lw=0.8, color=QUIET))
        axis.set(aspect="equal", xlim=(-1.05, 1.05), ylim=(-1.05, 1.05),
                 title=f"$|h| = {size:g}\\,L$: {len(turns)} steady turns")
        axis.axis("off")
    return figure


def draw_damped_free():
    """The rates decay, and the attitude comes to rest at a definite angle."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9, 3.2))
    times = np.linspace(0, 60, 1201)
    omega, _ = ph.DampedFree(BLOCK, 0.08, (1, 2, 3)).at(times)
    for k, colour in enumerate((BLUE, ORANGE, "#009e73")):
        left.plot(times, omega[:, k], lw=1, color=colour, label=f"$\\omega_{k + 1}$")
    left.plot(times, np.sqrt(14) * np.exp(-0.08 * times), "--", lw=0.8, color=QUIET)
    left.set(xlabel="t [s]", ylabel="rad/s", title="damped at c = 0.08 /s")
    left.legend(frameon=False)
    for rate, colour in ((0.0, QUIET), (0.04, BLUE), (0.08, ORANGE), (0.16, "#009e73")):
        body = ph.DampedFree(BLOCK, rate, (1, 2, 3))
        right.plot(times, [body.slowed_time(t) for t in times], color=colour, lw=1.2)
        place = (60.0, body.slowed_time(60.0)) if rate else (40.0, 40.0)
        right.annotate(f"c = {rate:g}" + (" /s" if rate else ""), place, xytext=(6, -4), textcoords="offset points",
                       color=colour)
    right.set(xlabel="t [s]", ylabel="slowed time s [s]", ylim=(0, 45), xlim=(0, 84),
              title="the free motion's time: it ends at 1/c")
    return figure


def draw_pendulum():
    """The curves of one energy each, in the plane of the angle and its rate."""
    figure, axis = plt.subplots(figsize=(6.5, 3.6))
    frequency = 1.0   # every number is exact, so that a kick of 2 is on the separatrix
    for kick in (0.3, 0.7, 1.1, 1.5, 1.8, 2.0, 2.3, 2.8):
        body = ph.Pendulum((1.0, 1.2, 1.5), 1.0, (0, 0, -1.0), (kick * frequency, 0, 0))
        span = body.period if body.kind != "separatrix" else 12 / frequency
        omega, attitude = body.at(np.linspace(-span / 2, span / 2, 400))
        angle = 2 * np.arctan2(attitude[:, 0], attitude[:, 3])
        angle = (angle + np.pi) % (2 * np.pi) - np.pi
        order = np.nonzero(np.abs(np.diff(angle)) > np.pi)[0] + 1
        for side in (1, -1):
            axis.plot(np.insert(side * angle, order, np.nan), np.insert(side * omega[:, 0] / frequency, order, np.nan),
                      color={"swinging": BLUE, "rotating": ORANGE, "separatrix": INK}[body.kind], lw=1)
    axis.set(xlabel="angle from hanging [rad]", ylabel="rate / frequency", xlim=(-np.pi, np.pi))
    axis.set_xticks([-np.pi, 0, np.pi], ["upright", "hanging", "upright"])
    return figure


def draw_gyroscope():
    """The path of a toy gyroscope's axis, released at rest, for a growing wheel."""
    figure, axes = plt.subplots(1, 4, figsize=(11, 3.1))
    times = np.linspace(0, 9, 2000)
    for axis, h in zip(axes, (0.0, 1.0, 3.0, 8.0), strict=True):
        top = ph.HeavyTop((1.0, 1.0, 0.4), 2.0, (0, 0, 0), ph.Rotation.from_rotvec((0.7, 0, 0)), rotor=h)
        points = ph.Rotation(top.at(times)[1]).as_matrix()[:, :, 2]
        axis.add_patch(plt.Circle((0, 0), 1, fill=False, lw=0.8, color=QUIET))
        above = points[:, 2] >= 0
        for part, colour in ((above, BLUE), (~above, "#9ecae1")):
            axis.plot(np.where(part, points[:, 0], np.nan), np.where(part, points[:, 1], np.nan), lw=0.9, color=colour)
        axis.plot(*points[0, :2], "o", color=INK, ms=4)
        axis.set(aspect="equal", title=f"h = {h:g} kg m²/s", xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))
        axis.axis("off")
    return figure


def main():
    """Draw all."""
    plt.rcParams["svg.hashsalt"] = "polhode"
    for name, draw in (("gyrostat", draw_gyrostat), ("damped_free", draw_damped_free), ("pendulum", draw_pendulum),
                       ("gyroscope", draw_gyroscope)):
        figure = draw()
        figure.tight_layout()
        figure.savefig(PICTURES / f"{name}.svg", metadata={"Date": None})
        plt.close(figure)


if __name__ == "__main__":
    main()
