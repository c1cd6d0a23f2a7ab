"""(l) The wheel on the intermediate axis: spun just fast enough to keep the turn about it, or just not."""

from __future__ import annotations

from collections.abc import Iterator

from .. import critical, scenes
from ..critical import judge
from ..entrants import Entrant
from ..family import Family, Point


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The greatest angle between the wheel's axis and the momentum within 200 s, about the critical speed."""
    return critical.measure(entrant, "wheel", scenes.WHEEL, scenes.wheel, scenes.lean, quick, limit)


FAMILY = Family(
    name="wheel", title="The wheel near its critical speed: kept, or just left",
    summary="critical\nwheel",
    sweeps="the wheel's excess s over the critical momentum, 0.1 to -0.1, off by 1e-6 rad at the start, 200 s",
    truth="113-bit Taylor series",
    holds="the greatest angle within a relative 1e-3 for every s",
    degrades="the turn is kept and left as it should be for |s| >= 1e-3",
    number="largest relative error of the angle, or what goes wrong",
    about="A wheel on the intermediate axis makes the turn about it stable, if its momentum exceeds (I3 - I2) omega. "
          "Slightly below, two new steady turns branch off, and the body swings about one of them. A method's own "
          "error acts like a torque and shifts the critical speed, so it may lose the branch.",
    measure=measure, judge=judge, cost=10, x_label="excess over the critical momentum", x_inverted=True,
    x_scale="list", y="tilt", y_label="greatest angle within 200 s [rad]", y_limits=(3e-7, 10.0),
)
