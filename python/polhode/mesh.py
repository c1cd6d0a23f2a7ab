"""Triangles from mesh files: STL directly; OBJ, PLY, OFF, glTF and COLLADA by trimesh (the `mesh` extra).

The counts in a file are compared with its size before anything is read.
"""

from __future__ import annotations

import contextlib
import io
import json
import logging
import os
import pathlib
import re
import struct
import urllib.parse
import warnings
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _files
from ._core import InvalidInput

__all__ = ["read", "report"]

Vertices = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]

FORMATS = (".stl", ".obj", ".ply", ".gltf", ".glb", ".off", ".dae")


def read(path: str | os.PathLike[str]) -> tuple[Vertices, Faces]:
    """Read the triangles of a mesh file; several objects of one file are joined in their places.

    Parameters
    ----------
    path : str or PathLike
        STL (binary or ASCII), OBJ, PLY, OFF, glTF or COLLADA (.dae), by its suffix.

    Returns
    -------
    vertices : ndarray, shape (n, 3)
        In the file's unit and order. Of COLLADA in metres by its `<unit>`; its `<up_axis>` is left out, as by ROS
        and Gazebo. An STL file has three vertices for each face.
    faces : ndarray, shape (m, 3)
        Indices of the vertices of each triangle.

    Raises
    ------
    InvalidInput
        For a file that cannot be read, is truncated, or claims more data than it has.
    """
    file = _files.to_path(path, "path")
    kind = file.suffix.lower()
    if kind not in FORMATS:
        raise InvalidInput(f"{file}: must be a mesh file, one of {', '.join(FORMATS)}; got {kind or 'no suffix'!r}")
    data = _files.read(file, _files.TEXT if kind == ".gltf" else _files.MESH)
    try:
        vertices, faces = _stl(data) if kind == ".stl" else _by_trimesh(file, data)
    except _Wrong as error:
        raise InvalidInput(f"{file}: {error}") from None
    if len(faces) == 0:
        raise InvalidInput(f"{file}: must hold one triangle or more, got none")
    return vertices, faces


def report(vertices: npt.ArrayLike, faces: npt.ArrayLike, *, weld: float = 1e-9) -> dict[str, Any]:
    """Judge whether triangles are the surface of a body; an open surface is described, not refused.

    Parameters
    ----------
    vertices : array_like, shape (n, 3)
    faces : array_like of integers, shape (m, 3)
    weld : float
        Vertices of open edges nearer than this part of "size" count as one, as in
        :meth:`polhode.MassProperties.from_mesh`.

    Returns
    -------
    dict
        "faces"; "closed"; "open_edges": edges of one face; "turned_edges": of two faces that pass them in one
        direction; "crowded_edges": of more than two faces; "hole_count"; "holes": "edges", "centre" and "radius" of the
        100 largest loops of open edges; "closes_at": the `weld` that closes an open surface, or None; "errors": bounds
        of what the holes can change, see Notes; "components": surfaces that share no edge, including cavities;
        "cavities": surfaces wound inward inside another; "strays": surfaces wound inward inside no other; "embedded":
        surfaces wound outward inside a solid, which count twice; "unjudged": surfaces whose nesting was not checked,
        because there are too many; "degenerate": faces with two equal corners, which are ignored; "merged": True if
        equal vertices were merged; "welded": vertices that took another's place; "moved": the farthest that one moved;
        "inside_out"; "size": the longest side of the bounding box; "low" and "high": its corners, shape (3,). Nesting
        is not checked on an open surface.

    Raises
    ------
    InvalidInput
        Wrong indices; vertices that are not finite; only faces without area.

    Notes
    -----
    "errors" bounds what :meth:`polhode.MassProperties.from_mesh` returns with `check=False` and a density: "mass"
    relative to its mass; "centre" in units of the vertices; "inertia" relative to its largest moment, in the spectral
    norm. What is missing is assumed to lie in the ball about a hole's centre through the farthest vertex of its loop,
    and not to cross itself. A bound is inf where a hole is too large for it.
    """
    return _core.mesh_report(vertices, faces, weld)


