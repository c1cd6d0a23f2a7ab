"""Findings about robots for other programs: JSON, SARIF 2.1.0, JUnit's XML, and the commands of GitHub's runners."""

from __future__ import annotations

import pathlib
import re
from collections.abc import Iterator, Sequence
from typing import Any
from xml.sax.saxutils import quoteattr

from .._core import __version__
from ..inertia.codes import CODES, LEVELS
from ..inertia.findings import Finding
from ..inertia.robots.report import LinkReport, Report

_SARIF_LEVELS = {"error": "error", "warning": "warning", "remark": "note"}
_GITHUB_LEVELS = {"error": "error", "warning": "warning", "remark": "notice"}
UNREADABLE = "PI002"


def _message(link: LinkReport, finding: Finding) -> str:
    return f"{link.link.name}: {finding.text}. Likely: {finding.advice}"


def _line(report: Report, link: LinkReport) -> int | None:
    return None if report.expanded else link.link.line


def sarif(reports: Sequence[Report]) -> dict[str, Any]:
    """Return a SARIF log; excused findings are suppressed results."""
    results = []
    for report in reports:
        if report.error:
            results.append({"ruleId": UNREADABLE, "level": "error", "message": {"text": report.error},
                            "locations": [_location(report.file, report.line)]})
        for link in report.links:
            for finding, reason in [(f, None) for f in link.findings] + list(link.ignored):
                result: dict[str, Any] = {
                    "ruleId": finding.code, "level": _SARIF_LEVELS[finding.level],
                    "message": {"text": _message(link, finding)},
                    "locations": [{**_location(link.link.file or report.file, _line(report, link)),
                                   "logicalLocations": [{"name": link.link.name, "kind": "element"}]}],
                    "partialFingerprints": {"polhode/v1": f"{finding.code}:{link.link.name}:{finding.what}"}}
                if reason is not None:
                    result["suppressions"] = [{"kind": "external", "justification": reason}]
                results.append(result)
    table = [{"id": code.name, "shortDescription": {"text": code.title}, "help": {"text": f"docs/codes/{code.name}.md"},
              "defaultConfiguration": {"level": _SARIF_LEVELS[code.level]}} for code in CODES.values()]
    return {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [{
        "tool": {"driver": {"name": "polhode", "version": __version__, "rules": table}}, "results": results}]}


def _location(file: str, line: int | None) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": {"uri": pathlib.PurePath(file).as_posix()}}
    if line:
        place["region"] = {"startLine": line}
    return {"physicalLocation": place}


def junit(reports: Sequence[Report], fail_on: str) -> str:
    """Return JUnit's XML: a suite for each file, a case for each link, a failure for each finding that counts."""
    least = LEVELS.index(fail_on)
    suites, total, failed = [], 0, 0
    for report in reports:
        cases, failures = [], 0
        if report.error:
            failures += 1
            cases.append(f'    <testcase classname={_quoted(report.file)} name="file">\n'
                         f"      <error message={_quoted(report.error)}/>\n    </testcase>")
        for link in report.links:
            inside = []
            for finding in link.findings:
                text = _quoted(f"{finding.code} {_message(link, finding)}")
                if LEVELS.index(finding.level) >= least:
                    inside.append(f"      <failure type={_quoted(finding.code)} message={text}/>")
            if link.diagnosis is None and not inside:
                inside.append(f"      <skipped message={_quoted(link.link.unjudged)}/>")
            failures += any("<failure" in line for line in inside)
            head = f"    <testcase classname={_quoted(report.file)} name={_quoted(link.link.name)}"
            line = _line(report, link)
            head += f' file={_quoted(link.link.file or report.file)}' + (f' line="{line}"' if line else "")
            cases.append(head + (">\n" + "\n".join(inside) + "\n    </testcase>" if inside else "/>"))
        total, failed = total + len(cases), failed + failures
        suites.append(f'  <testsuite name={_quoted(report.file)} tests="{len(cases)}" failures="{failures}">\n'
                      + "\n".join(cases) + "\n  </testsuite>")
    return (f'<?xml version="1.0" encoding="utf-8"?>\n<testsuites name="polhode inertia" tests="{total}" '
            f'failures="{failed}">\n' + "\n".join(suites) + "\n</testsuites>")


def _quoted(text: str) -> str:
    """A text as an attribute; characters that XML has not are left out."""
    return quoteattr(re.sub("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "?", text))


def github(reports: Sequence[Report]) -> Iterator[str]:
    """Give the commands by which GitHub's runners show findings beside the lines of a change."""
    for report in reports:
        if report.error:
            yield _command("error", report.file, report.line, UNREADABLE, report.error)
        for link in report.links:
            for finding in link.findings:
                yield _command(_GITHUB_LEVELS[finding.level], link.link.file or report.file, _line(report, link),
                               f"{finding.code} {link.link.name}", _message(link, finding))


def _command(level: str, file: str, line: int | None, title: str, text: str) -> str:
    place = [f"file={_escaped(pathlib.PurePath(file).as_posix())}"] + ([f"line={line}"] if line else [])
    place.append(f"title={_escaped(title)}")
    return f"::{level} {','.join(place)}::{_escaped(text, False)}"


def _escaped(text: str, a_property: bool = True) -> str:
    for old, new in (("%", "%25"), ("\r", "%0D"), ("\n", "%0A"), *(((":", "%3A"), (",", "%2C")) if a_property else ())):
        text = text.replace(old, new)
    return text
