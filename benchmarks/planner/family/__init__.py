"""Random scenes of many kinds, and their truth from outside. `draw(seed, kind, index)` is always the same scene."""

from .draw import KINDS, Drawn, draw, write_python
from .error import compute_error
from .truth import Known, compute_truth, missing

__all__ = ["KINDS", "Drawn", "Known", "compute_error", "compute_truth", "draw", "missing", "write_python"]
