"""Attitude Ephemeris Messages of the CCSDS (504.0-B-2), written as version 2.0, read as 1.0 and 2.0."""

from __future__ import annotations

import datetime
import math
import pathlib
import re
from typing import Any

import numpy as np

from .. import _files
from .._core import InvalidInput
from . import interpolate, times
from .ephemeris import AttitudeEphemeris

STATED = re.compile(r"attitude error at most ([0-9.e+-]+) rad")
BODY_FRAME = re.compile(
    r"(SC_BODY|SC_BUS|INSTRUMENT|ACC|AST|CSS|DSS|ESA|GYRO|IMU|MTA|RW|SA|SENSOR|STARTRACKER|TAM)(_|$)")
EPOCH = re.compile(r"epoch of the times (\S+)")


def write(path: pathlib.Path, made: AttitudeEphemeris) -> None:
    """Write the file whole or not at all."""
    now = datetime.datetime.now(datetime.UTC).replace(tzinfo=None)
    lines = ["CCSDS_AEM_VERS = 2.0", f"CREATION_DATE = {now.isoformat(timespec='seconds')}", "ORIGINATOR = POLHODE"]
    for first, last in made.segments:
        micros = np.rint(made.t[first:last] * 1e6).astype(np.int64)
        moments = [times.show(times.add(made.epoch, at)) for at in micros.tolist()]
        lines += ["", "META_START", f"COMMENT attitude error at most {round_up(made.error)} rad",
                  "COMMENT as interpolated by this file's method",
                  f"COMMENT epoch of the times {times.show(made.epoch)}",
                  f"OBJECT_NAME = {made.name}", f"OBJECT_ID = {made.name}", f"REF_FRAME_A = {made.frame}",
                  "REF_FRAME_B = SC_BODY_1", f"TIME_SYSTEM = {made.time_system}", f"START_TIME = {moments[0]}",
                  f"STOP_TIME = {moments[-1]}", "ATTITUDE_TYPE = QUATERNION",
                  f"INTERPOLATION_METHOD = {made.method.upper()}", f"INTERPOLATION_DEGREE = {made.degree}", "META_STOP",
                  "", "DATA_START"]
        lines += [f"{at} {x:.16f} {y:.16f} {z:.16f} {w:.16f}"
                  for at, (x, y, z, w) in zip(moments, made.attitude[first:last].tolist(), strict=True)]
        lines.append("DATA_STOP")
    _files.write(path, "\n".join(lines) + "\n")


def round_up(error: float) -> str:
    """Return the text of an error with four digits, not below it."""
    digits = max(-300, math.floor(math.log10(error)) - 3) if error > 0 else -300
    return f"{math.ceil(error / 10.0**digits) * 10.0**digits:.3e}"


def read(path: pathlib.Path) -> AttitudeEphemeris:
    """Read quaternions of an AEM, as rotations from body to space.

    Raises
    ------
    InvalidInput
        For another file, with the line.
    """
    text = _files.read(path, _files.MESH).decode("utf-8", errors="replace")
    return _Reader(path, text).made()


