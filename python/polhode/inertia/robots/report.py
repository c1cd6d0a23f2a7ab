"""The check of files: each link with its findings, the excused ones apart."""

from __future__ import annotations

import dataclasses
import os
import pathlib
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ... import _files
from ..._core import InvalidInput
from ..codes import LEVELS
from ..findings import Diagnosis, Finding
from .check import judge
from .expand import expand
from .files import STDIN, gather
from .format import NoRobot
from .ignore import Rule, rules
from .link import Link, Robot
from .paths import Search
from .reading import read


@dataclasses.dataclass(frozen=True, eq=False)
class LinkReport:
    """One link.

    Attributes
    ----------
    link : Link
        What its file says.
    diagnosis : Diagnosis or None
        None for a link without numbers.
    findings : tuple of Finding
        Those that are not excused.
    ignored : tuple of (Finding, str)
        Excused ones, with the reason.
    """

    link: Link
    diagnosis: Diagnosis | None
    findings: tuple[Finding, ...]
    ignored: tuple[tuple[Finding, str], ...] = ()

    @property
    def verdict(self) -> str:
        """The link in one line."""
        if self.diagnosis is None:
            return f"not judged: {self.link.unjudged}"
        if self.diagnosis.findings and not self.findings:
            return f"ignored: {self.ignored[0][1]}"
        return self.diagnosis.verdict


@dataclasses.dataclass(frozen=True, eq=False)
class Report:
    """One file.

    Attributes
    ----------
    file : str
    format : str
        "URDF", "MJCF" or "SDF"; "" for a file that cannot be read.
    name : str
        Of the robot.
    links : tuple of LinkReport
    notes : tuple of str
        What of the file was not read, and what its settings hide.
    error : str
        Why nothing of the file was read; "" if something was.
    line : int or None
        Where that error stands.
    expanded : bool
        True for a xacro file: line numbers are those of the expanded text, and are left out.
    empty : bool
        True for a file that is none of a robot, which its error says too.
    """

    file: str
    format: str = ""
    name: str = ""
    links: tuple[LinkReport, ...] = ()
    notes: tuple[str, ...] = ()
    error: str = ""
    line: int | None = None
    expanded: bool = False
    empty: bool = False

    @property
    def level(self) -> str:
        """The worst level of a finding: "error", "warning", "remark", or "" without any."""
        if self.error:
            return "error"
        found = [LEVELS.index(finding.level) for link in self.links for finding in link.findings]
        return LEVELS[max(found)] if found else ""

    def fails(self, level: str = "warning") -> bool:
        """Return whether there is a finding of this level or above."""
        return bool(self.level) and LEVELS.index(self.level) >= LEVELS.index(level)


def check(paths: str | os.PathLike[str] | Sequence[str | os.PathLike[str]], *,
          path: Sequence[str | os.PathLike[str]] = (), package: Mapping[str, str | os.PathLike[str]] | None = None,
          ignore: Sequence[str | os.PathLike[str] | Rule] = (), xacro: bool = True,
          progress: Callable[[str], None] | None = None) -> list[Report]:
    """Check the inertia of every link of robot descriptions.

    Parameters
    ----------
    paths : path or sequence of paths
        Files, and folders that are searched for URDF, SDF, MJCF and xacro files.
    path : sequence of folders
        Where packages, models and meshes are searched, before the folders that ROS_PACKAGE_PATH, AMENT_PREFIX_PATH,
        GZ_SIM_RESOURCE_PATH, SDF_PATH and GAZEBO_MODEL_PATH name.
    package : mapping, optional
        Folders of packages by their names.
    ignore : sequence
        "LINK=reason", files of rules, or rules.
    xacro : bool
        Expand .xacro files, where the xacro package is installed.
    progress : callable, optional
        Called with the name of each file before it is read.

    Returns
    -------
    list of Report
        One for each file. A file that cannot be read has its `error`. In folders, files without a robot are left out.

    Raises
    ------
    InvalidInput
        For wrong arguments, and for rules that cannot be read.
    """
    given = [paths] if isinstance(paths, (str, os.PathLike)) else list(paths)
    roots = [_files.to_path(one, "paths") for one in given]
    excuses = rules(ignore)
    folders = [root if root.is_dir() else root.parent for root in roots if str(root) != STDIN]
    search = Search.of(path, package, [folder for root, folder in zip(roots, folders) if root.is_dir()])
    reports = []
    files = list(gather(roots))
    own = {str(file.resolve()) for file, _ in files} if len(files) > 1 else set()
    for file, named in files:
        if progress is not None:
            progress(str(file))
        report = check_file(file, search, excuses, xacro=xacro, elsewhere=own)
        if named or not report.empty:
            reports.append(report)
    return reports


