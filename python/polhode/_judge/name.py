"""Which cause is named: the best score with its margin, or several that the data cannot tell apart, or none."""

from __future__ import annotations

import dataclasses

import numpy as np

from .causes import Scope, catalogue, pattern, slopes
from .law import Law
from .laws import longest
from .refine import refine
from .score import Numbers, Score, rank
from .shooting import Data, Track, basis, carry, fit, weighted
from .states import Array

GAIN, MARGIN, LEFT, REFINED = 15.0, 8.0, 0.35, 6
ROUNDING, TRIALS = 3e-15, 4
DIGIT = 1.7  # the step of the last digit over the floor that it sets
# What the errors of a method may look like, and which part of them stays as a pattern then.
IMITATED, PATTERN = ("lag", "clock", "units of rates", "inertia", "damping", "kinematics"), 0.005
# An unknown method of a high order looks like one of a low order with many steps in a sample; one of the same order
# looks like it with as many steps as it has.
NEAR_STEPS = 4
# Causes that are one and the same for some motions; the first is named, the other stands in its rivals.
EQUIVALENT = {("clock", "units of rates"), ("lag", "kinematics")}


@dataclasses.dataclass(eq=False)
class Verdict:
    """What the scores of one motion along the data say.

    `kind` is "fine", "named", "cannot tell" or "unexplained". `before` and `after` are rms of the leading channel.
    """

    kind: str
    track: Track
    ranking: list[Score]
    best: Score | None = None
    rivals: tuple[str, ...] = ()
    margin: float = np.inf
    before: float = 0.0
    after: float = 0.0
    alone: Numbers = ()  # rms of each channel with the best start alone
    floor: Numbers = ()  # below which nothing shows
    whole: float = 0.0  # `before` in the longest segments, where shorter ones decided

    @property
    def explained(self) -> float:
        return 1 - (self.after / self.before) ** 2 if self.before else 1.0


def whiteness(rest: Array) -> float:
    """Return von Neumann's ratio of residuals (n, 3), 1 for white noise and near 0 for a smooth curve.

    J. von Neumann, Ann. Math. Statist. 12 (1941) 367.
    """
    power = float(np.sum(rest * rest))
    return float(np.sum(np.diff(rest, axis=0) ** 2)) / (2 * power) if power else 1.0


def raised(track: Track, floor: Numbers) -> Numbers:
    """Return the floor of each channel, at least what the motion makes of the rounding of its steps."""
    segments, length = track.index.shape
    sizes = np.array([track.data.scale] * 3 + [1.0] * 3)[:, None]
    steps = ROUNDING * sizes * np.random.default_rng(0).normal(size=(segments, length - 1, 6, TRIALS))
    grown = weighted(track, np.concatenate([track.carried, carry(track.phi, steps)], axis=3))
    u, rest = basis(grown[..., :6])[0], grown[..., 6:]
    rest = (rest - u @ (np.swapaxes(u, 1, 2) @ rest)).reshape(segments, -1, length * 3, TRIALS)
    count = int(track.new.sum()) * 3 * TRIALS
    made = [float(np.sqrt(np.sum(part * part) / count)) for part in np.moveaxis(rest, 1, 0)]
    return tuple(max(low, size) for low, size in zip(floor, made, strict=True))


def weigh(track: Track, floor: Numbers, sigma: Numbers | None, known: bool) -> Verdict:
    """Score all causes along one motion, refine the best, and say what the numbers allow."""
    floor = raised(track, floor)
    scope = Scope(track)
    scores = rank(scope, list(catalogue(track, known)), floor, sigma)
    none, rest = scores[0], scores[1:]
    before, low = np.sqrt(3 * np.array(none.rest)), np.array(floor)
    if np.all(before < DIGIT * low):
        return Verdict("fine", track, rest, floor=floor)
    hopeful = [s for s in rest[:REFINED] if s.gain > 0.5 * GAIN]
    exact = [refine(scope, s, floor, sigma) for s in hopeful]
    for score in exact:
        score.gain = score.likelihood - none.likelihood
    ranking = sorted([*exact, *[s for s in rest if s not in hopeful]], key=lambda s: -s.gain)
    if not ranking or ranking[0].gain < GAIN:
        return Verdict("fine", track, ranking, floor=floor)
    best, rivals, margin = _leader(ranking)
    after = np.sqrt(3 * np.array(best.rest))
    alone = tuple(map(float, before))
    lead = int(np.argmax(np.hypot(before, low) / np.hypot(after, low)))  # the channel that the cause explains
    if before[lead] < DIGIT * low[lead]:  # a constant that the file rounds is a bias, and no fault
        return Verdict("fine", track, ranking, floor=floor)
    verdict = Verdict("named", track, ranking, best, rivals, margin, alone[lead], float(after[lead]), alone, floor)
    if not all(_explains(best, track, k, before[k], after[k], low[k]) for k in {lead, int(np.argmax(before))}):
        verdict.kind = "unexplained"
    elif margin < MARGIN and not _equivalent(best, rivals):
        verdict.kind = "cannot tell"
    elif not _leaves_a_pattern(best, track, lead, alone[lead], float(after[lead]), floor[lead]):
        pass
    elif best.held > NEAR_STEPS:
        verdict.kind = "unexplained"
    elif best.cause is not None and best.cause.name in IMITATED:
        verdict.kind, verdict.rivals = "cannot tell", tuple(dict.fromkeys((*rivals, "integrator")))
    return verdict