class _Reader:
    def __init__(self, path: pathlib.Path, text: str) -> None:
        self.path = path
        self.lines = text.splitlines()
        self.stated: list[float] = []
        self.epoch: datetime.datetime | None = None
        self.metas: list[dict[str, str]] = []
        self.moments: list[tuple[datetime.datetime, float]] = []
        self.rows: list[list[float]] = []
        self.segments: list[tuple[int, int]] = []
        self.head: dict[str, str] = {}
        self.open = False   # a block of data

    def fail(self, line: int, message: str) -> InvalidInput:
        return InvalidInput(f"{self.path}:{line + 1}: {message}")

    def made(self) -> AttitudeEphemeris:
        self._read()
        if not self.rows:
            raise InvalidInput(f"{self.path}: must be an AEM with attitudes, got none")
        epoch = self.epoch or self.moments[0][0]
        t = np.array([(whole - epoch).total_seconds() + rest for whole, rest in self.moments])
        rows = np.array(self.rows)
        for first, last in self.segments:
            if last - first < 2 or not np.all(np.diff(t[first:last]) > 0):
                raise InvalidInput(f"{self.path}: times of a segment must ascend, and be two at least")
            rows[first:last] = interpolate.make_continuous(rows[first:last])
        meta = self.metas[0]
        method = meta.get("INTERPOLATION_METHOD", "LINEAR").lower()
        if method not in interpolate.METHODS:
            raise InvalidInput(f"{self.path}: INTERPOLATION_METHOD must be one of LAGRANGE, LINEAR, "
                               f"got {method.upper()}")
        error = max(self.stated) if len(self.stated) == len(self.metas) else math.nan
        return AttitudeEphemeris(t, rows, error, epoch, meta.get("TIME_SYSTEM", "UTC"),
                                 meta.get("REF_FRAME_A", ""), meta.get("OBJECT_NAME", ""), method,
                                 self._degree(meta) if method == "lagrange" else 1, segments=tuple(self.segments))

    def _degree(self, meta: dict[str, str]) -> int:
        text = meta.get("INTERPOLATION_DEGREE", "")
        if not text.isdecimal() or not 1 <= int(text) <= 50:
            raise InvalidInput(f"{self.path}: INTERPOLATION_DEGREE must be a whole number from 1 to 50, got {text!r}")
        return int(text)

    def _read(self) -> None:
        into: dict[str, str] | None = self.head
        for k, raw in enumerate(self.lines):
            line = raw.strip()
            if not line:
                continue
            if line.startswith("COMMENT"):
                self._comment(line)
            elif line == "META_START":
                into = {}
                self.metas.append(into)
            elif line in ("META_STOP", "DATA_STOP"):
                into, self.open = None, False
            elif line == "DATA_START":
                self._check(k)
                self.segments.append((len(self.rows), len(self.rows)))
                into, self.open = None, True
            elif self.open:
                self._row(k, line)
            else:
                key, equals, value = line.partition("=")
                if not equals or into is None:
                    raise self.fail(k, f"must be a line 'KEY = value' of an AEM, got {line[:60]!r}")
                into[key.strip()] = value.strip()
        if self.open:
            raise InvalidInput(f"{self.path}: must end with DATA_STOP; it is cut short")
        if "CCSDS_AEM_VERS" not in self.head:
            raise InvalidInput(f"{self.path}: must be an AEM in the form of keys and values, with CCSDS_AEM_VERS")

    def _comment(self, line: str) -> None:
        if found := STATED.search(line):
            self.stated.append(float(found[1]))
        if found := EPOCH.search(line):
            whole, rest = times.parse(found[1], f"{self.path}: epoch")
            self.epoch = whole + datetime.timedelta(microseconds=round(rest * 1e6))

    def _check(self, line: int) -> None:
        meta: dict[str, Any] = self.metas[-1] if self.metas else {}
        kind = meta.get("ATTITUDE_TYPE", "")
        if kind.upper() != "QUATERNION":
            raise self.fail(line, f"ATTITUDE_TYPE must be QUATERNION, got {kind!r}")
        for key in ("REF_FRAME_A", "REF_FRAME_B"):
            if key not in meta:
                raise self.fail(line, f"the segment must state {key}")

    def _row(self, line: int, text: str) -> None:
        parts = text.split()
        if len(parts) != 5:
            raise self.fail(line, f"must be a time and four numbers, got {text[:60]!r}")
        try:
            row = [float(part) for part in parts[1:]]
        except ValueError:
            raise self.fail(line, f"must be a time and four numbers, got {text[:60]!r}") from None
        size = math.sqrt(sum(x * x for x in row))
        if not abs(size - 1.0) < 1e-3:
            raise self.fail(line, f"must be a unit quaternion, got the length {size!r}")
        meta = self.metas[-1]
        if meta.get("QUATERNION_TYPE", "LAST").upper() == "FIRST":
            row = [*row[1:], row[0]]
        to_body = meta.get("ATTITUDE_DIR", "A2B").upper() == "A2B"
        if _is_body(meta["REF_FRAME_A"]):
            to_body = not to_body
        if not to_body:
            row = [-row[0], -row[1], -row[2], row[3]]
        self.moments.append(times.parse(parts[0], f"{self.path}:{line + 1}"))
        self.rows.append(row)
        first, _ = self.segments[-1]
        self.segments[-1] = (first, len(self.rows))


def _is_body(frame: str) -> bool:
    return bool(BODY_FRAME.match(frame))