class _Wrong(Exception):
    """An error in a file, without the file's name."""


# ---- STL


def _stl(data: bytes) -> tuple[Vertices, Faces]:
    corners = _ascii_stl(data) if _is_ascii(data) else _binary_stl(data)
    return corners, np.arange(len(corners), dtype=np.int64).reshape(-1, 3)


def _is_ascii(data: bytes) -> bool:
    """Return True for an ASCII file. Binary files may begin with "solid", too."""
    if not data.lstrip()[:5].lower() == b"solid":
        return False
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        return False
    return b"\0" not in data[:512]


def _binary_stl(data: bytes) -> Vertices:
    if len(data) < 84:
        raise _Wrong(f"must be a binary STL file of 84 bytes or more, got {len(data)} (cut short?)")
    (count,) = struct.unpack_from("<I", data, 80)
    if len(data) != 84 + 50 * count:
        held = max(0, (len(data) - 84) // 50)
        raise _Wrong(f"claims {count} triangles, which take {84 + 50 * count} bytes, but has {len(data)} bytes, "
                     f"room for {held} (cut short?)")
    rows = np.frombuffer(data, np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("more", "<u2")]), count, 84)
    return rows["corners"].reshape(-1, 3).astype(np.float64)


def _ascii_stl(data: bytes) -> Vertices:
    words = re.findall(rb"^\s*vertex\s+(\S+)\s+(\S+)\s+(\S+)\s*$", data, flags=re.I | re.M)
    loops, ends = (len(re.findall(word, data, flags=re.I | re.M)) for word in (rb"^\s*outer\s+loop", rb"^\s*endloop"))
    solids, closed = (len(re.findall(word, data, flags=re.I | re.M)) for word in (rb"^\s*solid\b", rb"^\s*endsolid\b"))
    if len(words) != 3 * loops or loops != ends or solids != closed:
        raise _Wrong(f"has {solids} solids with {closed} ends and {loops} triangles with {ends} ends and {len(words)} "
                     "corners (cut short?)")
    try:
        return np.array(words, dtype="S").astype(np.float64).reshape(-1, 3)
    except ValueError as error:
        raise _Wrong(f"holds a corner that is no number: {error}") from None


# ---- through trimesh


def _by_trimesh(file: pathlib.Path, data: bytes) -> tuple[Vertices, Faces]:
    kind = file.suffix.lower()
    unit = 1.0
    if kind == ".obj":
        data = _absolute(data)
    elif kind == ".ply":
        _require_ply_claims(data)
    elif kind == ".off":
        _require_off_claims(data)
    elif kind == ".dae":
        unit = _collada_unit(data, file)
    else:
        _require_gltf_claims(kind, data, file)
    try:
        import trimesh
    except ImportError:
        raise _Wrong(f"{kind} files need trimesh: pip install 'polhode[mesh]'") from None
    try:
        # No tidying: what the file holds is what is judged.
        if kind == ".dae":
            # Before trimesh misses it.
            import collada  # type: ignore[import-untyped, import-not-found, unused-ignore]  # noqa: F401

            with _silent():   # its log is about textures
                scene = trimesh.load(io.BytesIO(data), file_type="dae", force="scene", process=False)
            vertices, faces = _join(scene)
            return vertices * unit, faces
        if kind == ".obj":   # its materials are not looked for
            with warnings.catch_warnings():   # of normals at vertices that no face uses
                warnings.simplefilter("ignore", RuntimeWarning)
                return _join(trimesh.load(io.BytesIO(data), file_type="obj", force="scene", process=False,
                                          maintain_order=True, skip_materials=True))
        return _join(trimesh.load(file, force="scene", process=False, maintain_order=True, skip_materials=True))
    except ImportError:
        raise _Wrong(f"{kind} files need pycollada: pip install 'polhode[mesh]'") from None
    except (MemoryError, _Wrong):
        raise
    except Exception as error:   # a reader of foreign bytes may raise anything
        raise _Wrong(f"cannot be read as {kind[1:].upper()}: {type(error).__name__}: {error}") from None


