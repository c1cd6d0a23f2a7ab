"""Findings for other programs: SARIF 2.1.0, JUnit's XML, and the commands of GitHub's runners."""

from __future__ import annotations

import dataclasses
import pathlib
import re
from collections.abc import Iterable, Iterator
from typing import Any
from xml.sax.saxutils import quoteattr

from .._core import InvalidInput, __version__

FORMATS = ("text", "json", "sarif", "junit", "github")
LEVELS = ("remark", "warning", "error")
_SARIF_LEVELS = dict(zip(LEVELS, ("note", "warning", "error"), strict=True))
_GITHUB_LEVELS = dict(zip(LEVELS, ("notice", "warning", "error"), strict=True))


@dataclasses.dataclass(frozen=True)
class Rule:
    """A code of findings, with its usual level and what it says in a few words."""

    code: str
    level: str
    title: str


@dataclasses.dataclass(frozen=True)
class Entry:
    """A finding. `about` distinguishes it from others of its code and its part; `excuse` is why it does not count."""

    code: str
    level: str
    text: str
    about: str = ""
    line: int | None = None
    excuse: str | None = None


@dataclasses.dataclass(frozen=True)
class Part:
    """What was judged alone, such as a link of a robot; a part that was not judged has the reason as `skipped`."""

    name: str
    file: str
    entries: tuple[Entry, ...] = ()
    line: int | None = None
    skipped: str | None = None


@dataclasses.dataclass(frozen=True)
class Content:
    """A file with its parts. A file that was not read has the reason as `error`, with its code and line."""

    file: str
    parts: tuple[Part, ...] = ()
    error: str = ""
    code: str = ""
    line: int | None = None


def require(form: str, fail_on: str) -> None:
    """Refuse a format or a level that does not exist."""
    if form not in FORMATS:
        raise InvalidInput(f"--format: must be one of {', '.join(FORMATS)}; got {form!r}")
    if fail_on not in LEVELS:
        raise InvalidInput(f"--fail-on: must be error, warning or remark; got {fail_on!r}")


def sarif(contents: Iterable[Content], rules: Iterable[Rule]) -> dict[str, Any]:
    """Return a SARIF log; excused findings are suppressed results."""
    results = []
    for content in contents:
        if content.error:
            results.append({"ruleId": content.code, "level": "error", "message": {"text": content.error},
                            "locations": [_location(content.file, content.line)]})
        for part in content.parts:
            for entry in part.entries:
                result: dict[str, Any] = {
                    "ruleId": entry.code, "level": _SARIF_LEVELS[entry.level],
                    "message": {"text": f"{part.name}: {entry.text}"},
                    "locations": [{**_location(part.file, entry.line or part.line),
                                   "logicalLocations": [{"name": part.name, "kind": "element"}]}],
                    "partialFingerprints": {"polhode/v1": f"{entry.code}:{part.name}:{entry.about}"}}
                if entry.excuse is not None:
                    result["suppressions"] = [{"kind": "external", "justification": entry.excuse}]
                results.append(result)
    table = [{"id": rule.code, "shortDescription": {"text": rule.title}, "help": {"text": f"docs/codes/{rule.code}.md"},
              "defaultConfiguration": {"level": _SARIF_LEVELS[rule.level]}} for rule in rules]
    return {"$schema": "https://json.schemastore.org/sarif-2.1.0.json", "version": "2.1.0", "runs": [{
        "tool": {"driver": {"name": "polhode", "version": __version__, "rules": table}}, "results": results}]}


def _location(file: str, line: int | None) -> dict[str, Any]:
    place: dict[str, Any] = {"artifactLocation": {"uri": pathlib.PurePath(file).as_posix()}}
    if line:
        place["region"] = {"startLine": line}
    return {"physicalLocation": place}


def junit(contents: Iterable[Content], command: str, fail_on: str) -> str:
    """Return JUnit's XML: a suite for each file, a case for each part, a failure for each finding that counts."""
    least = LEVELS.index(fail_on)
    suites, total, failed = [], 0, 0
    for content in contents:
        cases, failures = [], 0
        if content.error:
            failures += 1
            cases.append(f'    <testcase classname={_quoted(content.file)} name="file">\n'
                         f"      <error message={_quoted(content.error)}/>\n    </testcase>")
        for part in content.parts:
            inside = []
            for entry in part.entries:
                text = _quoted(f"{entry.code} {part.name}: {entry.text}")
                if entry.excuse is None and LEVELS.index(entry.level) >= least:
                    inside.append(f"      <failure type={_quoted(entry.code)} message={text}/>")
            if part.skipped is not None and not inside:
                inside.append(f"      <skipped message={_quoted(part.skipped)}/>")
            failures += any("<failure" in line for line in inside)
            head = f"    <testcase classname={_quoted(content.file)} name={_quoted(part.name)}"
            head += f" file={_quoted(part.file)}" + (f' line="{part.line}"' if part.line else "")
            cases.append(head + (">\n" + "\n".join(inside) + "\n    </testcase>" if inside else "/>"))
        total, failed = total + len(cases), failed + failures
        suites.append(f'  <testsuite name={_quoted(content.file)} tests="{len(cases)}" failures="{failures}">\n'
                      + "\n".join(cases) + "\n  </testsuite>")
    return (f'<?xml version="1.0" encoding="utf-8"?>\n<testsuites name="polhode {command}" tests="{total}" '
            f'failures="{failed}">\n' + "\n".join(suites) + "\n</testsuites>")


def _quoted(text: str) -> str:
    """A text as an attribute; characters that XML has not are left out."""
    return quoteattr(re.sub("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "?", text))


def github(contents: Iterable[Content]) -> Iterator[str]:
    """Give the commands by which GitHub's runners show findings beside the lines of a change."""
    for content in contents:
        if content.error:
            yield _command("error", content.file, content.line, content.code, content.error)
        for part in content.parts:
            for entry in part.entries:
                if entry.excuse is None:
                    yield _command(_GITHUB_LEVELS[entry.level], part.file, entry.line or part.line,
                                   f"{entry.code} {part.name}", f"{part.name}: {entry.text}")


def _command(level: str, file: str, line: int | None, title: str, text: str) -> str:
    place = [f"file={_escaped(pathlib.PurePath(file).as_posix())}"] + ([f"line={line}"] if line else [])
    place.append(f"title={_escaped(title)}")
    return f"::{level} {','.join(place)}::{_escaped(text, False)}"


def _escaped(text: str, a_property: bool = True) -> str:
    for old, new in (("%", "%25"), ("\r", "%0D"), ("\n", "%0A"), *(((":", "%3A"), (",", "%2C")) if a_property else ())):
        text = text.replace(old, new)
    return text
