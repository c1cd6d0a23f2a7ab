"""Rigid bodies that turn: where does the body point, and how fast does it spin, at time t?"""

from . import elliptic as elliptic
from . import inertia as inertia
from . import mesh as mesh
from . import shapes as shapes
from . import torques as torques
from ._core import FreeMotion as FreeMotion
from ._core import HeavyTop as HeavyTop
from ._core import IntegrationFailure as IntegrationFailure
from ._core import InvalidInput as InvalidInput
from ._core import __version__ as __version__
from .attitude import Rotation as Rotation
from .attitude import body_rates as body_rates
from .attitude import euler_rates as euler_rates
from .batch import free_motion as free_motion
from .batch import heavy_top as heavy_top
from .build import build_info as build_info
from .build import cmake_prefix as cmake_prefix
from .inertia import InertiaTensor as InertiaTensor
from .inertia import MassProperties as MassProperties
from .inertia import PrincipalAxes as PrincipalAxes
from .many import Motions as Motions
from .many import solve_many as solve_many
from .motion import Motion as Motion
from .planning import Plan as Plan
from .planning import plan as plan
from .scene import Scene as Scene
from .solver import Event as Event
from .solver import generalised_forces as generalised_forces
from .solver import methods as methods
from .solver import solve as solve

__all__ = sorted(name for name in globals() if not name.startswith("_")) + ["__version__"]
