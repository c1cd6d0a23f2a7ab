"""Findings about robot descriptions: what a call asks for, and what it prints."""

from __future__ import annotations

import pathlib
import sys

from .. import _files
from .._core import InvalidInput
from ..inertia import robots
from ..inertia.robots.ignore import rules
from ..inertia.robots.paths import Search
from ..inertia.robots.report import Report, check, check_file, to_dict
from . import show_robots, writers
from .formats import RULES, content
from .robot_options import STDIN, Options
from .streams import say, write_json


def run(files: list[str], options: Options) -> int:
    """Check files and folders, print what was found, and return the exit status."""
    writers.require(options.form, options.fail_on)
    excuses = rules(options.ignore)
    packages = dict(_package(text) for text in options.package)
    if STDIN in files:
        if files != [STDIN]:
            raise InvalidInput("-: stdin must be the only file")
        reports = [_from_stdin(Search.of(options.path, packages), excuses)]
    else:
        reports = check(list(files), path=options.path, package=packages, ignore=excuses, xacro=options.xacro)
    if not reports:
        raise InvalidInput(f"{files[0]}: must hold a robot description: {robots.formats.NAMES} or xacro")
    single = len(files) == 1 and not pathlib.Path(files[0]).is_dir()
    if all(report.error for report in reports):
        if single:
            raise InvalidInput(reports[0].error)
        for report in reports[:10]:
            say(str(report.error))
        return 2
    stale = [f"ignore {rule}: no longer applies ({rule.reason})" for rule in excuses if not rule.used]
    written = [_write_repaired(report, files) for report in reports] if options.fix else []
    _print(reports, options, single)
    for line in stale:
        print(line, file=sys.stderr)
    return 1 if any(report.fails(options.fail_on) for report in reports) or not all(written) else 0


def _package(text: str) -> tuple[str, str]:
    name, equals, folder = text.partition("=")
    if not (name and equals and folder):
        raise InvalidInput(f"--package: must be NAME=FOLDER, got {text[:60]!r}")
    return name, folder


def _from_stdin(search: Search, excuses: list[robots.Rule]) -> Report:
    data = sys.stdin.buffer.read(_files.TEXT + 1)
    if len(data) > _files.TEXT:
        raise InvalidInput(f"stdin: must be at most {_files.TEXT // 1_000_000} MB")
    return check_file(pathlib.Path("stdin"), search, excuses, data=data)


def _write_repaired(report: Report, given: list[str]) -> bool:
    """Write a repaired copy beside a file; return False where it cannot be written. Links are not followed."""
    if report.error:
        return True
    if report.file == "stdin":
        raise InvalidInput("--fix: must be used with files, got stdin")
    file = pathlib.Path(report.file)
    folders = (pathlib.Path(name) for name in given if name != report.file)
    root = next((folder for folder in folders if file.is_relative_to(folder)), file.parent)
    inner = file.relative_to(root)
    try:
        data, said = robots.repair(_files.read_below(root, inner, _files.TEXT), report)
        for line in said:
            print(f"{report.file}: {line}", file=sys.stderr)
        if any(line.endswith(": repaired") for line in said):
            copy = inner.with_name(f"{file.stem}.fixed{file.suffix}")
            _files.write_below(root, copy, data)
            print(f"wrote {root / copy}", file=sys.stderr)
    except InvalidInput as error:
        say(str(error))
        return False
    return True


def _print(reports: list[Report], options: Options, single: bool) -> None:
    if options.form == "json":
        contents = [to_dict(report, options.fail_on) for report in reports]
        write_json(contents[0] if single else contents)
    elif options.form == "sarif":
        write_json(writers.sarif(map(content, reports), RULES))
    elif options.form == "junit":
        print(writers.junit(map(content, reports), "inertia", options.fail_on))
    elif options.form == "github":
        for line in writers.github(map(content, reports)):
            print(line)
    elif single:
        show_robots.robot(to_dict(reports[0], options.fail_on))
    else:
        show_robots.robots([to_dict(report, options.fail_on) for report in reports])
