"""The result of `polhode.judge`."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from .._core import InvalidInput
from .codes import LEVELS
from .findings import Finding, plain
from .states import Array

if TYPE_CHECKING:
    import os

    import matplotlib.figure

    from .name import Verdict


@dataclasses.dataclass(frozen=True, eq=False)
class Deviation:
    """How far samples are from the motion of the stated body with the best start.

    `attitude` is the largest rotation [rad], `omega` the largest difference of the rates [rad/s]; with `_rms` the roots
    of their mean squares. None stands for a channel that was not given.
    """

    attitude: float | None = None
    omega: float | None = None
    attitude_rms: float | None = None
    omega_rms: float | None = None


@dataclasses.dataclass(frozen=True, eq=False)
class Repaired:
    """Samples with faults of conventions and data undone: in polhode's conventions."""

    t: Array
    attitude: Array | None
    omega: Array | None


@dataclasses.dataclass(frozen=True, eq=False)
class Judgement:
    """What is wrong with a motion.

    Attributes
    ----------
    findings : tuple of Finding
        The main cause first: conventions, then by level, then by effect.
    deviation : Deviation
        From the motion of the stated body, in segments of `segment` samples where the whole cannot be followed.
    untold : tuple of str
        What these data cannot tell.
    repaired : Repaired
        Samples with faults of conventions and data undone.
    start : tuple of ndarray, or None
        Rates and attitude of the fitted motion at the first sample.
    noise : Deviation
        What remains after the named cause.
    ranking : tuple of (str, float)
        Causes with their gains over the start alone, in nats.
    residual : dict
        Times, and data less motion: `omega` relative to the rms of the rates, `attitude` in body axes [rad].
    samples, turns : int, float
    """

    findings: tuple[Finding, ...]
    deviation: Deviation
    untold: tuple[str, ...]
    repaired: Repaired
    start: tuple[Array, Array] | None
    noise: Deviation
    ranking: tuple[tuple[str, float], ...]
    residual: dict[str, Array]
    samples: int
    turns: float
    segment: int = 0
    verdict: Verdict | None = None

    @property
    def level(self) -> str:
        """The worst level: "error", "warning", "remark", or "" without findings."""
        return max((f.level for f in self.findings), key=LEVELS.index, default="")

    @property
    def fine(self) -> bool:
        """True without errors and warnings."""
        return not self.fails("warning")

    def fails(self, level: str = "warning") -> bool:
        """Return True if a finding has this level or a worse one."""
        if not (isinstance(level, str) and level in LEVELS):
            raise InvalidInput(f"level: must be error, warning or remark, got {level!r}")
        return any(LEVELS.index(f.level) >= LEVELS.index(level) for f in self.findings)

    def line(self) -> str:
        """Return the verdict in one line."""
        head = f"{self.samples} samples, {self.turns:.2g} turns: "
        main = [f for f in self.findings if f.level != "remark"]
        if main:
            return head + str(main[0])
        size = self.deviation
        parts = [
            f"{value:.2g} {unit}"
            for value, unit in ((size.attitude, "rad"), (size.omega, "rad/s"))
            if value is not None
        ]
        return head + "nothing wrong" + (", deviates " + " and ".join(parts) if parts else "")

    def to_dict(self) -> dict[str, Any]:
        """Return the judgement as a dict for JSON."""
        return {
            "fine": self.fine,
            "level": self.level,
            "findings": [f.to_dict() for f in self.findings],
            "deviation": plain(dataclasses.asdict(self.deviation)),
            "noise": plain(dataclasses.asdict(self.noise)),
            "untold": list(self.untold),
            "samples": self.samples,
            "turns": plain(self.turns),
            "segment": self.segment,
            "start": plain(self.start) and dict(zip(("omega", "attitude"), plain(self.start))),
            "ranking": [{"cause": cause, "gain": plain(gain)} for cause, gain in self.ranking],
        }

    def plot(self, path: str | os.PathLike[str] | None = None) -> matplotlib.figure.Figure:
        """Draw deviation, residual and ranking, with a table of findings; write the picture to a file, if one is named.

        Parameters
        ----------
        path : str or PathLike, optional
            .png, .svg or .pdf.

        Returns
        -------
        matplotlib.figure.Figure
        """
        from .picture import draw

        return draw(self, path)

    def __str__(self) -> str:
        return "\n".join(
            [self.line(), *(f"  {finding}" for finding in self.findings), *(f"  untold: {u}" for u in self.untold)]
        )

    __repr__ = __str__
