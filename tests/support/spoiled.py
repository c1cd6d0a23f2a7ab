"""Motions with one known fault each, made by other routes than the judge's: loops of plain steps, and closed forms."""

import dataclasses
import math

import numpy as np

import polhode as ph

FAMILIES = ("box", "symmetric", "separatrix", "heavy", "tensor")


@dataclasses.dataclass
class Case:
    """Samples with the words that `polhode.judge` is called with, the fault's cause, and its size."""

    t: np.ndarray
    attitude: np.ndarray
    omega: np.ndarray
    words: dict
    cause: str = ""
    size: object = None
    family: str = ""
    noise: float = 0.0
    order: int = 0
    step: float = 0.0
    accepted: tuple = ()


def body(family, rng):
    """A body's tensor, its start, and its torques."""
    moments = np.array([1.0, rng.uniform(1.4, 1.9), rng.uniform(2.0, 2.3)])
    omega, torques = rng.normal(size=3) * [1.0, 1.2, 1.0] + [0.6, 0.4, 1.4], ()
    tensor = np.diag(moments)
    if family == "symmetric":
        tensor = np.diag([1.0, 1.0, rng.uniform(0.4, 1.7)])
    elif family == "separatrix":
        omega = np.array([rng.normal() * 0.02, 2.0, rng.normal() * 0.02])
    elif family == "heavy":
        torques = (ph.torques.Gravity(weight=rng.uniform(0.5, 2), arm=rng.normal(size=3) * 0.3),)
    elif family == "tensor":
        axes = ph.Rotation.random(rng=rng).as_matrix()
        tensor = axes @ tensor @ axes.T
        tensor = 0.5 * (tensor + tensor.T)
    return tensor, omega * rng.uniform(0.5, 2), torques


def scene_of(family, rng, count=None, turns=None):
    tensor, omega, torques = body(family, rng)
    count, turns = count or int(rng.integers(160, 261)), turns or rng.uniform(1, 4)
    times = np.linspace(0, turns * 2 * math.pi / np.linalg.norm(omega), count)
    attitude = ph.Rotation.random(rng=rng).as_quat()
    return ph.Scene(
        inertia=ph.InertiaTensor(tensor, physical=False), omega=omega, attitude=attitude, torques=torques, times=times
    )


def exact(scene, times=None, **changes):
    """The exact motion at some times, and with some changes of the scene."""
    if times is not None:
        changes["times"] = times
    scene = scene.replace(**changes) if changes else scene
    if not scene.torques:
        return ph.FreeMotion(scene.inertia, scene.omega, scene.attitude).at(scene.times - scene.t0)
    motion = ph.solve(scene, 1e-12)
    return motion.omega, motion.attitude


def multiply(p, q):
    x, y, z, w = p
    a, b, c, d = q
    return np.array(
        [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ]
    )


def slope(scene, t, y):
    tensor, omega, attitude = scene.inertia.matrix, y[:3], y[3:]
    torque = sum((f.value(t, omega, attitude / np.linalg.norm(attitude)) for f in scene.torques), np.zeros(3))
    return np.concatenate(
        [np.linalg.solve(tensor, torque - np.cross(omega, tensor @ omega)), 0.5 * multiply(attitude, [*omega, 0])]
    )


def integrated(scene, name, substeps):
    """A fixed-step run by a textbook method, one body and one step at a time."""
    y, t, out, old = np.concatenate([scene.omega, scene.attitude]), 0.0, [], None
    h = (scene.times[1] - scene.times[0]) / substeps

    def f(t, y):
        return slope(scene, t, y)

    for _ in scene.times:
        out.append(y.copy())
        for _step in range(substeps):
            a = f(t, y)
            if name == "Euler":
                y = y + h * a
            elif name == "semi-implicit Euler":
                w = y[:3] + h * a[:3]
                y = np.concatenate([w, y[3:] + 0.5 * h * multiply(y[3:], [*w, 0])])
            elif name == "Heun":
                y = y + h / 2 * (a + f(t + h, y + h * a))
            elif name == "midpoint":
                y = y + h * f(t + h / 2, y + h / 2 * a)
            elif name == "AB2":
                if old is None:
                    w, q = exact(scene, [scene.t0 - h])
                    old = f(t - h, np.concatenate([w[0], q[0]]))
                y, old = y + h * (1.5 * a - 0.5 * old), a
            elif name == "RK3":
                b = f(t + h / 2, y + h / 2 * a)
                y = y + h / 6 * (a + 4 * b + f(t + h, y + h * (2 * b - a)))
            else:
                b = f(t + h / 2, y + h / 2 * a)
                c = f(t + h / 2, y + h / 2 * b)
                y = y + h / 6 * (a + 2 * b + 2 * c + f(t + h, y + h * c))
            y[3:] /= np.linalg.norm(y[3:])
            t += h
    out = np.array(out)
    return out[:, :3], out[:, 3:]


