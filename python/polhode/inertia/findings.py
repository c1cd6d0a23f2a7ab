"""What a diagnosis says."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

IMPOSSIBLE = ("finite", "symmetric", "positive", "triangle", "mass")


@dataclasses.dataclass(frozen=True, eq=False)
class Finding:
    """One thing that is wrong.

    Attributes
    ----------
    what : str
        What is broken. What no body can have: "finite", "symmetric", "positive", "triangle", "mass"; what this body
        should not have: "extent", "density", "size", "geometry".
    per_cent : float
        By how much, of what `text` says.
    text : str
        What is broken, in words, with its numbers.
    cause : str
        "sign", "order", "point", "units", "axes", "decimal", "rounding", "triangle of zeros", "placeholder" or
        "unknown".
    advice : str
        The likely cause in words, and what to do.
    matrix : ndarray, shape (3, 3), or None
        The repaired tensor, about the same point in the same axes [kg m^2].
    mass, com
        The repaired mass [kg] and centre of mass [m], where they were given.
    """

    what: str
    per_cent: float
    text: str
    cause: str
    advice: str
    matrix: Array | None = None
    mass: float | None = None
    com: Array | None = None

    @property
    def impossible(self) -> bool:
        """No body has it; else it is only unlikely for this one."""
        return self.what in IMPOSSIBLE

    def __str__(self) -> str:
        return f"{self.text}: {self.advice}"

    def to_dict(self) -> dict[str, Any]:
        """Plain Python, as for JSON."""
        content = dataclasses.asdict(self)
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in content.items()}


@dataclasses.dataclass(frozen=True, eq=False)
class Diagnosis:
    """What was found.

    Attributes
    ----------
    findings : tuple of Finding
        The worst first; empty when fine.
    margin : float
        What is left to the triangle inequality, as a part of the largest moment; negative beyond it.
    misfit : float or None
        Largest difference from a uniform body of the geometry and the same mass, as a part of its largest moment or, of
        the centre of mass, of the radius of gyration; None without a geometry. Real links have some: their mass is not
        even.
    """

    findings: tuple[Finding, ...]
    margin: float
    misfit: float | None = None

    @property
    def fine(self) -> bool:
        """Nothing was found."""
        return not self.findings

    @property
    def verdict(self) -> str:
        """One line."""
        if self.findings:
            return "; ".join(str(finding) for finding in self.findings)
        text = f"fine: {100 * self.margin:.3g} % of the largest moment left to the triangle inequality"
        if self.misfit is not None:
            text += f"; {100 * self.misfit:.2g} % from a uniform body of its geometry"
        return text

    def __str__(self) -> str:
        return self.verdict