def _absolute(data: bytes) -> bytes:
    """Count the corners of an OBJ file's faces from 1, where they are counted back from the last line before them."""
    if not re.search(rb"^[ \t]*f[ \t][^\n]*-", data, flags=re.M):
        return data
    counts = {b"v": 0, b"vt": 0, b"vn": 0}
    lines = data.replace(b"\\\n", b" ").replace(b"\\\r\n", b" ").split(b"\n")
    for i, line in enumerate(lines):
        words = line.split()
        if not words:
            continue
        if words[0] in counts:
            counts[words[0]] += 1
        elif words[0] == b"f":
            lines[i] = b" ".join([b"f", *(_corner(word, (*counts.values(),)) for word in words[1:])])
    return b"\n".join(lines)


def _corner(word: bytes, counts: tuple[int, ...]) -> bytes:
    """A corner v/vt/vn with numbers from 1."""
    parts = word.split(b"/")
    for k, (part, count) in enumerate(zip(parts, counts)):
        if re.fullmatch(rb"-\d{1,18}", part):
            number = count + 1 + int(part)
            if number < 1:
                raise _Wrong(f"cannot be read as OBJ: a face names vertex {part.decode()}, but {count} stand before it")
            parts[k] = str(number).encode()
    return b"/".join(parts)


@contextlib.contextmanager
def _silent() -> Iterator[None]:
    logger = logging.getLogger("trimesh")
    level = logger.level
    logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        logger.setLevel(level)


def _join(scene: Any) -> tuple[Vertices, Faces]:
    """Join all objects of a scene in their places; a mirrored object keeps its outside."""
    vertices, faces, count = [np.empty((0, 3))], [np.empty((0, 3), np.int64)], 0
    for node in sorted(scene.graph.nodes_geometry):
        transform, name = scene.graph[node]
        part = scene.geometry[name]
        if len(getattr(part, "faces", ())) == 0:
            continue   # points, lines
        triangles = np.asarray(part.faces, np.int64) + count
        placed = np.asarray(part.vertices, np.float64)
        if placed.ndim != 2 or placed.shape[1] != 3 or triangles.ndim != 2 or triangles.shape[1] != 3:
            raise _Wrong(f"holds vertices of shape {placed.shape} and faces of shape {triangles.shape}: must be (n, 3)")
        if not np.array_equal(transform, np.eye(4)):
            placed = placed @ transform[:3, :3].T + transform[:3, 3]
            if np.linalg.det(transform[:3, :3]) < 0:
                triangles = triangles[:, ::-1]
        vertices.append(placed)
        faces.append(triangles)
        count += len(placed)
    return np.concatenate(vertices), np.concatenate(faces)


def _require_ply_claims(data: bytes) -> None:
    header, end, _ = data.partition(b"end_header")
    if not data.startswith(b"ply") or not end:
        raise _Wrong("must begin with a PLY header, which has an end (cut short?)")
    for name, count in re.findall(rb"^element\s+(\S+)\s+(\S+)", header, flags=re.M):
        if not count.isdigit() or len(count) > 18 or int(count) > len(data):
            raise _Wrong(f"claims {_short(count)} of element {_short(name)}, but has "
                         f"{len(data)} bytes (cut short?)")


def _short(word: bytes) -> str:
    text = word.decode(errors="replace")
    return text if len(text) <= 40 else f"{text[:37]}..."


def _require_off_claims(data: bytes) -> None:
    counts = re.match(rb"\s*[A-Z4n]*OFF(?:\s*#[^\n]*\n)*\s*(\d{1,18})\s+(\d{1,18})", data)
    if counts is None:
        raise _Wrong("must begin with OFF and the counts of vertices and faces (cut short?)")
    if max(int(counts[1]), int(counts[2])) > len(data):
        raise _Wrong(f"claims {counts[1].decode()} vertices and {counts[2].decode()} faces, but has {len(data)} bytes "
                     "(cut short?)")


