"""Findings about a robot description: one line for each link, and advice for each finding."""

from __future__ import annotations

import math
import pathlib
from typing import Any

import numpy as np

from ..inertia import robots
from ..inertia.findings import Finding
from ..inertia.robots import Link


def is_robot(file: str) -> bool:
    """Return True if the suffix is that of a robot description."""
    return pathlib.Path(file).suffix.lower() in robots.suffixes


def examine(file: str) -> dict[str, Any]:
    """Check every link of a file."""
    robot = robots.read(file)
    links = [_plain(_link(link)) for link in robot.links]
    return {"file": str(file), "format": robot.kind, "name": robot.name,
            "valid": not any(link["findings"] for link in links), "notes": robot.notes, "links": links}


def _link(link: Link) -> dict[str, Any]:
    content: dict[str, Any] = {"name": link.name, "mass": link.mass, "com": None, "moments": None, "matrix": None,
                               "verdict": f"not judged: {link.unjudged}", "findings": [], "notes": link.notes}
    diagnosis = link.diagnose()
    if diagnosis is None or link.matrix is None:
        return content
    content["com"] = link.pose.place.tolist()
    content["verdict"] = diagnosis.verdict
    if np.isfinite(link.matrix).all():
        content["matrix"] = link.matrix.tolist()
        content["moments"] = np.linalg.eigvalsh(link.matrix).tolist()
        content["margin"] = diagnosis.margin
    content["misfit"] = diagnosis.misfit
    content["compared"] = bool(link.visual.parts or link.collision.parts or "from its geoms" in link.notes)
    content["findings"] = [_finding(finding, link) for finding in diagnosis.findings]
    return content


def _plain(content: Any) -> Any:
    """Replace numbers that are not finite by None, because JSON has none."""
    if isinstance(content, dict):
        return {key: _plain(value) for key, value in content.items()}
    if isinstance(content, list):
        return [_plain(value) for value in content]
    return None if isinstance(content, float) and not math.isfinite(content) else content


def _finding(finding: Finding, link: Link) -> dict[str, Any]:
    content = finding.to_dict()
    if finding.com is not None:
        com = link.pose.turn @ finding.com   # in the link's axes, as in the file
        content["com"] = np.where(np.abs(com) < 1e-9 * np.abs(com).max(), 0.0, com).tolist()
    return content


def advice(link: dict[str, Any], finding: dict[str, Any]) -> list[str]:
    """Return the lines of a finding: what is wrong, the likely cause, and what to write instead."""
    lines = [f"{link['name']}: {finding['text']}", f"likely   {finding['advice']}"]
    fixed = []
    if finding["mass"] is not None and finding["mass"] != link["mass"]:
        fixed.append(f"mass {finding['mass']:.6g}")
    if finding["com"] is not None and not np.allclose(finding["com"], link["com"], rtol=1e-9, atol=0):
        fixed.append("centre of mass " + " ".join(f"{x:.6g}" for x in finding["com"]))
    if finding["matrix"] is not None and (link["matrix"] is None or finding["matrix"] != link["matrix"]):
        (xx, xy, xz), (_, yy, yz), (_, _, zz) = finding["matrix"]
        fixed.append(f"ixx {xx:.6g}  iyy {yy:.6g}  izz {zz:.6g}  ixy {xy:.6g}  ixz {xz:.6g}  iyz {yz:.6g}")
    return lines + ([f"write    {'; '.join(fixed)}"] if fixed else [])
