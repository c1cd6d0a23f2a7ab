"""The report: charts, atlas, pictures and tables as one web page that opens from disk, made by one command.

`report(folder)` measures and writes; `page`, `curves` and `tables` turn what was measured into the page, and take every
number in it from there.
"""

from __future__ import annotations

from .report import report as report

__all__ = ["report"]
