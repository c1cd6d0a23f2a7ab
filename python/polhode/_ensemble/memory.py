"""The memory of worker processes that others start."""

from __future__ import annotations

import ctypes
import os
from functools import cache

M_TRIM_THRESHOLD, M_MMAP_THRESHOLD = -1, -3   # of glibc's malloc.h
RESERVED = 2**30


@cache
def keep() -> bool:
    """Let glibc keep freed memory which Dask's nanny sets to return it. Return True if that was needed.

    Nannies start workers with MALLOC_TRIM_THRESHOLD_=65536. Every array is then mapped anew, page by page, which
    doubles the time of a chunk. Both thresholds must be raised: setting one stops glibc from adapting the other.
    """
    if "MALLOC_TRIM_THRESHOLD_" not in os.environ or "MALLOC_MMAP_THRESHOLD_" in os.environ:
        return False
    if os.name != "posix":   # CDLL(None) is the process itself on POSIX alone
        return False
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)
    if mallopt is None:
        return False
    return bool(mallopt(M_TRIM_THRESHOLD, RESERVED) and mallopt(M_MMAP_THRESHOLD, RESERVED))
