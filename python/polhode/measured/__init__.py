"""What was measured of a rotating body, for :func:`polhode.fit`. NaN samples are left out and counted."""

from .base import Measurement
from .light import Brightness, Scalar
from .sensors import Acceleration, Attitudes, Axis, Direction, Rates

__all__ = ["Acceleration", "Attitudes", "Axis", "Brightness", "Direction", "Measurement", "Rates", "Scalar"]
