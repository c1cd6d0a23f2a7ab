"""Rotational motion of rigid bodies: attitude and angular velocity as functions of time."""

import importlib as _importlib
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from . import _process  # first: it refuses subinterpreters and second copies

_process.require_one_copy(__file__)

from . import elliptic as elliptic
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
from ._core import DampedFree as DampedFree
from ._core import FreeMotion as FreeMotion
from ._core import Gyrostat as Gyrostat
from ._core import HeavyTop as HeavyTop
from ._core import IntegrationFailure as IntegrationFailure
from ._core import InvalidInput as InvalidInput
from ._core import Pendulum as Pendulum
from ._core import Rotor as Rotor
from ._core import __version__ as __version__
from ._plot.closed_forms import attach as _attach
from ._scene.scene import Scene as Scene
from ._sensitivity.fit import fit as fit
from ._sensitivity.free import free_sensitivity as free_sensitivity
from ._sensitivity.lyapunov import Lyapunov as Lyapunov
from ._sensitivity.lyapunov import lyapunov as lyapunov
from ._sensitivity.result import FitResult as FitResult
from ._sensitivity.sensitivity import Sensitivity as Sensitivity
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
    from . import atlas as atlas
    from . import charts as charts
    from . import recipe as recipe
    from . import report as report
    from . import schema as schema
    from ._ensemble.ensemble import Ensemble as Ensemble
    from ._ensemble.run import ensemble as ensemble
    from ._saved import load as load

_attach()   # the methods of compiled classes that are written in Python

# imported at first use, to keep `import polhode` fast
_LATE = ("atlas", "charts", "recipe", "report", "schema")
_LATE_NAMES = {"Ensemble": "_ensemble.ensemble", "ensemble": "_ensemble.run", "load": "_saved"}

__all__ = sorted({*(name for name in globals() if not name.startswith("_")), *_LATE_NAMES}) + ["__version__"]


def __getattr__(name: str) -> _Any:
    if name in _LATE_NAMES:
        return getattr(_importlib.import_module(f"{__name__}.{_LATE_NAMES[name]}"), name)
    if name in _LATE:
        return _importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_LATE, *_LATE_NAMES})
