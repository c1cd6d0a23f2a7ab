"""The equations of the last formulas are kept: an answer has the bits that it has where nothing is kept."""

import threading

import numpy as np

import polhode as ph
from polhode.torques import Constant, Damping, Formula, Gravity, GravityGradient

FULL = [[2.0, 0.1, 0.2], [0.1, 2.5, 0.3], [0.2, 0.3, 3.0]]


def law(c=0.05, m=(0.3, 0.2, 0.5)):
    return Formula(text="-c * omega + cross(m, to_body([0, 0, -1]))", c=c, m=m, recognise=False)


def swapped():
    """The same formula with its operations made in another order."""
    return Formula(lambda t, omega, attitude, p: np.cross(p.m, ph.formula.to_body(attitude, (0, 0, -1))) - p.c * omega,
                   c=0.05, m=(0.3, 0.2, 0.5), recognise=False)


def wheel(start):
    return Formula(lambda t, w, q, p, s: (-0.1 * w - s.h, {"h": 0.2 * w - s.h}), states={"h": start})


LAW = law()
CASES = {
    "plain": {"torques": [LAW]},
    "another inertia": {"torques": [LAW], "inertia": (1.0, 2.0, 2.75)},
    "a full tensor": {"torques": [LAW], "inertia": FULL},
    "axes that differ": {"torques": [LAW], "inertia": (2.5, 1.0, 2.0)},
    "symmetric": {"torques": [LAW], "inertia": (2.0, 2.0, 3.0)},
    "about the third axis": {"torques": [LAW], "omega": (0.1, -0.2, 3.0)},
    "a rotor": {"torques": [LAW], "rotors": [ph.Rotor(axis=(0, 0, 1), momentum=0.2)]},
    "another rotor": {"torques": [LAW], "rotors": [ph.Rotor(axis=(0, 0, 1), momentum=0.25)]},
    "another number": {"torques": [law(c=0.06)]},
    "another arm": {"torques": [law(m=(0.3, 0.2, 0.6))]},
    "an equal formula": {"torques": [law()]},
    "another order": {"torques": [swapped()]},
    "gravity": {"torques": [LAW, Gravity(1.0, (0.1, 0.2, 0.3))]},
    "more gravity": {"torques": [LAW, Gravity(1.5, (0.1, 0.2, 0.3))]},
    "gravity elsewhere": {"torques": [LAW, Gravity(1.0, (0.1, 0.2, 0.4))]},
    "a force": {"torques": [LAW, Constant((0.1, 0.2, 0.3))]},
    "a force in space": {"torques": [LAW, Constant((0.1, 0.2, 0.3), "space")]},
    "damping": {"torques": [LAW, Damping((0.1, 0.2, 0.3))]},
    "more damping": {"torques": [LAW, Damping((0.1, 0.2, 0.4))]},
    "an orbit": {"torques": [LAW, GravityGradient(0.3)]},
    "the same orbit, another body": {"torques": [LAW, GravityGradient(0.3)], "inertia": (1.0, 2.0, 2.75)},
    "states": {"torques": [wheel((0.1, 0.0, 0.2))]},
    "states that start elsewhere": {"torques": [wheel((0.1, 0.3, 0.2))]},
}


def make(case):
    given = {"inertia": (1.0, 2.0, 2.5), "omega": (0.3, 1.0, -0.2), "times": np.linspace(0.0, 3.0, 4), **case}
    return ph.Scene(**given)


def answer(case, by):
    motion = ph.solve(make(case), 1e-9, sensitivity=by) if by else ph.solve(make(case), rtol=1e-9, method="taylor")
    found = [motion.omega, motion.attitude]
    return [*found, motion.sensitivity.d_omega, motion.sensitivity.d_attitude] if by else found


def alone(*given):
    """The answer of a new thread, which has kept nothing."""
    found = []
    thread = threading.Thread(target=lambda: found.extend(answer(*given)))
    thread.start(), thread.join()
    return found


def compare(cases, choices):
    """Each case by each choice of columns, so that equations of all kinds follow each other."""
    runs = {(name, by): alone(cases[name], by) for by in choices for name in cases}
    first = next(iter(runs))
    for run in [*runs, *reversed(runs), *sum(([run, first, run] for run in runs), [])]:
        for mine, other in zip(answer(cases[run[0]], run[1]), runs[run], strict=True):
            np.testing.assert_array_equal(mine.view(np.int64), other.view(np.int64), str(run))


def test_kept_equations_change_no_bits():
    compare(CASES, [()])


def test_kept_equations_of_columns_change_no_bits():
    compare(CASES, [("omega",), ("omega", "inertia")])
    laws = {name: case for name, case in CASES.items() if "states" not in name}
    compare(laws, [("torques.0.c",), ("torques.0.m",)])
    spring = Formula(text="-c * omega - k * attitude.xyz", c=0.05, k=0.5)
    compare({"a spring": {"torques": [spring]}}, [("torques.0.c",), ("torques.0.k",)])
    rotors = {name: case for name, case in CASES.items() if "rotor" in name}
    compare(rotors, [("rotors.0.momentum",), ("omega",), ("torques.0.c",)])
    gravity = {name: case for name, case in CASES.items() if "gravity" in name}
    compare(gravity, [("torques.0.c",), ("torques.1.weight",), ("torques.1.arm",)])