def _collada_unit(data: bytes, file: pathlib.Path) -> float:
    """Refuse entities, and return the length of the file's unit [m]."""
    from ._xml import parse_bytes

    try:
        root = parse_bytes(data, str(file))
    except InvalidInput as error:
        raise _Wrong(str(error).removeprefix(f"{file}: ")) from None
    for node in root.walk():
        if node.tag == "unit" and node.parent is not None and node.parent.tag == "asset":
            try:
                length = float(node.get("meter") or "1")
            except ValueError:
                length = 0.0
            if not 1e-12 < length < 1e12:
                raise _Wrong(f"has a unit of {node.get('meter')!r} m")
            return length
        if node.tag.startswith("library_"):
            break
    return 1.0


def _require_gltf_claims(kind: str, data: bytes, file: pathlib.Path) -> None:
    """Refuse counts in a glTF file that its bytes do not support."""
    if kind == ".glb":
        if len(data) < 20 or data[:4] != b"glTF":
            raise _Wrong("must begin with a glTF header (cut short?)")
        length, chunk = struct.unpack_from("<II", data, 8)
        if length != len(data) or chunk > len(data) - 20:
            raise _Wrong(f"claims {length} bytes with {chunk} of them JSON, but has {len(data)} (cut short?)")
        data = data[20:20 + chunk]
    try:
        content = json.loads(data)
        _require_gltf_sense(content, len(data), file)
    except (ValueError, AttributeError, KeyError, TypeError, RecursionError) as error:
        raise _Wrong(f"holds no glTF: {type(error).__name__}: {error}") from None


# What changes colours alone.
HARMLESS = ("KHR_materials_", "KHR_texture_", "EXT_texture_", "KHR_lights_")


def _require_gltf_buffer(uri: str, file: pathlib.Path) -> None:
    """Refuse data outside the folder of the file, and what is no regular file."""
    if uri.startswith("data:"):
        return
    beside = file.parent.resolve()
    named = (beside / urllib.parse.unquote(uri)).resolve()
    if not named.is_relative_to(beside):
        raise _Wrong(f"cannot be read as GLTF: it names {uri!r}, which lies outside its folder")
    try:
        _files.size_of(named, _files.MESH)
    except InvalidInput as error:
        raise _Wrong(f"cannot be read as GLTF: {error}") from None


def _require_gltf_sense(content: dict[str, Any], size: int, file: pathlib.Path) -> None:
    """Refuse parts that trimesh would skip silently, and counts without data."""
    for accessor in content.get("accessors", []):
        if "sparse" in accessor:
            raise _Wrong("has sparse accessors, which are not read")
        if "bufferView" not in accessor and not 0 <= accessor["count"] <= size:
            raise _Wrong(f"claims {accessor['count']} entries of data that it does not hold")
    for buffer in content.get("buffers", []):
        _require_gltf_buffer(buffer.get("uri", "data:"), file)
    required = [name for name in content.get("extensionsRequired", []) if not name.startswith(HARMLESS)]
    if required:
        raise _Wrong(f"needs {', '.join(map(str, required))}, which is not read: export it without")
    modes = {p.get("mode", 4) for mesh in content.get("meshes", []) for p in mesh["primitives"]}
    if not modes <= {0, 1, 2, 3, 4, 5}:   # points and lines have no volume; fans are left out
        raise _Wrong(f"has primitives of mode {max(modes)}, which are not read: export triangles")
    meshes, nodes = len(content.get("meshes", [])), content.get("nodes", [])
    parents: set[int] = set()
    for i, node in enumerate(nodes):
        if not 0 <= node.get("mesh", 0) < max(meshes, 1):
            raise _Wrong(f"has {meshes} meshes, but node {i} names mesh {node['mesh']}")
        for child in node.get("children", []):
            if not 0 <= child < len(nodes) or child in parents or child == i:
                raise _Wrong(f"is no tree of nodes: node {i} has the child {child}, which is missing or has a parent")
            parents.add(child)
    roots = {node for scene in content.get("scenes", []) for node in scene.get("nodes", [])}
    if roots & parents:
        raise _Wrong(f"is no tree of nodes: the scene holds node {min(roots & parents)}, which has a parent")