def check_file(file: pathlib.Path, search: Search, excuses: Sequence[Rule] = (), *, xacro: bool = True,
               data: bytes | None = None, elsewhere: set[str] | frozenset[str] = frozenset()) -> Report:
    """Check one file. Links of included files that are in `elsewhere` are left to those files."""
    expanded = data is None and file.suffix.lower() == ".xacro"
    try:
        if expanded and xacro:
            data = expand(file, search)
        robot = read(file, search=search, data=data)
        here = str(file.resolve()) if elsewhere else ""
        robot.links = [link for link in robot.links if not elsewhere or link.file == str(file)
                       or (place := str(pathlib.Path(link.file).resolve())) == here or place not in elsewhere]
        links = tuple(_report(link, found, excuses) for link, found in judge(robot))
    except InvalidInput as error:
        return Report(str(file), error=str(error), line=getattr(error, "line", None),
                      empty=isinstance(error, NoRobot))
    except (MemoryError, KeyboardInterrupt):
        raise
    except Exception as error:   # a fault of polhode, which must not end the check of the other files
        return Report(str(file), error=f"{file}: cannot be judged: {type(error).__name__}: {error}")
    return Report(str(file), robot.kind, robot.name, links, (*robot.notes, *_summary(robot)), expanded=expanded)


def _report(link: Link, diagnosis: Diagnosis | None, excuses: Sequence[Rule]) -> LinkReport:
    kept, ignored = [], []
    for finding in () if diagnosis is None else diagnosis.findings:
        rule = next((rule for rule in excuses if rule.excuses(link.name, finding.code, link.file)), None)
        if rule is None:
            kept.append(finding)
        else:
            rule.used = True
            ignored.append((finding, rule.reason))
    return LinkReport(link, diagnosis, tuple(kept), tuple(ignored))


_SAID = {"not found": "not found", "outside": "outside of the folders that may be read (--path)",
         "needs an extra": "of a format that needs pip install 'polhode[mesh]'", "unreadable": "that cannot be read"}


def _summary(robot: Robot) -> list[str]:
    """One line about meshes instead of one for each."""
    lines = []
    for kind, said in _SAID.items():
        links = [link for link in robot.links if any(why == kind for why, _ in link.unread)]
        count = sum(why == kind for link in links for why, _ in link.unread)
        if count > 1:
            example = next(note for link in links for why, note in link.unread if why == kind)
            lines.append(f"{count} meshes {said}, in {len(links)} links; the first: {example}")
    return lines


def link_to_dict(report: LinkReport) -> dict[str, Any]:
    """Return a link as a dict for JSON. Numbers that are not finite are None."""
    link, diagnosis = report.link, report.diagnosis
    content: dict[str, Any] = {
        "name": link.name, "file": link.file, "line": link.line, "mass": link.mass, "com": None, "moments": None,
        "matrix": None, "verdict": report.verdict, "findings": [_finding(f, link) for f in report.findings],
        "ignored": [{**_finding(f, link), "reason": reason} for f, reason in report.ignored], "notes": link.notes}
    if diagnosis is not None and link.matrix is not None:
        content["com"] = link.pose.place.tolist()
        if np.isfinite(link.matrix).all():
            content["matrix"] = link.matrix.tolist()
            content["moments"] = np.linalg.eigvalsh(link.matrix).tolist()
            content["margin"] = diagnosis.margin
        content["misfit"] = diagnosis.misfit
        content["compared"] = bool(link.visual.parts or link.collision.parts or link.from_geoms)
    return content


def _finding(finding: Finding, link: Link) -> dict[str, Any]:
    content = {**finding.to_dict(), "line": link.line}
    if finding.com is not None:
        com = link.pose.rotation @ finding.com   # in the link's axes, as in the file
        content["com"] = np.where(np.abs(com) < 1e-9 * np.abs(com).max(), 0.0, com).tolist()
    return content


def to_dict(report: Report, fail_on: str = "warning") -> dict[str, Any]:
    """Return a report as a dict for JSON."""
    content = {"file": report.file, "format": report.format, "name": report.name, "valid": not report.fails(fail_on),
               "level": report.level, "notes": list(report.notes),
               "links": [link_to_dict(link) for link in report.links]}
    if report.error:
        content |= {"error": report.error, "line": report.line}
    plain: dict[str, Any] = _plain(content)
    return plain


def _plain(content: Any) -> Any:
    """Replace numbers that are not finite by None, because JSON has none."""
    if isinstance(content, dict):
        return {key: _plain(value) for key, value in content.items()}
    if isinstance(content, list):
        return [_plain(value) for value in content]
    return None if isinstance(content, float) and not np.isfinite(content) else content
