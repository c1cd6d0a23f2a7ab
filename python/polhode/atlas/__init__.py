"""Where methods fail: families of hard problems, with a truth, a threshold and a verdict for each method.

`atlas(families, folder)` measures, draws and writes; `FAMILIES` is the list.
"""

from .atlas import atlas as atlas
from .families import FAMILIES as FAMILIES

__all__ = ["FAMILIES", "atlas"]
