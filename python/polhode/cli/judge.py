"""`polhode judge`: motions in files, judged one by one."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import sys
from typing import Annotated, Any

import typer

from .. import _files
from .._core import InertiaTensor, InvalidInput
from .._judge.codes import CODES, LEVELS
from .._judge.findings import Finding, ordered
from .._judge.judgement import Judgement
from .._judge.repaired import write_repaired
from .._judge.run import judge as judge_samples
from .._judge.sources import Source, load
from .._scene.scene import Scene
from . import files as motion_files
from . import writers
from .options import Json, need_matplotlib
from .streams import say, write_json

RULES = tuple(writers.Rule(code.name, code.level, code.title) for code in CODES.values())
UNREADABLE = "PJ002"
PART = "motion"


@dataclasses.dataclass
class Report:
    """A file with its judgement, or the reason why it was not read. `excused` are findings with their reasons."""

    file: str
    judgement: Judgement | None = None
    error: str = ""
    source: Source | None = None
    excused: list[tuple[Finding, str]] = dataclasses.field(default_factory=list)

    @property
    def counted(self) -> list[Finding]:
        """The findings that are not excused."""
        off = {id(finding) for finding, _ in self.excused}
        return [f for f in self.judgement.findings if id(f) not in off] if self.judgement else []

    def fails(self, level: str) -> bool:
        """True if the file was not read, or a finding that counts has this level or a worse one."""
        return bool(self.error) or any(LEVELS.index(f.level) >= LEVELS.index(level) for f in self.counted)


def judge(
    files: Annotated[list[str], typer.Argument(
        help="Motions: CSV, TSV or other text with columns, .npz, .json of `polhode run`, .mat, .tum.")],
    inertia: Annotated[str | None, typer.Option(
        help="Of a free body: moments such as 1,2,2.5, or ixx,iyy,izz,ixy,ixz,iyz.")] = None,
    scene: Annotated[str | None, typer.Option(
        help="A scene file or the name of a scene: inertia, torques and start.")] = None,
    columns: Annotated[str | None, typer.Option(
        help="Names of the columns, such as t,qw,qx,qy,qz,wx,wy,wz; or of arrays, such as t=time,omega=gyr.")] = None,
    order: Annotated[str | None, typer.Option(
        help="Where the scalar stands in columns that do not say so: xyzw or wxyz.")] = None,
    frame: Annotated[str, typer.Option(help="Axes of the rates: body or space.")] = "body",
    euler: Annotated[str | None, typer.Option(help="Sequence of Euler angles, such as ZYX or zxz.")] = None,
    degrees: Annotated[bool, typer.Option("--degrees", help="Angles and rates are in degrees.")] = False,
    tolerance: Annotated[float, typer.Option(
        help="Warnings with a smaller effect become remarks [rad].")] = 1e-6,
    fail_on: Annotated[str, typer.Option(
        help="The level from which the exit status is 1: error, warning or remark.")] = "warning",
    ignore: Annotated[list[str] | None, typer.Option(
        help="Excuse findings, by CAUSE=reason or CODE=reason. May be repeated.")] = None,
    form: Annotated[str, typer.Option("--format", help="text, json, sarif, junit or github.")] = "text",
    picture: Annotated[pathlib.Path | None, typer.Option(
        "--plot", help="Draw deviation, residual, ranking and findings: .png, .svg or .pdf.")] = None,
    fix: Annotated[pathlib.Path | None, typer.Option(
        help="Write the samples in polhode's conventions to a new file: .csv or .npz.")] = None,
    as_json: Json = False,
) -> int:
    """Judge motions: what is wrong with them, by how much, and why.

    Compares samples with the exact motion of a body. Names the fault with its size, or says that the data cannot tell.
    """
    form = "json" if as_json else form
    writers.require(form, fail_on)
    excuses = dict(_excuse(text) for text in ignore or ())
    if inertia is not None and scene is not None:
        raise InvalidInput("--inertia: must be left out with --scene, which has one")
    body, known = None if inertia is None else _inertia(inertia), None if scene is None else Scene.load(scene)
    for name, wanted in (("--plot", picture), ("--fix", fix)):
        if wanted is not None and len(files) > 1:
            raise InvalidInput(f"{name}: must be used with one file, got {len(files)}")
    if picture is not None:
        need_matplotlib("pictures need")
        motion_files.check(picture, (".png", ".svg", ".pdf"), "plot")
        _require_other(picture, files[0], "--plot")
    if fix is not None:
        _require_new(fix, files[0])
    reports = []
    for name in files:
        try:
            source = load(name, columns, order, euler, degrees)
            found = _judged(source, body, known, frame, tolerance)
            reports.append(Report(name, found, "", source, _excused(found, excuses)))
        except InvalidInput as error:
            if len(files) == 1:
                raise
            reports.append(Report(name, error=str(error)))
    if all(report.error for report in reports):
        for report in reports[:10]:
            say(report.error)
        return 2
    single = reports[0].judgement
    if picture is not None and single is not None:
        single.plot(picture)
    if fix is not None and single is not None:
        write_repaired(fix, single.repaired)
    _print(reports, form, fail_on)
    for file in filter(None, (picture, fix)):
        print(f"wrote {file}", file=sys.stderr if form != "text" else sys.stdout)
    used = {name for report in reports for finding, _ in report.excused for name in (finding.code, finding.cause)}
    for name in excuses.keys() - used:
        print(f"ignore {name!r}: no longer applies ({excuses[name]})", file=sys.stderr)
    return 1 if any(report.fails(fail_on) for report in reports) else 0


def _judged(source: Source, body: Any, scene: Scene | None, frame: str, tolerance: float) -> Judgement:
    found = judge_samples(source.t, source.attitude, source.omega, inertia=body, scene=scene, order=source.order,
                          frame=frame, euler=source.euler, degrees=source.degrees, tolerance=tolerance)
    if not source.notes:
        return found
    remark = Finding("columns", "the file states: " + "; ".join(source.notes))
    return dataclasses.replace(found, findings=ordered([*found.findings, remark]))


def _inertia(text: str) -> InertiaTensor:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) == 3:
        return InertiaTensor.from_moments(numbers)
    if len(numbers) != 6:
        raise InvalidInput(f"--inertia: must be three moments, or ixx,iyy,izz,ixy,ixz,iyz; got {text[:60]!r}")
    xx, yy, zz, xy, xz, yz = numbers
    return InertiaTensor([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])


def _excuse(text: str) -> tuple[str, str]:
    name, _, reason = (part.strip() for part in text.partition("="))
    if not name or not reason:
        raise InvalidInput(f"--ignore: must be CAUSE=reason with both of them, got {text[:60]!r}")
    if name not in CODES and name not in {code.cause for code in CODES.values()}:
        raise InvalidInput(f"--ignore: must name a code or a cause, got {name[:60]!r}")
    return name, reason


def _excused(found: Judgement, excuses: dict[str, str]) -> list[tuple[Finding, str]]:
    named = [(f, excuses.get(f.code, excuses.get(f.cause))) for f in found.findings]
    return [(finding, reason) for finding, reason in named if reason is not None]


def _require_new(fix: pathlib.Path, given: str) -> None:
    """Refuse the name of the input, a name that is taken, and a folder where nothing can be written."""
    motion_files.check(fix, (".csv", ".npz"), "fix")
    _require_other(fix, given, "--fix")
    _files.require_free(fix)


def _require_other(path: pathlib.Path, given: str, option: str) -> None:
    if path.exists() and pathlib.Path(given).exists() and os.path.samefile(path, given):
        raise InvalidInput(f"{option}: must be another file than the input, got {str(path)!r}")


def _print(reports: list[Report], form: str, fail_on: str) -> None:
    contents = [_content(report) for report in reports]
    if form == "json":
        tables = [_to_json(report) for report in reports]
        write_json(tables[0] if len(tables) == 1 else
                   [{"file": report.file, **table} for report, table in zip(reports, tables, strict=True)])
    elif form == "sarif":
        write_json(writers.sarif(contents, RULES))
    elif form == "junit":
        print(writers.junit(contents, "judge", fail_on))
    elif form == "github":
        for line in writers.github(contents):
            print(line)
    else:
        for report in reports:
            _print_text(report)


def _to_json(report: Report) -> dict[str, Any]:
    if report.judgement is None:
        return {"error": report.error}
    ignored = [{"code": f.code, "cause": f.cause, "reason": reason} for f, reason in report.excused]
    return report.judgement.to_dict() | ({"ignored": ignored} if ignored else {})


def _content(report: Report) -> writers.Content:
    if report.judgement is None:
        return writers.Content(report.file, error=report.error, code=UNREADABLE)
    reasons = {id(finding): reason for finding, reason in report.excused}
    lines = report.source.lines if report.source else ()
    entries = tuple(
        writers.Entry(f.code, f.level, _sentence(f), f.cause, lines[f.where[0]] if f.where and lines else None,
                      reasons.get(id(f))) for f in report.judgement.findings)
    return writers.Content(report.file, (writers.Part(PART, report.file, entries),))


def _sentence(finding: Finding) -> str:
    """A finding in words, with what to do about it."""
    return f"{finding.cause}: {finding.text}" + (f". Do: {finding.cure}" if finding.cure else "")


def _print_text(report: Report) -> None:
    """Print the verdict in one line, then each finding with its cure and rivals, and what the data do not tell."""
    if report.judgement is None:
        print(f"not read: {report.error}")
        return
    found, reasons = report.judgement, {id(finding): reason for finding, reason in report.excused}
    print(f"{report.file}: {found.line()}")
    for finding in found.findings:
        reason = reasons.get(id(finding))
        print(f"  {finding}" + (f" (excused: {reason})" if reason else ""))
        if finding.level != "remark" and finding.cure:
            print(f"      do: {finding.cure}")
        if finding.rivals and finding.cause != "cannot tell":
            print(f"      as likely, or nearly: {', '.join(finding.rivals)}")
    for text in found.untold:
        print(f"  untold: {text}")
