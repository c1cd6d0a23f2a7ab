"""Stable codes of findings, each with its level."""

from __future__ import annotations

from typing import NamedTuple

LEVELS = ("remark", "warning", "error")


class Code(NamedTuple):
    """A kind of finding: its name, its level, and what it says in a few words."""

    name: str
    level: str
    title: str


CODES = {code.name: code for code in (
    Code("PI001", "error", "a number that is not finite"),
    Code("PI002", "error", "numbers that cannot be read"),
    Code("PI003", "error", "a mass that is negative, or zero beside a tensor"),
    Code("PI004", "error", "a negative moment"),
    Code("PI005", "error", "the triangle inequality is broken"),
    Code("PI006", "error", "mass and geometry beyond any density"),
    Code("PI007", "error", "a tensor that is not symmetric"),
    Code("PI101", "warning", "the triangle inequality is missed by rounding"),
    Code("PI102", "warning", "moments larger than the geometry allows"),
    Code("PI103", "warning", "the centre of mass lies outside the geometry"),
    Code("PI104", "warning", "moments far from those of a uniform body"),
    Code("PI105", "warning", "an unlikely density"),
    Code("PI106", "warning", "a slip explains the difference from the geometry"),
    Code("PI201", "remark", "massless: a frame"),
    Code("PI202", "remark", "a mass without moments"),
    Code("PI203", "remark", "placeholder numbers"),
    Code("PI204", "remark", "identified parameters"),
    Code("PI205", "remark", "geometry that does not stand for the body"),
    Code("PI206", "remark", "lighter than any solid"),
)}

_BY_WHAT = {"finite": "PI001", "unreadable": "PI002", "mass": "PI003", "positive": "PI004", "triangle": "PI005",
            "symmetric": "PI007", "extent": "PI102", "outside": "PI103", "size": "PI104", "density": "PI105",
            "geometry": "PI106", "massless": "PI201", "marker": "PI205"}


def code_of(what: str, cause: str) -> Code:
    """Return the code of a violated condition with this cause."""
    if what == "triangle" and cause == "rounding":
        return CODES["PI101"]
    return CODES[_BY_WHAT[what]]
