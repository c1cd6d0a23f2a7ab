"""Rotational motion of rigid bodies: attitude and angular velocity as functions of time."""

from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from . import _process  # first: it refuses subinterpreters and second copies

_process.require_one_copy(__file__)

from . import _wings
from . import elliptic as elliptic
from . import formula as formula
from . import inertia as inertia
from . import measured as measured
from . import mesh as mesh
from . import shapes as shapes
from . import torques as torques
from ._attitude.kinematics import body_rates as body_rates
from ._attitude.kinematics import euler_rates as euler_rates
from ._attitude.rotation import Rotation as Rotation
from ._batch.closed_forms import free_motion as free_motion
from ._batch.closed_forms import gyrostat as gyrostat
from ._batch.closed_forms import heavy_top as heavy_top
from ._batch.solve_many import Motions as Motions
from ._batch.solve_many import solve_many as solve_many
from ._batch.step import step as step
from ._build import build_info as build_info
from ._build import cmake_prefix as cmake_prefix
from ._clock.controller import Controller as Controller
from ._clock.controller import Measure as Measure
from ._core import Changing as Changing
from ._core import Damper as Damper
from ._core import IntegrationFailure as IntegrationFailure
from ._core import InvalidInput as InvalidInput
from ._core import Rotor as Rotor
from ._core import __version__ as __version__
from ._core.exact import *  # noqa: F403  the list is the compiled one
from ._orbit.field import MagneticField as MagneticField
from ._orbit.orbit import Orbit as Orbit
from ._orbit.plates import Plate as Plate
from ._plot.closed_forms import attach as _attach
from ._scene.scene import Scene as Scene
from ._sensitivity.fit import fit as fit
from ._sensitivity.free import free_sensitivity as free_sensitivity
from ._sensitivity.lyapunov import Lyapunov as Lyapunov
from ._sensitivity.lyapunov import lyapunov as lyapunov
from ._sensitivity.result import FitResult as FitResult
from ._sensitivity.sensitivity import Sensitivity as Sensitivity
from ._solve.effect import effect as effect
from ._solve.motion import Motion as Motion
from ._solve.plan import Plan as Plan
from ._solve.plan import plan as plan
from ._solve.solve import Event as Event
from ._solve.solve import generalised_forces as generalised_forces
from ._solve.solve import methods as methods
from ._solve.solve import solve as solve
from .inertia import InertiaTensor as InertiaTensor
from .inertia import MassProperties as MassProperties
from .inertia import PrincipalAxes as PrincipalAxes

if _TYPE_CHECKING:
    from . import recipe as recipe
    from . import schema as schema
    from ._saved import load as load
    from ._wings import AttitudeEphemeris as AttitudeEphemeris
    from ._wings import Ensemble as Ensemble
    from ._wings import Judgement as Judgement
    from ._wings import atlas as atlas
    from ._wings import charts as charts
    from ._wings import ensemble as ensemble
    from ._wings import judge as judge
    from ._wings import report as report

_attach()   # the methods of compiled classes that are written in Python

# Imported at first use, to keep `import polhode` fast; of wings that are not there, refused by name.
_LATE_NAMES = {"load": "_saved", "recipe": "recipe", "schema": "schema", **_wings.list_names()}
_LATE = [name for name, module in _LATE_NAMES.items() if name == module]

__all__ = sorted({name for name in {*globals(), *_LATE_NAMES} if not name.startswith("_")} - {*_LATE}) + ["__version__"]


def __getattr__(name: str) -> _Any:
    if place := {**_LATE_NAMES, **_wings.list_names(there=False)}.get(name):
        module = _wings.load(place)
        return module if name == place else getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATE_NAMES})
