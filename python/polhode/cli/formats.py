"""Findings about robots as what the writers for other programs take."""

from __future__ import annotations

from ..inertia.codes import CODES
from ..inertia.findings import Finding
from ..inertia.robots.report import LinkReport, Report
from .writers import Content, Entry, Part, Rule

UNREADABLE = "PI002"
RULES = tuple(Rule(code.name, code.level, code.title) for code in CODES.values())


def content(report: Report) -> Content:
    """Return a report with its links as parts."""
    return Content(report.file, tuple(_part(report, link) for link in report.links), report.error, UNREADABLE,
                   report.line)


def _part(report: Report, link: LinkReport) -> Part:
    entries = [_entry(finding) for finding in link.findings] + [_entry(*excused) for excused in link.ignored]
    return Part(link.link.name, link.link.file or report.file, tuple(entries),
                None if report.expanded else link.link.line, None if link.diagnosis else link.link.unjudged)


def _entry(finding: Finding, excuse: str | None = None) -> Entry:
    return Entry(finding.code, finding.level, f"{finding.text}. Likely: {finding.advice}", finding.what, excuse=excuse)
