"""Robot descriptions: checks of the links of URDF, MJCF and SDF files, alone and against their geometry."""

from __future__ import annotations

from .formats import SUFFIXES as suffixes
from .ignore import Rule
from .link import Link, Robot
from .paths import Search
from .reading import read
from .repair import repair
from .report import LinkReport, Report, check

__all__ = ["Link", "LinkReport", "Report", "Robot", "Rule", "Search", "check", "read", "repair", "suffixes"]
