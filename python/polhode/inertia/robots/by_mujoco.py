"""Bodies that only MuJoCo itself can read: composites, flexible bodies, masses of shells and of fitted shapes."""

from __future__ import annotations

import importlib.util
import json
import math
import pathlib
import subprocess
import sys
from typing import Any

import numpy as np

from ..._attitude.rotation import Rotation
from ..._core import InvalidInput
from ..._xml import Node
from .geometry import Assembly, Pose
from .link import Link
from .paths import Search

SECONDS = 60
# In a process of its own: a fault in MuJoCo ends that process alone.
_PROGRAM = """
import json, sys
import mujoco
model = mujoco.MjSpec.from_file(sys.argv[1]).compile()
json.dump([[model.body(i).name, float(model.body_mass[i]), *(getattr(model, part)[i].tolist() for part in
           ("body_ipos", "body_iquat", "body_inertia"))] for i in range(1, model.nbody)], sys.stdout)
"""


def complete(file: pathlib.Path, root: Node, links: list[Link], notes: list[str], search: Search, made: bool) -> None:
    """Fill in what the plain reader left out, where MuJoCo is installed and may open all that the file names.

    `made`: some elements make bodies that do not stand in the file.
    """
    missing = [link for link in links if link.from_geoms and link.matrix is None and link.unread]
    if not (missing or made) or importlib.util.find_spec("mujoco") is None or not _allowed(file, root, search):
        return
    bodies = _compile(file)
    if bodies is None:
        notes.append("MuJoCo does not compile the file: what the plain reader left out is not judged")
        return
    names = {link.name for link in links}
    for link in missing:
        _fill(link, bodies.get(link.name))
    for name in bodies if made else ():
        if name and name not in names:
            link = Link(name, file=str(file), from_geoms=True)
            _fill(link, bodies[name])
            links.append(link)


def _fill(link: Link, body: list[Any] | None) -> None:
    if body is None or not body[1] > 0:
        return
    _, mass, place, (w, x, y, z), moments = body
    link.mass, link.matrix, link.unjudged = mass, np.diag(moments), ""
    link.pose = Pose(np.asarray(Rotation.from_quat((x, y, z, w)).as_matrix()), np.array(place))
    left_out = {note for _, note in link.unread}
    link.notes = [note for note in link.notes if note not in left_out]
    link.visual, link.collision, link.unread = Assembly(), Assembly(), []
    link.notes.append("from its geoms, as MuJoCo computes them")


def _allowed(file: pathlib.Path, root: Node, search: Search) -> bool:
    """Return whether every file that is named lies where it may."""
    for node in root.walk():
        if node.tag in ("plugin", "extension"):
            return False
        for name in (value for key, value in node.attrib.items() if key.startswith("file")):
            try:
                search.find(name, file)
                if pathlib.PurePath(name).is_absolute() or ".." in pathlib.PurePath(name).parts:
                    search.check(file.parent / name, file)
            except InvalidInput:
                return False
        for key in ("meshdir", "texturedir", "assetdir"):
            if node.tag == "compiler" and node.get(key):
                try:
                    search.check(file.parent / (node.get(key) or ""), file)
                except InvalidInput:
                    return False
    return True


def _compile(file: pathlib.Path) -> dict[str, list[Any]] | None:
    try:
        done = subprocess.run([sys.executable, "-I", "-c", _PROGRAM, str(file.absolute())], capture_output=True,
                              timeout=SECONDS, cwd=file.absolute().parent, check=False)
        rows = json.loads(done.stdout) if done.returncode == 0 else []
    except (OSError, ValueError, subprocess.TimeoutExpired):
        return None
    numbers = [x for row in rows for x in (row[1], *row[2], *row[3], *row[4])]
    return {row[0]: row for row in rows} if rows and all(map(math.isfinite, numbers)) else None
