"""The report: charts, atlas, pictures and tables as one web page that opens from disk.

`report(folder)` measures and writes. `page`, `curves` and `tables` make the page from the results.
"""

from __future__ import annotations

from .report import report as report

__all__ = ["report"]
