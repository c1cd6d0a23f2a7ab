"""The published detumbling set of 500 picosatellites, beside polhode: quantiles of the time, and seconds of computing.

    python benchmarks/detumble.py [--bodies 500] [--orbits 32] [--degree 1] [--processes 2] [--compare]

Fonod and Gill 2018, IAC-18-C1.3.11, Magnetic Detumbling of Fast-tumbling Picosatellites. The public simulator
rfonod/detumbling-simulator (main_old.m, run_mc.m) has the parameters and the distributions, and MC_Results the
results: data_350_32_0_new3.mat is its classical law. Gauss coefficients: IGRF-14 (doi 10.5281/zenodo.14012302), at
2018.58.

Not as there: two magnetometers with white noise of 0.5 uT and a resolution of 0.3 uT, averaged, are one with 0.36 uT;
the drag (torques below 2e-8 N m) is left out. `--compare` steps the simulator's own loop by
benchmarks/cpp/detumble_rk4.cpp, compiled here, with RK4 steps of its 0.125 s and of a tenth of it.
"""

import argparse
import concurrent.futures
import functools
import pathlib
import subprocess
import tempfile
import time

import numpy as np

import polhode as ph

MU, RADIUS, T = 3.9860044181e14, 6378137.0 + 350e3, 0.25
PERIOD = 2 * np.pi * np.sqrt(RADIUS**3 / MU)
SPIN = 2 * np.pi / (86400 * 365.24 / 366.24)
G = [[-29414.2, -1465.7], [-2484.5, 2990.5, 1676.7], [1359.4, -2372.7, 1233.2, 541.5],
     [904.1, 810.7, 95.9, -316.7, 53.9]]
H = [[0.0, 4693.8], [0.0, -2950.2, -708.4], [0.0, -91.4, 242.7, -541.4], [0.0, 282.5, -167.0, 194.4, -344.3]]   # [nT]
QUANTILES = (0.05, 0.25, 0.5, 0.75, 0.95)
# Of data_350_32_0_new3.mat: 500 times of the law "classical" until all rates are below 5 deg/s [orbits].
PUBLISHED = (10.904, 12.384, 13.884, 16.682, 20.720)
PUBLISHED_MEAN, PUBLISHED_DEVIATION = 14.766, 3.174


def nominal_moments():
    """Of a box and a plate behind it, of one density, 0.6 kg together [kg m^2]."""
    box, plate = np.array((0.05, 0.05, 0.178)), np.array((0.064, 0.0016, 0.192))
    volumes = np.array((box.prod(), plate.prod()))
    m_box, m_plate = 0.6 * volumes / volumes.sum()
    place = (box[1] + plate[1]) / 2
    centre = m_plate * place / 0.6
    own = [m * (s[[1, 2, 0]] ** 2 + s[[2, 0, 1]] ** 2) / 12 for m, s in ((m_box, box), (m_plate, plate))]
    shift = m_box * centre**2 + m_plate * (place - centre) ** 2
    return own[0] + own[1] + np.array((shift, 0.0, shift))


def draw(bodies, seed=2018):
    """Moments, largest dipoles, residual dipoles and biases of two magnetometers, as the simulator draws them."""
    rng = np.random.default_rng(seed)

    def truncated(deviation):
        found = rng.normal(size=4 * bodies)
        return deviation * found[np.abs(found) < 3][:bodies]

    def direction():
        a, e = 2 * np.pi * rng.random((2, bodies))
        return np.stack([np.sin(a) * np.cos(e), np.sin(a) * np.sin(e), np.cos(a)], axis=1)

    def three(deviation):
        return np.stack([truncated(deviation) for _ in range(3)], axis=1)

    mass = 0.6 + truncated(0.1)
    moments = np.outer(mass / 0.6, nominal_moments()) * (1 + three(0.05))
    most = 0.002 + three(0.002 / 15)
    residual = direction() * (1e-4 + truncated(1e-5))[:, None]
    return moments, most, residual, 0.4e-6 * direction(), 0.4e-6 * direction()


