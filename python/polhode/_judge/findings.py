"""The results of a judgement."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from .codes import BY_CAUSE, CONVENTIONS, LEVELS


@dataclasses.dataclass(frozen=True, eq=False)
class Finding:
    """One fault of a motion, or a remark.

    Attributes
    ----------
    cause : str
        One of the fixed words of `docs/codes`, such as "clock" or "scalar order".
    text : str
        The finding in words, with its numbers.
    code, level : str
        "PJ105" and so on; "error", "warning" or "remark".
    size : float, tuple of float, or None
        How large the fault is, in `unit`.
    sigma : float, tuple of float, or None
        The standard error of the size.
    effect : float
        What the fault leaves of the data after the best start: rms of the rotation [rad], or of the rates relative to
        theirs.
    explained : float
        The part of the square of that which the cause explains.
    margin : float
        By how many nats the cause leads all others; inf where nothing competes.
    rivals : tuple of str
        Causes that explain the data as well, or nearly so.
    where : tuple of int
        Numbers of samples.
    evidence : dict
        Numbers behind the finding.
    cure : str
        What to do.
    order, step, method
        Of an integrator: its order, its step [s], and the method that it is most like.
    """

    cause: str
    text: str
    size: Any = None
    sigma: Any = None
    effect: float = 0.0
    explained: float = 1.0
    margin: float = float("inf")
    rivals: tuple[str, ...] = ()
    where: tuple[int, ...] = ()
    evidence: dict[str, Any] = dataclasses.field(default_factory=dict)
    cure: str = ""
    level: str = ""
    code: str = ""
    unit: str = ""
    order: int | None = None
    step: float | None = None
    method: str | None = None

    def __post_init__(self) -> None:
        known = BY_CAUSE[self.cause]
        for name, value in (("code", known.name), ("level", known.level), ("unit", known.unit)):
            if not getattr(self, name):
                object.__setattr__(self, name, value)

    def __str__(self) -> str:
        return f"{self.level.upper()} {self.cause}: {self.text} [{self.code}]"

    def to_dict(self) -> dict[str, Any]:
        """Return the finding as a dict for JSON."""
        return {key: plain(value) for key, value in dataclasses.asdict(self).items()}


def plain(value: Any) -> Any:
    """Return numbers and lists that JSON has; NaN and inf become None."""
    if isinstance(value, dict):
        return {str(k): plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(v) for v in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, (float, np.floating)):
        return float(value) if np.isfinite(value) else None
    return int(value) if isinstance(value, np.integer) else value


def ordered(findings: list[Finding]) -> tuple[Finding, ...]:
    """Return findings with the main cause first: conventions, then by level, then by effect."""

    def place(finding: Finding) -> tuple[bool, int, float]:
        last = finding.level == "remark"
        return last or finding.cause not in CONVENTIONS, -LEVELS.index(finding.level), -finding.effect

    return tuple(sorted(findings, key=place))
