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
