"""Numbers as pictures and tables show them."""

from __future__ import annotations

import math


def to_time(seconds: float) -> str:
    """Three digits with a unit that fits: 0.000246 -> '246 µs'."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= 0.9995 * size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def to_error(error: float) -> str:
    """One digit: 2e-5, and 0.2 rather than 2e-1."""
    if not math.isfinite(error) or error == 0:
        return f"{error:g}"
    if error >= 0.1:
        return f"{error:.1g}" if error < 1 else f"{error:.2g}"
    mantissa, _, exponent = f"{error:.0e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def to_count(number: float) -> str:
    """1234567 -> '1.2 million'; 65432 -> '65 thousand'."""
    for word, size in (("million", 1e6), ("thousand", 1e3)):
        if number >= 9.95 * size or (size == 1e6 and number >= size):
            return f"{number / size:.2g} {word}"
    return f"{number:.0f}"
