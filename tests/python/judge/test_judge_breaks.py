"""Parts of the judge, each broken on purpose: what it decides is then wrong, and is right without the break."""

import numpy as np
import pytest

import polhode as ph
from polhode._judge import causes, conventions, gaps, laws, methods, name, read, refine, score, shooting, work
from polhode._judge.law import Law

I = (1.0, 2.0, 2.5)
T = np.linspace(0, 6, 120)
MOTION = ph.FreeMotion(I, (1, 0.5, 2))
W, Q = MOTION.at(T)
SCENE = ph.Scene(inertia=I, omega=(1, 0.5, 2), times=T)


def main(attitude=Q, omega=W, t=T, inertia=I, **words):
    """The main finding; a remark counts as none."""
    words = words if "scene" in words else {"inertia": inertia, **words}
    found = ph.judge(t, attitude, omega, tolerance=1e-12, **words)
    return next((f for f in found.findings if f.level != "remark"), None)


def cause(*given, **words):
    found = main(*given, **words)
    return found.cause if found else ""


def shaken(noise, seed, attitude=Q, omega=W):
    rng = np.random.default_rng(seed)
    shake = ph.Rotation.from_rotvec(noise * rng.normal(size=(len(T), 3)))
    return (ph.Rotation.from_quat(attitude) * shake).as_quat(), omega + noise * rng.normal(size=omega.shape)


def rounded_constant():
    w, q = ph.FreeMotion(I, (0, 0, 2.1)).at(T)
    return cause(q, w.astype(np.float32).astype(float)) == ""


def few_nats():
    q, w = shaken(1e-3, 3)
    return cause(q, w + [4.6e-4, 0, 0]) == ""


def lag_or_tilt():
    motion = ph.FreeMotion((1, 1, 1.6), (1, 0.5, 2))
    q, w = shaken(1e-4, 1, motion.at(T)[1], motion.at(T + 0.01)[0])
    return cause(motion.at(T)[1], w, inertia=(1, 1, 1.6)) == "cannot tell"


def stepped(method, step=0.05):
    scene = SCENE.replace(times=step * np.arange(100))
    run = ph.solve(scene, method=method, step=step)
    return main(run.attitude, run.omega, scene.times, scene=scene)


def rk4():
    found = stepped("rk4")
    return (found.cause, found.order) == ("integrator", 4) and abs(found.step / 0.05 - 1) < 1e-9


def high_order():
    """Butcher's rule of order 5, for rates in space axes: with 20 to 40 steps a rule of order 3 is like it."""
    law, h = methods.InSpace(Law(np.diag(I))), 0.03
    y, rows = np.array([[1, 0.5, 2, 0, 0, 0, 1.0]]), []

    def f(y):
        return h * np.concatenate(law.field(np.zeros(1), y[:, :3], y[:, 3:]), axis=1)

    for _ in range(160):
        rows.append(y[0])
        a = f(y)
        b = f(y + a / 4)
        c = f(y + (a + b) / 8)
        d = f(y - b / 2 + c)
        e = f(y + (3 * a + 9 * d) / 16)
        g = f(y + (-3 * a + 2 * b + 12 * c - 12 * d + 8 * e) / 7)
        y = y + (7 * a + 32 * c + 12 * d + 32 * e + 7 * g) / 90
    out = np.array(rows)
    return cause(out[:, 3:] / np.linalg.norm(out[:, 3:], axis=1)[:, None], out[:, :3], h * np.arange(160),
                 scene=SCENE, frame="space") != "integrator"


def spike():
    w = W.copy()
    w[60] += 0.3
    found = main(Q, w)
    return (found.cause, found.where) == ("outlier", (60,))


def lost():
    keep = np.delete(np.arange(120), [50, 51])
    return cause(Q[keep], W[keep], T[:118]) == "dropped"


def without_term():
    run = ph.solve(SCENE, method="ignore", step=T[1])
    return cause(run.attitude, run.omega) == "no gyroscopic term"


def slow_clock():
    w, q = MOTION.at(T * 1.001)
    found = main(q, w)
    return found.cause == "clock" and abs(found.size - 0.001) < 1e-8


def late_start():
    w, q = MOTION.at(T + 1e-3)
    return cause(q, w, scene=SCENE) == "start"


def stop_carrying(monkeypatch):
    for room in (score, refine):
        monkeypatch.setattr(room, "carry", lambda phi, *given: shooting.carry(0 * phi + np.eye(6), *given))


BREAKS = {
    "a reversed attitude is not tried": (
        lambda m: m.setattr(conventions, "conjugate", lambda q: q),
        lambda: cause(Q * [-1, -1, -1, 1]) == "conjugate"),
    "the step of the last digit is no floor": (lambda m: m.setattr(read, "_floors", lambda *a: None), rounded_constant),
    "a gain of one nat is enough": (lambda m: m.setattr(name, "GAIN", 1.0), few_nats),
    "no lead is needed": (lambda m: m.setattr(name, "MARGIN", 0.0), lag_or_tilt),
    "the faulty model is not run": (lambda m: m.setattr(name, "refine", lambda scope, s, *a: s), rk4),
    "a method has another order": (lambda m: m.setitem(methods.STEPS, "RK4", (methods.STEPS["RK4"][0], 3)), rk4),
    "an unknown method is named at any step": (lambda m: m.setattr(name, "NEAR_STEPS", 1000), high_order),
    "no sample stands out": (lambda m: m.setattr(causes, "standing_out", lambda track: None), spike),
    "gaps are not looked for": (lambda m: m.setattr(gaps, "mend", lambda data, law, findings: data), lost),
    "no other law is tried": (lambda m: m.setattr(laws, "variants", lambda law: iter(())), without_term),
    "causes that are one and the same are rivals": (lambda m: m.setattr(name, "EQUIVALENT", set()), slow_clock),
    "the start is not checked": (lambda m: m.setattr(work, "check_start", lambda *a: None), late_start),
    "derivatives are not carried on": (stop_carrying, slow_clock),
}  # fmt: skip


@pytest.mark.parametrize("broken", BREAKS)
def test_a_break_is_seen(broken, monkeypatch):
    change, right = BREAKS[broken]
    assert right()
    change(monkeypatch)
    assert not right()
