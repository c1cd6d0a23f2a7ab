"""(k) The sleeping top: spun just fast enough to stand, or just not."""

from __future__ import annotations

from collections.abc import Iterator

from .. import scenes
from ..case import stored, turn_of
from ..entrants import PER_TURN, Entrant
from ..family import Family, Point, Verdict, answered, nobody, to_short
from ..run import run


SURE = 1e-3      # beyond this excess, either way, there is no doubt
FALLEN = 1e-3    # rad: between the tilt of the tops that stand and of those that fall


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The greatest tilt within 200 s on both sides of the critical rate."""
    true = stored("sleeping")
    for index, excess in enumerate(scenes.SLEEPING):
        if quick and index % 2:
            continue
        case = scenes.sleeping(excess)
        point = Point(excess)
        with point.trying():
            motion = run(entrant, case.scene, entrant.setting(step=turn_of(case.scene) / PER_TURN), limit)
            assert motion.attitude is not None
            point.values["tilt"] = float(scenes.tilt(motion.attitude).max())
            point.values["true"] = float(true[index])
            point.values["off"] = abs(point.values["tilt"] / true[index] - 1)
        yield point
        if point.status in ("refused", "left out"):
            return


def judge(points: list[Point]) -> Verdict:
    """By the greatest tilt against the true one, and by the side of the critical rate."""
    if (none := nobody(points)) is not None:
        return none
    tried = answered(points)
    off = max(p.get("off") for p in tried)
    if off <= 1e-3:
        return Verdict("holds", to_short(off), off)
    wrong = [p for p in tried if p.status == "failed" or (abs(p.x) >= SURE and (p.get("tilt") > FALLEN) != (p.x < 0))]
    if not wrong:
        return Verdict("degrades", "right side", off)
    first = min(wrong, key=lambda p: -abs(p.x))
    text = "falls" if first.x > 0 else "stays up"
    return Verdict("fails", "burst" if first.status == "failed" else text, off, first.why or f"at s = {first.x:g}")


FAMILY = Family(
    name="sleeping", title="The sleeping top: it stands, or just falls", summary="sleeping\ntop",
    sweeps="the rate's excess s over the critical one, 0.1 to -0.1, tilted by 1e-6 rad at the start, 200 s",
    truth="113-bit Taylor series",
    holds="the greatest tilt within a relative 1e-3 for every s",
    degrades="it stands and falls as it should for |s| >= 1e-3",
    number="largest relative error of the tilt, or what goes wrong",
    about="A top spun slightly faster than the critical rate stands upright. Slightly slower, it falls, however "
          "small the difference. A method's own error acts like a torque and shifts the critical rate. It may "
          "let a sleeping top fall, or keep a falling top up.",
    measure=measure, judge=judge, cost=61, x_label="excess over the critical rate", x_inverted=True, x_scale="list",
    y="tilt", y_label="greatest tilt within 200 s [rad]", y_limits=(3e-7, 10.0),
)
