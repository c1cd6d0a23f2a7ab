"""The families of failures: one file and one line each."""

from __future__ import annotations

from ..family import Family
from . import chaos, damping, gimbal, long, near, norm, racket, scales, sleeping, spin_up, step, wheel

FAMILIES: tuple[Family, ...] = tuple(
    module.FAMILY
    for module in (
        step,
        racket,
        gimbal,
        long,
        damping,
        spin_up,
        chaos,
        near,
        scales,
        norm,
        sleeping,
        wheel,
    )
)
