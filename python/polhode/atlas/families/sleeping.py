"""(k) The sleeping top: spun just fast enough to stand, or just not."""

from __future__ import annotations

from collections.abc import Iterator

from .. import critical, scenes
from ..critical import judge
from ..entrants import Entrant
from ..family import Family, Point


def measure(entrant: Entrant, quick: bool, limit: float) -> Iterator[Point]:
    """The greatest tilt within 200 s on both sides of the critical rate."""
    return critical.measure(entrant, "sleeping", scenes.SLEEPING, scenes.sleeping, scenes.tilt, quick, limit)


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
