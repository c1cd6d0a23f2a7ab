"""The formats of robot descriptions: a module each, and a line here."""

from __future__ import annotations

from . import mjcf, sdf, urdf

FORMATS = {format.name: format for format in (urdf.FORMAT, mjcf.FORMAT, sdf.FORMAT)}
SHARED = (".xml", ".world")   # other files have them too: the root decides
SUFFIXES = (*(suffix for format in FORMATS.values() for suffix in format.suffixes), ".xml", ".xacro", ".world")
ROOTS = {root: format for format in FORMATS.values() for root in (*format.roots, *format.parts)}
NAMES = ", ".join(FORMATS)
