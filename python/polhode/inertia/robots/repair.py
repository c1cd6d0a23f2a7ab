"""Repaired copies: the numbers of named causes replaced, the old ones in comments, every other byte as it was."""

from __future__ import annotations

import re

import numpy as np

from ..._xml import Node
from ..findings import Finding
from .format import Format
from .formats import FORMATS
from .link import Link
from .report import Report

UNSURE = ("unknown", "placeholder", "marker", "identified", "massless", "text", "density")
ENTRIES = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
_TAG = re.compile(rb"<[^>\"']*(?:\"[^\"]*\"[^>\"']*|'[^']*'[^>\"']*)*>")


class _Edits:
    """Replacements of bytes, and comments after elements."""

    def __init__(self, data: bytes) -> None:
        self.data = data
        self.changes: list[tuple[int, int, bytes]] = []

    def attribute(self, node: Node, name: str, new: str) -> bool:
        """Replace an attribute's value; False where it is not there as such."""
        tag = _TAG.match(self.data, node.start)
        if tag is None:
            return False
        found = re.search(rb"\s" + name.encode() + rb"\s*=\s*(?:\"([^\"]*)\"|'([^']*)')", tag[0])
        if found is None:
            return False
        group = 1 if found[1] is not None else 2
        begin, end = (tag.start() + at for at in found.span(group))
        self.changes += [(begin, end, new.encode()), _comment(tag.end(), f'{name}="{found[group].decode()}"')]
        return True

    def text(self, node: Node, new: str) -> bool:
        """Replace the text of an element that holds nothing else."""
        tag = _TAG.match(self.data, node.start)
        if tag is None or tag[0].endswith(b"/>") or node.nodes:
            return False
        end = self.data.find(b"<", tag.end())
        close = re.compile(rb"</" + re.escape(node.tag.encode()) + rb"\s*>").match(self.data, end)
        if close is None:
            return False
        old = self.data[tag.end():end]
        blank = len(old) - len(old.lstrip())
        self.changes += [(tag.end() + blank, tag.end() + blank + len(old.strip()), new.encode()),
                         _comment(close.end(), f"{node.tag} {old.strip().decode()}")]
        return True

    def apply(self) -> bytes:
        data = self.data
        for begin, end, new in sorted(_joined(self.changes), key=lambda change: change[0], reverse=True):
            data = data[:begin] + new + data[end:]
        return data


def _comment(at: int, old: str) -> tuple[int, int, bytes]:
    return at, at, old.replace("--", "- -").encode()


def _joined(changes: list[tuple[int, int, bytes]]) -> list[tuple[int, int, bytes]]:
    """Put the old numbers of one element into one comment."""
    comments: dict[int, list[bytes]] = {}
    for begin, end, new in changes:
        if begin == end:
            comments.setdefault(begin, []).append(new)
    return [change for change in changes if change[0] != change[1]] + [
        (at, at, b"<!-- was " + b" ".join(old) + b" -->") for at, old in comments.items()]


def repair(data: bytes, report: Report) -> tuple[bytes, list[str]]:
    """Return a repaired copy of a file's text, and a line about each finding.

    Only findings whose cause is named are repaired. The new numbers stand where the old ones stood, and a comment
    after the element holds the old ones. All other bytes stay.
    """
    edits, said = _Edits(data), []
    if report.expanded:
        return data, ["nothing is repaired: the numbers do not stand in this file as such"]
    if data[:2] in (b"\xff\xfe", b"\xfe\xff") or b"\0" in data[:4]:
        return data, ["nothing is repaired: files in UTF-16 are not repaired; save the file in UTF-8"]
    for each in report.links:
        done = False
        for finding in each.findings:
            name = f"{each.link.name}: {finding.code} {finding.what} ({finding.cause})"
            if done or finding.level == "remark":
                continue
            why = _edit(edits, each.link, finding, report)
            done = not why
            said.append(f"{name}: {why or 'repaired'}")
    return edits.apply(), said


def _edit(edits: _Edits, link: Link, finding: Finding, report: Report) -> str:
    """Replace one link's numbers; returns why not, if not."""
    if finding.cause in UNSURE or finding.matrix is None:
        return "not repaired: no cause is named"
    if link.file != report.file or link.from_geoms:
        return f"not repaired: the numbers stand in {link.file}" if link.file != report.file else \
            "not repaired: the numbers come from the geoms"
    before = len(edits.changes)
    form = FORMATS[report.format]
    if not (_edit_tensor(edits, link, finding) and _edit_mass(edits, link, finding, form)
            and _edit_centre(edits, link, finding, form)):
        del edits.changes[before:]
        return "not repaired: the element has no such numbers to replace"
    return "" if len(edits.changes) > before else "not repaired: the numbers of the link are right"


def _number(x: float) -> str:
    return f"{x + 0.0:.9g}"


def _edit_tensor(edits: _Edits, link: Link, finding: Finding) -> bool:
    assert finding.matrix is not None and link.matrix is not None
    node, matrix = link.source.tensor, finding.matrix
    changed = {name: matrix[at] for name, at in ENTRIES.items()
               if not np.isclose(matrix[at], link.matrix[at], rtol=1e-9, atol=1e-12 * np.abs(matrix).max())}
    if not changed:
        return True
    if node is None:
        return False
    if node.get("fullinertia") is not None:
        order = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")
        return edits.attribute(node, "fullinertia", " ".join(_number(matrix[ENTRIES[name]]) for name in order))
    if node.get("diaginertia") is not None:
        if any(name in changed for name in ("ixy", "ixz", "iyz")):
            return False
        return edits.attribute(node, "diaginertia", " ".join(map(_number, matrix.diagonal())))
    for name, value in changed.items():
        child = node.child(name)
        new = _number(value)
        if not (edits.attribute(node, name, new) if child is None else edits.text(child, new)):
            return False
    return True


def _edit_mass(edits: _Edits, link: Link, finding: Finding, form: Format) -> bool:
    if finding.mass is None or link.mass is None or np.isclose(finding.mass, link.mass, rtol=1e-9, atol=0):
        return True
    node = link.source.mass
    if node is None:
        return False
    if not form.mass:
        return edits.text(node, _number(finding.mass))
    return edits.attribute(node, form.mass, _number(finding.mass))


def _edit_centre(edits: _Edits, link: Link, finding: Finding, form: Format) -> bool:
    if finding.com is None:
        return True
    com = link.pose.rotation @ finding.com
    if np.allclose(com, link.pose.place, rtol=1e-9, atol=1e-12):
        return True
    node = link.source.pose
    com = np.where(np.abs(com) < 1e-9 * np.abs(com).max(), 0.0, com)
    if node is None:
        return False
    if not form.centre:
        rest = node.text.split()[3:]
        return not node.get("relative_to") and edits.text(node, " ".join([*map(_number, com), *rest]))
    return edits.attribute(node, form.centre, " ".join(map(_number, com)))
