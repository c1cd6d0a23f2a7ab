"""All links of one file together: what one link shows about the others."""

from __future__ import annotations

import collections

import numpy as np

from ..findings import Diagnosis
from .causes import tally
from .judgement import Case, conclude, study
from .link import Link, Robot

IDENTIFIED = 0.3    # of the links with geometry are unlike it, one by one
FEWEST = 3


def judge(robot: Robot) -> list[tuple[Link, Diagnosis | None]]:
    """Judge all links of a robot; None for a link without numbers."""
    cases = [study(link) for link in robot.links]
    studied = [case for case in cases if case is not None]
    _count_copies(studied)
    support = tally([case.possible for case in studied])
    unlike = [case for case in studied if case.broken and not case.settled and case.known.quality in ("body", "hull")
              and _has_products(case) and conclude(case, support).findings
              and all(f.cause == "unknown" for f in conclude(case, support).findings)]
    comparable = [case for case in studied if case.known.quality in ("body", "hull")]
    if len(unlike) >= FEWEST and len(unlike) >= IDENTIFIED * len(comparable):
        for case in unlike:
            case.known.identified = True
    found = {id(case.link): conclude(case, support) for case in studied}
    return [(link, found.get(id(link))) for link in robot.links]


def _has_products(case: Case) -> bool:
    """Return whether all six numbers of a tensor are there: of those who write by hand, few fill in the products."""
    assert case.link.matrix is not None
    return bool(case.link.matrix[np.triu_indices(3, 1)].all())


def _count_copies(cases: list[Case]) -> None:
    """Count the links of other form that have the same mass and tensor."""
    groups: dict[tuple[object, ...], list[Case]] = collections.defaultdict(list)
    for case in cases:
        if case.settled is None and case.link.matrix is not None:
            groups[(case.link.mass, case.link.matrix.tobytes())].append(case)
    for same in groups.values():
        if len(same) < FEWEST:
            continue
        forms = [None if case.known.geometry.box is None else np.sort(np.ptp(case.known.geometry.box, axis=0))
                 for case in same]
        for case, form in zip(same, forms):
            others = [] if form is None else [f for f in forms if f is not None
                                              and np.abs(f - form).max() > 0.2 * form.max()]
            case.known.copies = len(others) + 1 if others else 0
