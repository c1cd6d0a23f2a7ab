"""Findings about robots on a terminal."""

from __future__ import annotations

import collections
from typing import Any

import numpy as np
from rich.text import Text

from ..inertia.codes import LEVELS
from .show import _table, console

FEW = 3    # notes of one kind that are shown one by one


def robot(content: dict[str, Any]) -> None:
    """Print the findings of a robot description: a table of its links, then advice for each finding."""
    out = console()
    out.print(Text(_headline(content)))
    table = _table("link", "mass [kg]", "principal moments [kg m^2]", "verdict", left=4)
    for link in content["links"]:
        mass = "-" if link["mass"] is None else f"{link['mass']:.6g}"
        moments = "-" if link["moments"] is None else "  ".join(f"{x:.4g}" for x in link["moments"])
        table.add_row(Text(link["name"]), mass, moments, Text(_verdict(link)))
    out.print(table)
    _details(content["links"], "remark")
    for i, note in enumerate(_notes(content)):
        out.print(Text(f"\nnote  {note}" if i == 0 else f"note  {note}"))


def robots(contents: list[dict[str, Any]]) -> None:
    """Print the findings of several files: a line for each, with its warnings and errors below it, then a sum."""
    out = console()
    counts: collections.Counter[str] = collections.Counter()
    for content in contents:
        if content.get("error"):
            counts["unread"] += 1
            out.print(Text(f"not read: {content['error']}"))
            continue
        findings = [finding for link in content["links"] for finding in link["findings"]]
        counts.update(finding["level"] for finding in findings)
        out.print(Text(f"{_headline(content)} ({content['file']})"))
        _details(content["links"], "warning")
    links = sum(len(content["links"]) for content in contents)
    out.print(Text(f"\n{len(contents)} files, {counts['unread']} not read; {links} links: {counts['error']} errors, "
                   f"{counts['warning']} warnings, {counts['remark']} remarks"))


def _headline(content: dict[str, Any]) -> str:
    links = content["links"]
    wrong = sum(any(finding["level"] != "remark" for finding in link["findings"]) for link in links)
    judged = sum(link["matrix"] is not None or bool(link["findings"]) for link in links)
    remarks = sum(bool(link["findings"]) and all(f["level"] == "remark" for f in link["findings"]) for link in links)
    more = f", {remarks} with remarks" if remarks else ""
    return f"{content['format']} {content['name']}: {judged} of {len(links)} links judged, {wrong} wrong{more}"


def _verdict(link: dict[str, Any]) -> str:
    if not link["findings"]:
        return str(link["verdict"])
    worst = max(link["findings"], key=lambda finding: LEVELS.index(finding["level"]))
    if worst["level"] == "remark":
        return "remark: " + "; ".join(dict.fromkeys(finding["text"] for finding in link["findings"]))
    return f"{worst['level'].upper()}: " + ", ".join(dict.fromkeys(
        f"{finding['what']} ({finding['cause']})" for finding in link["findings"]))


def _details(links: list[dict[str, Any]], least: str) -> None:
    out = console()
    for link in links:
        for finding in link["findings"]:
            if LEVELS.index(finding["level"]) < LEVELS.index(least) or finding["what"] == "massless":
                continue
            first, *rest = advice(link, finding)
            out.print(Text("\n" + first))
            for line in rest:
                out.print(Text("  " + line))


def _notes(content: dict[str, Any]) -> list[str]:
    """The notes of all links; many of one kind become one line."""
    kinds: dict[str, list[tuple[str, str]]] = collections.defaultdict(list)
    for link in content["links"]:
        for note in dict.fromkeys(link["notes"]):
            kinds[_kind(note)].append((link["name"], note))
    lines = []
    summed = " ".join(content["notes"])
    for kind, notes in kinds.items():
        if len(notes) <= FEW:
            lines += [f"{name}: {note}" for name, note in notes]
        elif notes[0][1] not in summed:
            names = {name for name, _ in notes}
            lines.append(f"{len(names)} links: {notes[0][1]}" + ("" if kind == notes[0][1] else "; and the like"))
    lines += content["notes"]
    if bare := [link["name"] for link in content["links"] if not link.get("compared", True)]:
        shown = bare if len(bare) <= 10 else [*bare[:10], f"and {len(bare) - 10} more"]
        lines.append(f"no geometry to compare with: {', '.join(shown)}")
    return lines


def _kind(note: str) -> str:
    """What notes of one kind have in common: all but the names within quotes, and what follows."""
    head, quote, rest = note.partition("'")
    return head + rest.rpartition("'")[2] if quote else note.partition(":")[0] if ": " in note else note


def advice(link: dict[str, Any], finding: dict[str, Any]) -> list[str]:
    """Return the lines of a finding: what is wrong, the likely cause, and what to write instead."""
    line = f", line {finding['line']}" if finding.get("line") else ""
    lines = [f"{link['name']}: {finding['text']} [{finding['code']}{line}]", f"likely   {finding['advice']}"]
    fixed = []
    if finding["mass"] is not None and finding["mass"] != link["mass"]:
        fixed.append(f"mass {finding['mass']:.6g}")
    if finding["com"] is not None and not np.allclose(finding["com"], link["com"], rtol=1e-9, atol=1e-12):
        fixed.append("centre of mass " + " ".join(f"{x:.6g}" for x in finding["com"]))
    if finding["matrix"] is not None and (link["matrix"] is None or finding["matrix"] != link["matrix"]):
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = finding["matrix"]
        fixed.append(f"ixx {xx:.6g}  iyy {yy:.6g}  izz {zz:.6g}  ixy {xy:.6g}  ixz {xz:.6g}  iyz {yz:.6g}")
    return lines + ([f"write    {'; '.join(fixed)}"] if fixed else [])
