"""Rigid bodies that turn: where does the body point, and how fast does it spin, at time t?"""

from . import inertia, shapes
from ._core import FreeMotion, IntegrationFailure, InvalidInput, __version__, build_info
from .inertia import InertiaTensor, MassProperties, PrincipalAxes

__all__ = [
    "FreeMotion",
    "InertiaTensor",
    "IntegrationFailure",
    "InvalidInput",
    "MassProperties",
    "PrincipalAxes",
    "__version__",
    "build_info",
    "inertia",
    "shapes",
]