ORDERS = {"Euler": 1, "semi-implicit Euler": 1, "Heun": 2, "midpoint": 2, "AB2": 2, "RK3": 3, "RK4": 4}


def slerp(p, q, part):
    first, second = ph.Rotation.from_quat(p), ph.Rotation.from_quat(q)
    return (first * ph.Rotation.from_rotvec((first.inv() * second).as_rotvec() * part)).as_quat()


def make(cause, family, seed):
    """A case of a fault, or None where the family cannot show it in principle."""
    rng = np.random.default_rng(seed)
    scene = scene_of(family, rng)
    t, tensor = np.array(scene.times), scene.inertia.matrix
    dt, rate = t[1] - t[0], float(np.linalg.norm(scene.omega))
    words = {"scene": scene.replace(torques=scene.torques)} if scene.torques else {"inertia": tensor}
    omega, attitude = exact(scene)
    part = 10 ** rng.uniform(math.log10(3e-3), -1) * rng.choice([-1, 1])
    case = Case(t, attitude, omega, words, cause, family=family)
    turned = ph.Rotation.from_quat(attitude)
    direction = rng.normal(size=3)
    direction /= np.linalg.norm(direction)
    if cause == "scalar order":
        case.attitude = np.roll(attitude, 1, axis=1)
    elif cause == "conjugate":
        case.attitude = attitude * [-1, -1, -1, 1]
    elif cause == "frame of rates":
        case.omega = turned.apply(omega)
    elif cause == "units of rates":
        case.size = rng.choice([math.pi / 180, 2 * math.pi / 60, 2 * math.pi])
        case.omega = omega / case.size
    elif cause == "units of time":
        case.size = rng.choice([1e-3, 1e-6, 1e-9])
        case.t = t / case.size
    elif cause == "axis flipped":
        case.omega = omega * (1 - 2 * np.eye(3)[rng.integers(3)])
    elif cause == "axes exchanged":
        case.omega = omega[:, [[1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0]][rng.integers(4)]]
    elif cause == "Euler sequence":
        case.attitude = turned.as_euler(str(rng.choice(["XYZ", "ZXZ", "zyx"])))
        case.words["euler"] = "ZYX"
    elif cause == "inertia axes":
        if family == "symmetric":
            return None
        order = [[1, 0, 2], [0, 2, 1], [2, 1, 0]][rng.integers(3)]
        case.words = (
            {"inertia": tensor[np.ix_(order, order)]}
            if not scene.torques
            else {"scene": scene.replace(inertia=ph.InertiaTensor(tensor[np.ix_(order, order)], physical=False))}
        )
    elif cause == "products of inertia":
        if family != "tensor":
            return None
        case.words = {"inertia": 2 * np.diag(np.diag(tensor)) - tensor}
        try:
            ph.InertiaTensor(case.words["inertia"], physical=True)
        except ph.InvalidInput:
            return None
    elif cause in ("no gyroscopic term", "gyroscopic sign"):
        if family == "separatrix":
            scene = scene.replace(omega=[0.7, 1.5, 0.9])
        factor = 1.0 if cause == "no gyroscopic term" else 2.0
        extra = ph.torques.Custom(lambda t, w, q: factor * np.cross(w, tensor @ w))
        case.omega, case.attitude = exact(scene, torques=(*scene.torques, extra))
        if scene.torques:
            case.words = {"scene": scene}
    elif cause == "kinematics":
        place, fine = rng.choice([0.0, 1.0, 0.5]), 4
        count = int(rng.integers(1, 3)) * (1 if place == 0.5 else 3)
        w = exact(scene, np.linspace(0, t[-1], (len(t) - 1) * count + 1))[0]
        q, out = ph.Rotation.from_quat(attitude[0]), []
        for k in range(len(w)):
            if k % count == 0:
                out.append(q.as_quat())
            if k + 1 < len(w):
                q = q * ph.Rotation.from_rotvec(dt / count * ((1 - place) * w[k] + place * w[k + 1]))
        case.attitude, case.step, case.order = np.array(out), dt / count, 2 if place == 0.5 else 1
        case.accepted = ("lag",) if place != 0.5 and count > 1 else ()
        del fine
    elif cause == "inertia":
        if family == "symmetric":
            changed = tensor * np.diag([1, 1, 1 + part])
        else:
            moments, axes = scene.inertia.moments, scene.inertia.axes
            changed = axes @ np.diag(moments * [1 + part, 1, 1]) @ axes.T
        made = ph.InertiaTensor(0.5 * (changed + changed.T), physical=False)
        case.omega, case.attitude = exact(scene, inertia=made)
        case.size = math.log(1 + part)
    elif cause == "damping":
        case.size = abs(part) / t[-1]
        extra = ph.torques.AngularDamping(case.size)
        case.omega, case.attitude = exact(scene, torques=(*scene.torques, extra))
    elif cause == "torque":
        case.size = direction * abs(part) * np.trace(tensor) / 3 * rate / t[-1]
        extra = ph.torques.Constant(case.size, frame="body")
        case.omega, case.attitude = exact(scene, torques=(*scene.torques, extra))
    elif cause == "integrator":
        name = str(rng.choice(list(ORDERS)))
        count = int(rng.integers(1, 4)) * (3 if ORDERS[name] == 1 else 1)
        case.omega, case.attitude = integrated(scene, name, count)
        case.order, case.step = ORDERS[name], dt / count
    elif cause == "clock":
        case.size = part
        case.omega, case.attitude = exact(scene, t * (1 + part))
    elif cause == "lag":
        case.size = dt * rng.uniform(0.2, 3) * rng.choice([-1, 1])
        case.omega = exact(scene, np.sort(t + case.size))[0]
    elif cause == "start":
        case.words = {"scene": scene.replace(omega=scene.omega * (1 + part * direction))}
        case.size = -scene.omega * part * direction
    elif cause == "turning frame":
        case.size = direction * abs(part) / t[-1] * rng.choice([1, 3])
        if rng.random() < 0.5:
            case.omega = omega + turned.apply(case.size, inverse=True)
        else:
            case.attitude = (ph.Rotation.from_rotvec(t[:, None] * case.size) * turned).as_quat()
    elif cause == "misaligned":
        case.size = direction * abs(part)
        case.omega = ph.Rotation.from_rotvec(case.size).apply(omega, inverse=True)
    elif cause == "bias":
        case.size = direction * abs(part) * rate
        case.omega = omega + case.size
    elif cause == "norm":
        case.attitude = attitude * (1 + abs(part) * 0.5 * (t / t[-1]))[:, None]
        case.size = abs(part) * 0.5
    elif cause == "dropped":
        place, count = int(rng.integers(20, len(t) - 30)), int(rng.integers(1, 6))
        gone = np.arange(place, place + count)
        case.omega, case.attitude = np.delete(omega, gone, 0), np.delete(attitude, gone, 0)
        case.t, case.size = t[: len(t) - count], count
    elif cause == "duplicated":
        place = int(rng.integers(20, len(t) - 20))
        case.omega = np.insert(omega, place, omega[place], 0)[: len(t)]
        case.attitude = np.insert(attitude, place, attitude[place], 0)[: len(t)]
        case.size = 1
    elif cause == "interpolated":
        spacing = int(rng.choice([3, 4, 5, 8]))
        case.attitude = np.array(
            [
                attitude[k]
                if k // spacing * spacing + spacing >= len(t)
                else slerp(
                    attitude[k // spacing * spacing], attitude[k // spacing * spacing + spacing], k % spacing / spacing
                )
                for k in range(len(t))
            ]
        )
        case.size = spacing * dt
    elif cause == "outlier":
        place = int(rng.integers(5, len(t) - 5))
        case.omega = omega.copy()
        case.omega[place] += direction * rate * max(0.03, abs(part))
        case.size = place
    return case


FAULTS = (
    "scalar order",
    "conjugate",
    "frame of rates",
    "units of rates",
    "units of time",
    "axis flipped",
    "axes exchanged",
    "Euler sequence",
    "inertia axes",
    "products of inertia",
    "no gyroscopic term",
    "gyroscopic sign",
    "kinematics",
    "inertia",
    "damping",
    "torque",
    "integrator",
    "clock",
    "lag",
    "start",
    "turning frame",
    "misaligned",
    "bias",
    "norm",
    "dropped",
    "duplicated",
    "interpolated",
    "outlier",
)


def noisy(case, noise, rng):
    """The case with noise on both channels, of the rates relative to their size."""
    if not noise:
        return case
    size = float(np.sqrt(np.mean(case.omega**2)))
    omega = case.omega + noise * size * rng.normal(size=case.omega.shape)
    attitude = case.attitude + noise * rng.normal(size=case.attitude.shape)
    if case.attitude.shape[1] == 4:
        shake = ph.Rotation.from_rotvec(noise * rng.normal(size=(len(case.t), 3)))
        length = np.linalg.norm(case.attitude, axis=1)[:, None]
        if case.cause == "scalar order":
            rotation = ph.Rotation.from_quat(np.roll(case.attitude, -1, axis=1)) * shake
            attitude = np.roll(rotation.as_quat(), 1, axis=1)
        else:
            attitude = (ph.Rotation.from_quat(case.attitude / length) * shake).as_quat() * length
    if case.cause == "duplicated":
        same = np.flatnonzero(np.all(np.diff(case.omega, axis=0) == 0, axis=1))[0]
        omega[same + 1], attitude[same + 1] = omega[same], attitude[same]
    return dataclasses.replace(case, omega=omega, attitude=attitude, noise=noise)