def law(t, m, s, p):
    """B-dot of the field's direction, as pulse widths: the mean dipole of a period, and the residual one."""
    seen = m.field + p.bias
    size = np.sqrt(seen[0] ** 2 + seen[1] ** 2 + seen[2] ** 2)
    b = seen / size
    wish = -p.gain * np.where(s.n > 0, b - s.old, 0.0 * b) / size
    on = p.duty * np.minimum(1.0, np.abs(wish) / p.most)
    pushed = (on - p.rise) * p.most
    command = np.where(s.n > 0, np.where(wish > 0, pushed, -pushed), 0.0 * wish)
    return command + p.residual, {"old": b, "n": np.minimum(s.n + 1, 1.0)}


def make_field(degree):
    n = 2 * np.pi / PERIOD
    inclination, node, anomaly = np.radians((96.84895, 210.0, 60.0))
    ci, si, cn, sn, ca, sa = (f(x) for x in (inclination, node, anomaly) for f in (np.cos, np.sin))
    along = np.array((cn * ca - sn * ci * sa, sn * ca + cn * ci * sa, si * sa))
    across = np.array((-cn * sa - sn * ci * ca, -sn * sa + cn * ci * ca, si * ca))
    orbit = ph.Orbit(mu=MU, r0=RADIUS * along, v0=RADIUS * n * across)
    if degree == 1:
        g, h = 1e-9 * np.array((G[0][1], G[0][0])), 1e-9 * H[0][1]
        moment = np.array((g[0], h, g[1])) * 6371200.0**3   # B = grad of its dipole
        size = np.linalg.norm(moment)
        return ph.MagneticField.dipole(orbit, size, tilt=np.arccos(moment[2] / size), spin=SPIN,
                                       phase=np.arctan2(moment[1], moment[0]))

    def whole(rows):
        return [[0.0]] + [[1e-9 * x for x in row] for row in rows[:degree]]

    return ph.MagneticField.gauss(orbit, 6371200.0, whole(G), whole(H), spin=SPIN)


def make_scenes(bodies, orbits, degree, every=60.0):
    field = make_field(degree)
    n = 2 * np.pi / PERIOD
    tilt, inclination = np.radians((11.44, 96.84895))
    xi = np.arccos(np.cos(inclination) * np.cos(tilt) + np.sin(inclination) * np.sin(tilt))
    gain = 2 * n * (1 + np.sin(xi)) * nominal_moments().min()
    noise = 1e-6 * np.sqrt((0.5**2 + 0.3**2 / 12) / 2)
    times = np.arange(0, orbits * PERIOD, every)
    scenes = []
    for J, most, residual, one, two in zip(*draw(bodies), strict=True):
        controller = ph.Controller(
            T, law, output="dipole", field=field, states={"old": (0.0, 0.0, 0.0), "n": 0.0},
            parameters={"gain": gain / T, "bias": (one + two) / 2, "duty": 0.6, "rise": 0.01 / T, "most": most,
                        "residual": residual},
            measure=ph.Measure(field_noise=noise, seed=7))
        scenes.append(ph.Scene(inertia=J, omega=(np.pi, np.pi, np.pi), attitude=ph.Rotation.from_rotvec((np.pi, 0, 0)),
                               controllers=[controller], times=times, want=("omega",)))
    return scenes


def run(scenes_of, i):
    """The rates of body i, the seconds of a processor, and its ticks."""
    scene = scenes_of()[i]
    begin = time.process_time()
    motion = ph.solve(scene, rtol=1e-8)
    return motion.omega, time.process_time() - begin, len(motion.ticks[0].t)


def find_times(t, omega):
    """The first sample at which all rates are below 5 deg/s [orbits]; NaN if there is none."""
    slow = (np.abs(omega) <= np.radians(5)).all(axis=-1)
    return np.where(slow.any(axis=-1), t[slow.argmax(axis=-1)], np.nan) / PERIOD


