"""What the tests of proofs share: scenes from plain numbers, and whether bounds hold numbers of two parts."""

import numpy as np

import polhode as ph
from polhode import torques


def make_torque(numbers):
    """A torque from plain numbers, with its windows."""
    kind = numbers["kind"]
    if kind == "gravity":
        torque = torques.Gravity(numbers["weight"], numbers["arm"])
    elif kind == "gradient":
        torque = torques.GravityGradient(numbers["mean_motion"], numbers["phase"])
    elif kind == "damping":
        torque = torques.Damping(numbers["matrix"])
    else:
        torque = torques.Constant(numbers["torque"], numbers["frame"])
    return torques.During(torque, numbers["windows"]) if "windows" in numbers else torque


def make_scene(numbers):
    """A scene from plain numbers."""
    return ph.Scene(inertia=np.array(numbers["inertia"]), omega=numbers["omega"], attitude=numbers["attitude"],
                    torques=[make_torque(torque) for torque in numbers["torques"]], times=numbers["times"],
                    t0=numbers["t0"])


def find_outside(motion, truth):
    """How many numbers of the truth lie outside of the bounds; it has shape (n, 7, 2), each number a sum of two."""
    lower = np.hstack([motion.omega_lower, motion.attitude_lower])
    upper = np.hstack([motion.omega_upper, motion.attitude_upper])
    high, low = truth[..., 0], truth[..., 1]
    below = (high < lower) | ((high == lower) & (low < 0))
    above = (high > upper) | ((high == upper) & (low > 0))
    return int((below | above).sum())


def make_formula_scene(numbers):
    """A scene with a formula from plain numbers; every constant of its text is a parameter."""
    parameters = {f"k{i}": x for i, x in enumerate(numbers["numbers"])}
    formula = torques.Formula(text=numbers["text"], recognise=False, **parameters)
    acting = [torques.During(formula, numbers["windows"]) if numbers["windows"] else formula]
    if numbers["gravity"]:
        acting.append(torques.Gravity(1.0, numbers["gravity"]))
    rotors = [ph.Rotor(axis=(0, 0, 1), momentum=numbers["rotor"])] if numbers["rotor"] else []
    return ph.Scene(inertia=np.array(numbers["inertia"]), omega=numbers["omega"], attitude=numbers["attitude"],
                    torques=acting, rotors=rotors, times=numbers["times"], t0=numbers["t0"])


def make_state_scene(numbers):
    """A scene with a formula that has states from plain numbers, perhaps with a driven rotor and a damper."""
    parameters = {f"k{i}": x for i, x in enumerate(numbers["numbers"])}
    starts = numbers["states"]
    states = {name: {"start": start, "rate": rate}
              for name, start, rate in zip("hz", (starts[:3], starts[3]), numbers["rates"], strict=True)}
    formula = torques.Formula(text=numbers["text"], recognise=False, states=states, **parameters)
    rotors = [ph.Rotor(free=True, **numbers["rotor"])] if numbers["rotor"] else []
    damper = ph.Damper(**numbers["damper"]) if numbers["damper"] else None
    return ph.Scene(inertia=np.array(numbers["inertia"]), omega=numbers["omega"], attitude=numbers["attitude"],
                    torques=[formula], rotors=rotors, damper=damper, times=numbers["times"], t0=numbers["t0"])


def count_states_outside(motion, numbers):
    """How many numbers of the truth lie outside of finite bounds, and how many were judged."""
    truth = np.array(numbers["truth"])   # rates, attitude, h, z, a rotor's momentum, a damper's
    bounds = []
    for side in ("lower", "upper"):
        states = getattr(motion, f"states_{side}")
        rows = [getattr(motion, f"omega_{side}"), getattr(motion, f"attitude_{side}"), states["h"],
                states["z"][:, None]]
        rows.append(states["rotor_momentum_0"][:, None] if numbers["rotor"] else np.full((len(motion.t), 1), np.nan))
        rows.append(states["damper_momentum"] if numbers["damper"] else np.full((len(motion.t), 3), np.nan))
        bounds.append(np.hstack(rows))
    lower, upper = bounds
    high, low = truth[..., 0], truth[..., 1]
    outside = (high < lower) | ((high == lower) & (low < 0)) | (high > upper) | ((high == upper) & (low > 0))
    finite = np.isfinite(lower) & np.isfinite(upper)
    return int((outside & finite).sum()), int(finite.sum())
