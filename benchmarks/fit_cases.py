"""Made measurements of random bodies for the bars of fits, and whether a fit found the body."""

import numpy as np

import polhode as ph

LAWS = ("lambert", "lommel-seeliger", "geometric")
NEAR = 0.06      # of moments over the largest, and of rates over |omega|: a candidate is the body


def random_body(rng, speed=2.0):
    half = rng.uniform(0.1, 1, 3) ** 2
    omega, q = rng.normal(size=3), rng.normal(size=4)
    return half.sum() - half, speed * omega / np.linalg.norm(omega), q / np.linalg.norm(q)


def times(rng, count, turns, speed=2.0):
    return np.sort(rng.uniform(0, 1, count)) * rng.uniform(*turns) * 2 * np.pi / speed


def attitudes(rng, count, turns):
    inertia, omega, q = random_body(rng)
    t = times(rng, count, turns)
    seen = ph.Rotation.from_quat(ph.FreeMotion(inertia, omega, q).at(t)[1])
    noise = ph.Rotation.from_rotvec(0.01 * rng.normal(size=(count, 3)))
    return ph.measured.Attitudes(t, seen * noise, 0.01), inertia, omega, q


def axis(rng, count, turns):
    inertia, omega, q = random_body(rng)
    t = times(rng, count, turns)
    seen = ph.Rotation.from_quat(ph.FreeMotion(inertia, omega, q).at(t)[1]).apply(np.array([0, 0, 1.0]))
    return ph.measured.Axis(t, seen + 0.01 * rng.normal(size=seen.shape), 0.01, (0, 0, 1)), inertia, omega, q


def direction(rng, count, turns):
    inertia, omega, q = random_body(rng)
    t = times(rng, count, turns)
    seen = ph.Rotation.from_quat(ph.FreeMotion(inertia, omega, q).at(t)[1]).inv().apply(np.array([0, 0, 1.0]))
    return ph.measured.Direction(t, seen + 0.01 * rng.normal(size=seen.shape), 0.01, (0, 0, 1)), inertia, omega, q


def rates(rng, count, periods, even):
    """Gyroscope logs over some periods of omega, coarse or fine, with 1 % of noise."""
    inertia, omega, q = random_body(rng)
    motion = ph.FreeMotion(inertia, omega, q)
    span = rng.uniform(*periods) * motion.period
    t = np.linspace(0, span, count) if even else np.sort(rng.uniform(0, span, count))
    return ph.measured.Rates(t, motion.at(t)[0] + 0.02 * rng.normal(size=(count, 3)), 0.02), inertia, omega, q


def light(rng, count, turns, law=None):
    """The light of an ellipsoid of even density with 5 % of noise, the Sun at 17 to 92 degrees from the observer."""
    while True:
        axes = np.sort(rng.uniform(0.2, 1, 3))
        if axes[0] * 1.1 < axes[1] and axes[1] * 1.1 < axes[2]:
            break
    axes = axes[rng.permutation(3)]
    inertia = (axes**2).sum() - axes**2
    _, omega, q = random_body(rng)
    t = times(rng, count, turns)
    sun, other = rng.normal(size=(2, 3))
    sun /= np.linalg.norm(sun)
    other = np.cross(sun, other)
    angle = rng.uniform(0.3, 1.6)
    seen = dict(body=tuple(axes), sun=sun, observer=np.cos(angle) * sun + np.sin(angle) * other / np.linalg.norm(other),
                law=law or LAWS[rng.integers(3)])
    made = ph.measured.Brightness(t, np.ones(count), 1.0, **seen).model(ph.FreeMotion(inertia, omega, q).at(t)[1])
    sigma = 0.05 * made.mean()
    return ph.measured.Brightness(t, made + sigma * rng.normal(size=count), sigma, **seen), inertia, omega, q


def distance(body, inertia, omega, twins):
    """The largest difference of a candidate from the body, up to exchanged axes and signs."""
    return min(max(np.abs(body.inertia - inertia[p] / inertia.max()).max(),
                   np.abs(np.abs(body.omega) - np.abs(omega[p])).max() / np.linalg.norm(omega)) for p in twins)


def minimum_of(data, inertia, omega, q):
    """The fit that starts at the truth: the minimum that a search should find."""
    scene = ph.Scene(inertia=tuple(inertia), omega=tuple(omega), attitude=q, times=data.t)
    return ph.fit(data, scene, start="scene")


def problem_of(data, scene):
    """The residuals and derivatives of a fit from a scene, for SciPy's least_squares; no step is made."""
    from polhode._sensitivity.fit import _set_up

    return _set_up([data], ("omega", "attitude", "inertia"), scene, False)[2]
