"""The free gyrostat in closed form: what it costs beside `taylor`, its error, and the picture of its polhodes.

    python benchmarks/gyrostat.py            # the table of docs/results/gyrostat.md and docs/pictures/gyrostat.svg

Times are the smallest of many repeats of the CPU time of this thread. POLHODE_SIMD=avx2 or baseline measures the other
instruction sets. Errors are against tests/reference/gyrostat.json, in units of what the page of the gyrostat promises.
"""

import json
import pathlib
import time

import numpy as np

import polhode as ph

ROOT = pathlib.Path(__file__).parents[1]
TABLE = ROOT / "tests" / "reference" / "gyrostat.json"
PICTURE = ROOT / "docs" / "pictures" / "gyrostat.svg"
E = 2.2e-16
BLOCK, START = (0.20, 0.40, 0.52), (0.0, 0.0, 0.0, 1.0)
JOBS = {   # moments, momentum, omega: the trigonometric and the hyperbolic form
    "wheel beside the axes": (BLOCK, (0.3, 0.1, 0.2), (1.0, 2.0, 3.0)),
    "beside a saddle": (BLOCK, (0.0, 0.05, 0.0), (1e-4, 5.0, 1e-4)),
}


def best(work, repeats=40):
    work()
    found = np.inf
    for _ in range(repeats):
        start = time.thread_time_ns()
        work()
        found = min(found, time.thread_time_ns() - start)
    return found


def measure_times():
    any_times = np.sort(np.random.default_rng(1).uniform(0, 1000, 100_000))
    out = np.empty((any_times.size, 3)), np.empty((any_times.size, 4))
    for name, (moments, h, omega) in JOBS.items():
        grid = best(lambda: ph.gyrostat(moments, h, omega, START, any_times, out=out, threads=1)) / any_times.size
        make = best(lambda: ph.Gyrostat(moments, momentum=h, omega=omega), 400)
        scene_times = np.linspace(0, 1000, 1001)
        whole = best(lambda: ph.Gyrostat(moments, momentum=h, omega=omega).at(scene_times))
        # Without the closed form: the wheel as a torque -(h x omega), which a skew Damping gives.
        wheel = ph.torques.Damping(matrix=[[0, h[2], -h[1]], [-h[2], 0, h[0]], [h[1], -h[0], 0]])
        scene = ph.Scene(inertia=moments, omega=omega, attitude=START, torques=[wheel], times=scene_times)
        stepped = best(lambda: ph.solve(scene, 1e-13, method="taylor"), 5)
        state = ph.solve(scene, 1e-13, method="taylor")
        exact = ph.Gyrostat(moments, momentum=h, omega=omega).at(scene_times)
        apart = np.abs(state.omega - exact[0]).max() / np.abs(exact[0]).max()
        print(f"| {name} | {grid:.1f} | {make / 1e3:.1f} | {whole / 1e3:.0f} | "
              f"{stepped / 1e3:.0f} | {apart:.0e} |")


def measure_errors():
    worst = {}
    for row in json.loads(TABLE.read_text()):
        if not row["t"]:
            continue
        motion = ph.Gyrostat(row["moments"], momentum=row["momentum"], omega=row["omega"], attitude=row["attitude"])
        omega, attitude = motion.at(row["t"])
        answer = np.array(row["answer"])
        sign = np.sign(np.sum(attitude * answer[:, 3:], axis=1))[:, None]
        found = np.stack([np.linalg.norm(omega - answer[:, :3], axis=1) / row["scale"],
                          2 * np.linalg.norm(attitude - sign * answer[:, 3:], axis=1)], axis=1)
        part = (found / (20 * (np.array(row["cond"]) + 4 * E))).max()
        good = np.max(row["cond"], axis=1) < 1e-15
        size = found[good].max(axis=0) if good.any() else np.zeros(2)
        known = worst.get(row["name"], (0.0, np.zeros(2)))
        worst[row["name"]] = max(known[0], part), np.maximum(known[1], size)
    for name, (part, size) in worst.items():
        print(f"| {name} | {part:.3f} | {size[0]:.1e} | {size[1]:.1e} |")


def find_steady_turns(moments, h):
    """The directions M with M parallel to omega on the sphere |M| = 1, and whether each is stable."""
    moments, h = np.array(moments), np.array(h)
    if not h.any():
        return [(side * axis, k != 1) for k, axis in enumerate(np.eye(3)) for side in (-1, 1)]
    poles = 1 / moments
    found = []
    for low, high in zip([-400, *np.sort(poles)], [*np.sort(poles), 400], strict=True):
        rate = low + (high - low) * (0.5 - 0.5 * np.cos(np.linspace(0, np.pi, 40001)[1:-1]))
        size = np.sum((h / (1 - rate[:, None] * moments)) ** 2, axis=1) - 1
        for k in np.nonzero(size[:-1] * size[1:] < 0)[0]:
            mean = (rate[k] * size[k + 1] - rate[k + 1] * size[k]) / (size[k + 1] - size[k])
            M = h / (1 - mean * moments)
            hessian = np.diag(1 / moments - mean)        # of the energy along the sphere
            basis = np.linalg.svd(M[None])[2][1:]
            found.append((M, np.linalg.det(basis @ hessian @ basis.T) > 0))
    return found


def draw():
    import matplotlib

    matplotlib.use("svg")
    import matplotlib.pyplot as plt

    plt.rcParams["svg.hashsalt"] = "polhode"
    moments, direction = np.array([1.0, 1.6, 2.2]), np.array([0.5, 0.75, 0.43])
    view = ph.Rotation.from_euler("ZX", [-2.2, -1.1])     # the wheel's side of the sphere
    figure, axes = plt.subplots(1, 4, figsize=(12, 3.4))
    rng = np.random.default_rng(3)
    starts = rng.normal(size=(48, 3))
    starts /= np.linalg.norm(starts, axis=1, keepdims=True)
    for axis, size in zip(axes, (0.0, 0.08, 0.3, 0.8), strict=True):
        h = size * direction / np.linalg.norm(direction)
        for M in starts:
            motion = ph.Gyrostat(moments, momentum=h, omega=(M - h) / moments)
            period = motion.period if 0 < motion.period < 500 else 500.0
            points = view.apply(motion.polhode(np.linspace(0, period, 200)))
            points[points[:, 2] < 0] = np.nan
            axis.plot(points[:, 0], points[:, 1], lw=0.6, color="C0" if motion.kind == "paired" else "C1")
        for M, stable in find_steady_turns(moments, h):
            x, y, z = view.apply(M)
            if z > 0:
                axis.plot(x, y, "o" if stable else "x", color="black", ms=4)
        axis.add_patch(plt.Circle((0, 0), 1, fill=False, lw=0.8, color="grey"))
        axis.set(aspect="equal", title=f"|h| = {size:g} L", xlim=(-1.05, 1.05), ylim=(-1.05, 1.05))
        axis.axis("off")
    figure.tight_layout()
    figure.savefig(PICTURE, metadata={"Date": None})


if __name__ == "__main__":
    measure_times()
    measure_errors()
    draw()
