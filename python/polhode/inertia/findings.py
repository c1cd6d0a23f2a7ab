"""The results of a diagnosis."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from .codes import code_of

Array = npt.NDArray[np.float64]

IMPOSSIBLE = ("finite", "symmetric", "positive", "triangle", "mass")


@dataclasses.dataclass(frozen=True, eq=False)
class Finding:
    """One error in inertia data.

    Attributes
    ----------
    what : str
        The violated condition. Impossible for any body: "finite", "symmetric", "positive", "triangle", "mass". Unlikely
        for this body: "extent", "density", "size", "geometry". Of links also "unreadable", "massless", "marker".
    per_cent : float
        The size of the violation, relative to the quantity in `text`.
    text : str
        The violated condition in words, with its numbers.
    cause : str
        "sign", "order", "point", "units", "axes", "decimal", "rounding", "triangle of zeros", "placeholder" or
        "unknown". Of links also "density", "floor", "formula", "massless", "marker", "identified", "text".
    advice : str
        The likely cause in words, and the correction.
    matrix : ndarray, shape (3, 3), or None
        The corrected tensor, about the same point in the same axes [kg m^2].
    mass, com
        The corrected mass [kg] and centre of mass [m], if they were given.
    level : str
        "error": no body can have this. "warning": unlikely for this body. "remark": useful to know, and no fault.
    code : str
        "PI001" and so on. It stays the same in all versions; `docs/codes/` has a page for each.
    """

    what: str
    per_cent: float
    text: str
    cause: str
    advice: str
    matrix: Array | None = None
    mass: float | None = None
    com: Array | None = None
    level: str = ""
    code: str = ""

    def __post_init__(self) -> None:
        if not self.code:
            code = code_of(self.what, self.cause)
            object.__setattr__(self, "code", code.name)
            object.__setattr__(self, "level", code.level)

    @property
    def impossible(self) -> bool:
        """True if no body can have this error; False if it is only unlikely for this body."""
        return self.what in IMPOSSIBLE

    def __str__(self) -> str:
        return f"{self.text}: {self.advice}"

    def to_dict(self) -> dict[str, Any]:
        """Return the finding as a dict for JSON."""
        content = dataclasses.asdict(self)
        return {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in content.items()}


@dataclasses.dataclass(frozen=True, eq=False)
class Diagnosis:
    """The findings about inertia data.

    Attributes
    ----------
    findings : tuple of Finding
        The worst first; empty if there are none.
    margin : float
        The margin of the triangle inequality, as a part of the largest moment; negative if violated.
    misfit : float or None
        The largest difference from a uniform body with the geometry and the mass; None without a geometry. Differences
        are relative to the largest moment, those of the centre of mass to the radius of gyration. Real links are not
        uniform, so it is not zero.
    """

    findings: tuple[Finding, ...]
    margin: float
    misfit: float | None = None

    @property
    def fine(self) -> bool:
        """True if there are no findings."""
        return not self.findings

    @property
    def verdict(self) -> str:
        """The findings in one line."""
        if self.findings:
            return "; ".join(str(finding) for finding in self.findings)
        text = f"fine: the triangle inequality holds by {100 * self.margin:.3g} % of the largest moment"
        if self.misfit is not None:
            text += f"; {100 * self.misfit:.2g} % from a uniform body of its geometry"
        return text

    def _repr_html_(self) -> str:
        from .._plot.html import of_diagnosis

        return of_diagnosis(self)

    def __str__(self) -> str:
        return self.verdict
