"""What families about a critical speed share: a greatest tilt, and on which side of the speed a motion is."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from .case import Case, stored, turn_of
from .entrants import PER_TURN, Entrant
from .family import Point, Verdict, judge_no_answer, to_short, tried_points
from .run import run

SURE = 1e-3      # beyond this excess, either way, there is no doubt
FALLEN = 1e-3    # rad: between the tilt of motions that stand and of those that fall


def measure(entrant: Entrant, name: str, excesses: Sequence[float], make: Callable[[float], Case],
            tilt: Callable[[npt.NDArray[np.float64]], npt.NDArray[np.float64]], quick: bool,
            limit: float) -> Iterator[Point]:
    """The greatest tilt over the span on both sides of the critical speed, against the stored ones."""
    true = stored(name)
    for index, excess in enumerate(excesses):
        if quick and index % 2:
            continue
        case = make(excess)
        point = Point(excess)
        with point.trying():
            motion = run(entrant, case.scene, entrant.setting(step=turn_of(case.scene) / PER_TURN), limit)
            assert motion.attitude is not None
            point.values["tilt"] = float(tilt(motion.attitude).max())
            point.values["true"] = float(true[index])
            point.values["off"] = abs(point.values["tilt"] / true[index] - 1)
        yield point
        if point.status in ("refused", "left out"):
            return


def judge(points: list[Point]) -> Verdict:
    """By the greatest tilt against the true one, and by the side of the critical speed."""
    if (none := judge_no_answer(points)) is not None:
        return none
    tried = tried_points(points)
    off = max(p.get("off") for p in tried)
    if off <= 1e-3:
        return Verdict("holds", to_short(off), off)
    wrong = [p for p in tried if p.status == "failed" or (abs(p.x) >= SURE and (p.get("tilt") > FALLEN) != (p.x < 0))]
    if not wrong:
        return Verdict("degrades", "right side", off)
    first = min(wrong, key=lambda p: -abs(p.x))
    text = "falls" if first.x > 0 else "stays up"
    return Verdict("fails", "burst" if first.status == "failed" else text, off, first.why or f"at s = {first.x:g}")