def _leaves_a_pattern(best: Score, track: Track, channel: int, before: float, after: float, floor: float) -> bool:
    """Return True if a cause leaves more than a small part, and not as noise: another method may be at work."""
    if after < max(PATTERN * before, 30 * floor):
        return False
    shown = best.track or track
    return whiteness(shown.flat(shown.residual)[:, track.data.channels[channel][0]]) < 0.1


def _explains(best: Score, track: Track, channel: int, before: float, after: float, floor: float) -> bool:
    """Return True if a cause leaves little of a channel, or white noise."""
    if after < LEFT * before or after < 3 * floor:
        return True
    shown = best.track
    return shown is not None and whiteness(shown.flat(shown.residual)[:, track.data.channels[channel][0]]) > 0.5


def _leader(ranking: list[Score]) -> tuple[Score, tuple[str, ...], float]:
    """Return the best score, the names of its rivals, and its lead over other causes in nats."""
    best = ranking[0]
    near = [s for s in ranking if best.gain - s.gain < MARGIN]
    for first, second in EQUIVALENT:
        names = {s.cause.name for s in near if s.cause}
        if best.cause and best.cause.name == second and first in names:
            best = next(s for s in near if s.cause and s.cause.name == first)
    assert best.cause is not None
    rivals: dict[str, None] = {}
    margin = np.inf
    for score in ranking:
        if score.cause and score.cause.name != best.cause.name:
            lead = best.gain - score.gain
            if (best.cause.name, score.cause.name) not in EQUIVALENT or lead > MARGIN:
                margin = min(margin, lead)
            if lead < MARGIN:
                rivals[score.cause.name] = None
    return best, tuple(rivals), float(margin)


def _equivalent(best: Score, rivals: tuple[str, ...]) -> bool:
    assert best.cause is not None
    return all((best.cause.name, rival) in EQUIVALENT for rival in rivals)


def decide(
    data: Data, law: Law, floor: Numbers, sigma: Numbers | None, known: bool, track: Track | None = None
) -> Verdict:
    """Name the cause of what the motion leaves, in shorter segments where the fault is too large for long ones."""
    track = track or longest(data, law)
    first = verdict = weigh(track, floor, sigma, known)
    for _ in range(2):
        if verdict.kind != "unexplained" or track.length <= 8:
            break
        track = fit(data, law, track.length // 2)
        verdict = dataclasses.replace(weigh(track, floor, sigma, known), whole=first.before)
        if verdict.kind == "fine":
            break
    return first if verdict.kind in ("fine", "unexplained") else verdict


def second(verdict: Verdict, floor: Numbers, sigma: Numbers | None, known: bool) -> Verdict | None:
    """Return what is wrong beside a named cause, at first order about the motion with that cause, or None."""
    first = verdict.best
    if first is None or first.cause is None or first.track is None or not first.refined:
        return None
    track, own = first.track, first.cause
    rest = np.sqrt(np.array(first.rest) * 3)
    if np.all(rest < 5 * np.array(floor)):
        return None
    scope = Scope(track)
    push, show = slopes(own, scope, first.c) if not own.substeps else pattern(own, scope)
    nuisance = carry(track.phi, push) + show
    causes = [c for c in catalogue(track, known) if c.name != own.name and (own.name, c.name) not in EQUIVALENT]
    none, *others = rank(scope, causes, floor, sigma, nuisance)
    if not others or others[0].gain < 2 * GAIN:
        return None
    best, rivals, margin = _leader(others)
    lead = int(np.argmax(none.rest))
    before, after = float(np.sqrt(none.rest[lead] * 3)), float(np.sqrt(best.rest[lead] * 3))
    if margin < MARGIN or after > LEFT * before or before < 5 * floor[lead]:
        return None
    return Verdict("named", track, others, best, rivals, margin, before, after)