def describe(name, found):
    never = np.count_nonzero(~np.isfinite(found))
    found = found[np.isfinite(found)]
    if never or not found.size:
        print(f"{name}: {never} of {never + found.size} bodies never within the span")
    if not found.size:
        return
    quantiles = np.quantile(found, QUANTILES)
    # Of a quantile of n samples: the values at the ranks within two deviations of a binomial count.
    spread = [np.quantile(found, np.clip((q + 2 * np.sqrt(q * (1 - q) / found.size), q - 2 * np.sqrt(
        q * (1 - q) / found.size)), 0, 1)) for q in QUANTILES]
    error = found.std() / np.sqrt(found.size)
    print(f"{name} ({found.size}): mean {found.mean():.2f} +- {2 * error:.2f}, "
          + ", ".join(f"{100 * q:.0f} % {value:.2f} [{low:.2f}, {high:.2f}]"
                      for q, value, (high, low) in zip(QUANTILES, quantiles, spread, strict=True)))


def compare(bodies, orbits, degree):
    """Step the simulator's own loop, with its RK4 steps and with a tenth of them."""
    field = make_field(degree)
    t = T * np.arange(int(np.ceil(orbits * PERIOD) / T) + 1)
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        B = np.array(field.at(t)) * 1e6
        r, v = field.orbit.at(t)
        np.concatenate([B, v], axis=1).tofile(folder / "field")
        J, most, residual, one, two = draw(bodies)
        np.concatenate([J, most, residual, 1e6 * one, 1e6 * two], axis=1).tofile(folder / "bodies")
        source = pathlib.Path(__file__).with_name("cpp") / "detumble_rk4.cpp"
        subprocess.run(["g++", "-O2", "-std=c++20", "-o", folder / "rk4", source], check=True)
        for steps in (2, 20):
            done = subprocess.run([folder / "rk4", folder / "field", folder / "bodies", str(steps), "1"],
                                  check=True, capture_output=True, text=True)
            rows = np.array([[float(x) for x in line.split()] for line in done.stdout.splitlines()])
            describe(f"RK4, {T / steps} s", rows[:, 0] / PERIOD)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bodies", type=int, default=500)
    parser.add_argument("--orbits", type=float, default=32)
    parser.add_argument("--degree", type=int, default=1, choices=(1, 2, 3, 4))
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--compare", action="store_true")
    given = parser.parse_args()
    print(f"published (500): mean {PUBLISHED_MEAN:.2f}, "
          + ", ".join(f"{100 * q:.0f} % {value:.2f}" for q, value in zip(QUANTILES, PUBLISHED, strict=True)),
          flush=True)
    if given.compare:
        compare(given.bodies, given.orbits, given.degree)
    scenes_of = functools.partial(make_scenes, given.bodies, given.orbits, given.degree)
    begin = time.perf_counter()
    with concurrent.futures.ProcessPoolExecutor(given.processes) as pool:
        omega, seconds, counts = zip(*pool.map(functools.partial(run, scenes_of), range(given.bodies)), strict=True)
    wall, cpu, ticks = time.perf_counter() - begin, sum(seconds), sum(counts)
    omega = np.array(omega)
    describe("polhode", find_times(scenes_of()[0].times, omega))
    ends = ", ".join(f"{x:.2f}" for x in np.linalg.norm(omega[:, -1], axis=1))
    print(f"rates at the end, each body: {ends} rad/s")
    print(f"{ticks} ticks in {wall:.0f} s on {given.processes} processes, {cpu:.1f} s of processors: "
          f"{1e6 * cpu / ticks:.2f} us a tick; 500 bodies and 32 orbits on two cores: "
          f"{cpu / ticks * 500 * 32 * PERIOD / T / 120:.0f} minutes")


if __name__ == "__main__":
    main()
