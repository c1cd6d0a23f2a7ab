"""One judgement from read samples to its findings: conventions, gaps, the law, causes, and the start."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np

from .._core import InvalidInput
from .._scene.scene import Scene
from . import conventions, gaps
from .channels import fitted_body, follows, read_again, to_data
from .findings import Finding, ordered
from .judgement import Deviation, Judgement, Repaired
from .law import Law
from .laws import Variant, choose, longest
from .name import Verdict, decide, second, whiteness
from .read import Samples
from .score import Numbers
from .shooting import Data, Track
from .start import check_start
from .states import Array, rms
from .words import invariants, tell, unexplained

MOST, MOST_DRIVEN = 2000, 800
FEWEST, SHORTEST = 8, 0.2  # samples, and turns
GAP = 20.0  # rad
APART, SURE = 0.5, 0.95  # rad between samples; explained of far ones


class Work:
    """One judgement on its way."""

    def __init__(
        self,
        samples: Samples,
        findings: list[Finding],
        body: Array | None,
        scene: Scene | None,
        tolerance: float,
        sigma: Any,
    ) -> None:
        self.samples, self.findings, self.body, self.scene = samples, findings, body, scene
        self.tolerance, self.known = tolerance, body is not None
        self.sigma = None if sigma is None else np.broadcast_to(np.asarray(sigma, float), (2,))
        self.untold: list[str] = []
        self.whole: Data | None = None

    def run(self) -> Judgement:
        samples = self.samples = self._without_gaps(self.samples)
        both = samples.omega is not None and samples.attitude is not None
        rho = 0.0
        if both and len(samples.t) >= 7:
            rho = self._conventions()
        elif samples.space and samples.attitude is None:
            raise InvalidInput("frame: must be 'body' without attitudes, got 'space'")
        conventions.to_body_rates(samples)
        data = to_data(samples)
        speed = np.linalg.norm(data.omega, axis=1)
        turns = float(np.sum(0.5 * (speed[1:] + speed[:-1]) * np.diff(data.t))) / (2 * np.pi)
        if not np.any(data.omega):
            self.untold.append("a body at rest shows its attitude alone")
        elif len(data.t) < FEWEST or turns < SHORTEST:
            self.untold.append(f"{len(data.t)} samples over {turns:.2g} turns are too few for the law of the motion")
        elif rho <= 0.5:
            if not both:
                only = "attitudes" if samples.omega is None else "rates"
                self.untold.append(f"with {only} alone, faults that the other channel would show stay unseen")
            return self._end(self._judge(data, turns), data, turns)
        return self._end(None, data, turns)

    def _without_gaps(self, samples: Samples) -> Samples:
        """Return the longest stretch without a gap of many turns, which no step can be judged across."""
        if samples.omega is None:
            return samples
        reach = np.linalg.norm(samples.omega[1:], axis=1) * np.diff(samples.t)
        ends = np.flatnonzero((reach > GAP) & (reach > 10 * np.median(reach)))
        if not len(ends):
            return samples
        edges = np.concatenate([[0], ends + 1, [len(samples.t)]])
        longest = int(np.argmax(np.diff(edges)))
        first, last = int(edges[longest]), int(edges[longest + 1])
        turns = f"{np.max(reach) / (2 * np.pi):.2g} turns"
        self.untold.append(f"there are gaps of up to {turns}: samples {first} to {last - 1} were judged")
        return samples.take(slice(first, last))

    def _conventions(self) -> float:
        """Undo the conventions, and return what remains. Far samples are compared with the law as declared first."""
        far = self.known and conventions.reach(self.samples) > conventions.FAR
        if far and follows(self.samples, self._law_of(self.body)):
            return 0.0
        return conventions.undo(self.samples, self.findings, self.untold)

    def _law_of(self, matrix: Array | None) -> Law:
        if self.scene is not None:
            return Law.of_scene(self.scene)
        assert matrix is not None
        return Law(matrix)

    def _judge(self, data: Data, turns: float) -> Verdict:
        law = self._law(data)
        if self.known:
            data = gaps.mend(data, law, self.findings)
        most, count = MOST if law.free else MOST_DRIVEN, len(data.t)
        step, said = -(-count // most), (len(self.findings), len(self.untold))
        verdict = self._judge_part(data, step, law, turns)
        near = max(1, int(APART * count / (2 * np.pi * turns)))
        doubtful = verdict.kind != "fine" and verdict.explained < SURE
        if doubtful and near < step:  # noise hides a law between samples that are far apart
            del self.findings[said[0] :], self.untold[said[1] :]
            data = data.take(slice(0, near * most))
            part = turns * len(data.t) / count
            self.untold.append(f"the law was judged over {part:.3g} of {turns:.3g} turns: noise hides it in the rest")
            verdict = self._judge_part(data, near, law, part)
        return verdict

    def _judge_part(self, data: Data, step: int, law: Law, turns: float) -> Verdict:
        """Judge each `step`-th sample."""
        self.whole = data
        data = data.take(slice(None, None, step))
        floor, sigma, track = self._floor(data, turns), self._sigma(data), None
        if self.known:
            variant, track = choose(data, law)
            if not data.has_omega and (again := read_again(data, law, track)) is not None:
                finding, data, track, variant = again
                self.findings.append(finding)
            if variant is not None:
                self._say_law(data, law, variant)
                law = variant.law
        verdict, data = self._without_outliers(data, law, floor, sigma, track)
        evidence = invariants(data, law.matrix)
        if verdict.floor and max(verdict.floor) > 100 * max(floor):
            self.untold.append(f"this motion makes {max(verdict.floor):.1g} of rounding: a smaller fault does not show")
        if verdict.kind in ("named", "cannot tell"):
            self._add(tell(verdict, data, evidence))
        elif verdict.kind == "unexplained":
            self._add(unexplained(verdict, data, evidence))
        else:
            self._nothing(verdict, verdict.floor or floor)
        if (
            verdict.kind == "named"
            and (other := second(verdict, verdict.floor or floor, sigma, self.known)) is not None
        ):
            self._add(tell(other, data, evidence))
        if self.scene is not None and verdict.track.length == len(data.t):
            if (along := _explained(verdict)) is not None:
                start = check_start(along, self.scene, verdict.floor or floor, sigma, verdict.kind == "fine")
                if start is not None:
                    self._add(start)
        return verdict

    def _law(self, data: Data) -> Law:
        if self.body is None:
            self.untold.append(
                "the inertia was fitted: wrong moments, axes and signs of products stay unseen, and its scale"
            )
            self.body = fitted_body(data)
        return self._law_of(self.body)

    def _say_law(self, data: Data, law: Law, variant: Variant) -> None:
        before = float(np.sqrt(np.mean(longest(data, law).deviation() ** 2)))
        same = variant.cause == "gyroscopic sign" and not data.has_attitude
        self.findings.append(
            Finding(
                variant.cause,
                variant.text,
                effect=max(before, 0.1),
                cure=variant.cure,
                rivals=("axis flipped",) if same else (),
                evidence=invariants(data, law.matrix),
            )
        )

    def _without_outliers(
        self, data: Data, law: Law, floor: Numbers, sigma: Numbers | None, track: Track | None
    ) -> tuple[Verdict, Data]:
        """Decide, taking out single samples while these are the main cause: at most 1 %, and one always."""
        removed: list[int] = []
        number, said = np.arange(len(data.t)), None
        while True:
            verdict = decide(data, law, floor, sigma, self.known, track)
            cause = verdict.best.cause if verdict.kind == "named" and verdict.best else None
            if cause is None or cause.name != "outlier" or len(removed) >= max(1, 0.01 * len(number)):
                break
            keep = np.arange(len(data.t)) != cause.sample
            removed.append(int(number[cause.sample]))
            number, data, track, said = number[keep], data.take(keep), None, said or verdict
        if said is not None:
            many = len(removed) > 1
            self.findings.append(
                Finding(
                    "outlier",
                    f"sample{'s' * many} {', '.join(map(str, removed))} {'are' if many else 'is'} off: "
                    f"{said.before:.2g} rms of the deviation with, {said.after:.2g} without",
                    size=len(removed),
                    where=tuple(removed),
                    effect=said.before,
                    explained=said.explained,
                    margin=said.margin,
                    cure="leave the samples out",
                )
            )
        return verdict, data

    def _add(self, finding: Finding) -> None:
        if finding.level == "warning" and finding.effect < self.tolerance:
            finding = dataclasses.replace(finding, level="remark")
        self.findings.append(finding)

    def _floor(self, data: Data, turns: float) -> Numbers:
        low = 3e-13 * max(1.0, turns)
        omega, attitude = self.samples.floor
        both = [max(low, omega / data.scale), max(low, attitude)]
        return tuple(f for f, there in zip(both, (data.has_omega, data.has_attitude), strict=True) if there)

    def _sigma(self, data: Data) -> Numbers | None:
        if self.sigma is None:
            return None
        both = [float(self.sigma[0]) / data.scale, float(self.sigma[1])]
        return tuple(s for s, there in zip(both, (data.has_omega, data.has_attitude), strict=True) if there)

    def _nothing(self, verdict: Verdict, floor: Numbers) -> None:
        rest = verdict.track.deviation()
        for (part, _), low in zip(verdict.track.data.channels, floor, strict=True):
            size = rms(rest[:, part])
            if size < 5 * low:
                continue
            what, unit = ("rates", "of their rms") if part.start == 0 else ("attitudes", "rad")
            white = whiteness(rest[:, part]) > 0.5
            seen = {
                s.cause.key: 3 * float(np.max(s.sigma))
                for s in verdict.ranking
                if s.cause and len(s.sigma) and not s.cause.substeps
            }
            words = "without any pattern" if white else "with a pattern of no known cause"
            self.findings.append(
                Finding(
                    "noise" if white else "small",
                    f"{what} deviate by {size:.2g} {unit}, {words}",
                    size=size,
                    effect=size,
                    evidence={"seen from": seen},
                )
            )

    def _end(self, verdict: Verdict | None, data: Data, turns: float) -> Judgement:
        whole = self.whole or data
        repaired = Repaired(
            whole.t, whole.attitude if data.has_attitude else None, whole.omega if data.has_omega else None
        )
        findings = ordered(
            [
                f if f.level != "warning" or f.effect >= self.tolerance else dataclasses.replace(f, level="remark")
                for f in self.findings
            ]
        )
        if verdict is None:
            return Judgement(
                findings,
                Deviation(),
                tuple(self.untold),
                repaired,
                None,
                Deviation(),
                (),
                {},
                len(self.samples.t),
                turns,
            )
        if self.scene is None and self.known:
            self.untold.append("the scale of the inertia, a common shift of time and a fixed turn of space do not show")
        track = verdict.track
        best = (verdict.best.track if verdict.kind == "named" and verdict.best else None) or track
        rest = track.flat(track.residual)
        gains: dict[str, float] = {}
        for score in verdict.ranking:
            if score.cause:
                gains.setdefault(score.cause.name, score.gain)
        residual = {"t": track.data.t, "omega": rest[:, :3] / data.scale, "attitude": rest[:, 3:]}
        return Judgement(
            findings,
            _deviation(rest, data),
            tuple(self.untold),
            repaired,
            (best.omega[0, 0].copy(), best.attitude[0, 0].copy()),
            _deviation(best.flat(best.residual), data),
            tuple(gains.items()),
            residual,
            len(self.samples.t),
            turns,
            track.length,
            verdict,
        )


def _explained(verdict: Verdict) -> Track | None:
    """Return the motion with the named cause, or that of the law where nothing is wrong: others have no true start."""
    if verdict.kind == "fine":
        return verdict.track
    return verdict.best.track if verdict.kind == "named" and verdict.best else None


def _deviation(rest: Array, data: Data) -> Deviation:
    w, q = np.linalg.norm(rest[:, :3], axis=1), np.linalg.norm(rest[:, 3:], axis=1)
    rates = (float(w.max()), float(np.sqrt(np.mean(w**2)))) if data.has_omega else (None, None)
    angles = (float(q.max()), float(np.sqrt(np.mean(q**2)))) if data.has_attitude else (None, None)
    return Deviation(angles[0], rates[0], angles[1], rates[1])
