"""The kinds, and scenes drawn from them.

A kind changes a draft: STARTS the body and its start, TIMES what is asked for, TORQUES what acts. A scene of a kind of
starts or times gets one kind of torques at random. "mixed" takes of all three. HARD kinds are whole.
"""

from dataclasses import dataclass

import numpy as np

import polhode as ph

from .dice import Dice
from .draft import Draft
from .hard import HARD
from .starts import STARTS
from .times import TIMES
from .torques import TORQUES

KINDS = (*TORQUES, *STARTS, *TIMES, "mixed", *HARD)
DECADES = ((3, 6), (6, 9), (9, 12))   # of the accuracies asked of one scene


@dataclass(frozen=True)
class Drawn:
    """One scene, with what it was drawn from."""

    seed: int
    kind: str
    index: int
    parts: tuple
    scene: ph.Scene
    accuracies: tuple


def draw(seed, kind, index):
    """Return the scene of a kind with a number."""
    dice = Dice(seed, kind, index)
    pace = dice.decade(-1, 1)
    count = 2 + int(dice.decade(0.3, 2))
    draft = Draft(moments=dice.box(), omega=pace * dice.direction(), attitude=dice.attitude(), pace=pace,
                  turns=dice.decade(-0.3, 1.3), grid=np.linspace(0, 1, count))
    parts = choose(dice, kind)
    for part in parts:
        {**STARTS, **TIMES, **TORQUES, **HARD}[part](dice, draft)
    accuracies = tuple(float(dice.decade(-high, -low)) for low, high in DECADES)
    return Drawn(seed, kind, index, parts, draft.finish(f"{kind} {index}"), accuracies)


def choose(dice, kind):
    """The changes of a draft in their order: starts, times, torques."""
    if kind in TORQUES or kind in HARD:
        return (kind,)
    torques = [dice.pick(tuple(TORQUES))]
    if kind != "mixed":
        return (kind, *torques)
    if dice.chance(0.4):
        torques.append(dice.pick(tuple(TORQUES)))
    times = [dice.pick(tuple(TIMES)) for _ in range(dice.whole(1, 2))]
    return (dice.pick(tuple(STARTS)), *times, *torques)


def write_python(scene):
    """The scene as a line of Python, with `import polhode as ph` and `import numpy as np`."""
    def numbers(values):
        return repr(np.asarray(values).tolist())

    def write(torque):
        match torque:
            case ph.torques.Constant():
                return f"ph.torques.Constant({numbers(torque.torque)}, {str(torque.frame)!r})"
            case ph.torques.Gravity():
                return f"ph.torques.Gravity({torque.weight!r}, {numbers(torque.arm)})"
            case ph.torques.GravityGradient():
                return f"ph.torques.GravityGradient({torque.mean_motion!r}, {torque.phase!r})"
            case ph.torques.Damping():
                return f"ph.torques.Damping({numbers(torque.matrix)})"
            case ph.torques.AngularDamping():
                return f"ph.torques.AngularDamping({torque.rate!r})"
            case ph.torques.During():
                return f"ph.torques.During({write(torque.torque)}, {numbers(torque.windows)})"
            case _:
                return f"ph.torques.Custom(family.custom.{torque.function!r})"

    matrix = scene.inertia.matrix
    diagonal = np.array_equal(matrix, np.diag(np.diag(matrix)))
    rotors = f"rotors={list(scene.rotors)!r}, ".replace("polhode.", "ph.") if scene.rotors else ""
    return (f"ph.Scene(inertia={numbers(np.diag(matrix) if diagonal else matrix)}, omega={numbers(scene.omega)}, "
            f"attitude={numbers(scene.attitude)}, torques=[{', '.join(map(write, scene.torques))}], "
            f"{rotors}times={numbers(scene.times)}, want={list(scene.want)!r}, t0={scene.t0!r}, name={scene.name!r})")
