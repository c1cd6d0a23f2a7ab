"""Rigid bodies that turn: where does the body point, and how fast does it spin, at time t?"""

from ._core import IntegrationFailure, InvalidInput, __version__, build_info

__all__ = ["IntegrationFailure", "InvalidInput", "__version__", "build_info"]
