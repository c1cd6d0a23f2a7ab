"""Attitude files of STK (.a), version 11, as its help describes them."""

from __future__ import annotations

import datetime
import math
import pathlib
import re

import numpy as np

from .. import _files
from .._core import InvalidInput
from . import interpolate
from .aem import STATED, round_up
from .ephemeris import AttitudeEphemeris

MONTHS = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")
AXES = {"EME2000": "J2000", "GCRF": "ICRF"}   # names of the same axes
_DATE = re.compile(r"(\d{1,2}) ([A-Z][a-z]{2}) (\d{4}) (\d{2}):(\d{2}):(\d{2})(\.\d*)?")


def write(path: pathlib.Path, made: AttitudeEphemeris) -> None:
    """Write the file whole or not at all.

    Raises
    ------
    InvalidInput
        For another time system than UTC, the only one of these files.
    """
    if made.time_system != "UTC":
        raise InvalidInput(f"time_system: must be UTC for a file of STK, got {made.time_system!r}")
    epoch = made.epoch
    moment = f"{epoch.day} {MONTHS[epoch.month - 1]} {epoch.year} {epoch.time().isoformat(timespec='microseconds')}"
    lines = ["stk.v.11.0", f"# attitude error at most {round_up(made.error)} rad",
             "# as interpolated by this file's method", f"# object {made.name}", "BEGIN Attitude",
             f"NumberOfAttitudePoints {len(made.t)}", f"ScenarioEpoch {moment}",
             "InterpolationMethod Lagrange", f"InterpolationOrder {made.degree}", "CentralBody Earth",
             f"CoordinateAxes {AXES.get(made.frame, made.frame)}"]
    if len(made.segments) > 1:
        inner = [repr(float(made.t[first])) for first, _ in made.segments[1:]]
        lines += ["BEGIN SegmentBoundaryTimes", *inner, "END SegmentBoundaryTimes"]
    lines.append("BEGIN AttitudeTimeQuaternions")
    lines += [f"{t!r} {x:.16f} {y:.16f} {z:.16f} {w:.16f}"
              for t, (x, y, z, w) in zip(made.t.tolist(), made.attitude.tolist(), strict=True)]
    lines += ["END AttitudeTimeQuaternions", "END Attitude"]
    _files.write(path, "\n".join(lines) + "\n")


def read(path: pathlib.Path) -> AttitudeEphemeris:
    """Read times and quaternions of an attitude file of STK.

    Raises
    ------
    InvalidInput
        For another file, with the line.
    """
    lines = _files.read(path, _files.MESH).decode("utf-8", errors="replace").splitlines()
    if not lines or not re.match(r"stk\.v\.\d+", lines[0].strip()):
        raise InvalidInput(f"{path}: must be an attitude file of STK, whose first line is 'stk.v.11.0'")
    head: dict[str, str] = {}
    rows: list[list[float]] = []
    name, stated, inside, ended = "", math.nan, "", False
    for k, raw in enumerate(lines[1:], start=2):
        line = raw.strip()
        if line.startswith("#"):
            if found := STATED.search(line):
                stated = float(found[1])
            elif line.startswith("# object "):
                name = line.removeprefix("# object ")
        elif line.startswith("BEGIN "):
            inside = line.removeprefix("BEGIN ")
        elif line.startswith("END "):
            inside, ended = "Attitude", line == "END Attitude"
        elif inside == "Attitude" and line:
            key, _, value = line.partition(" ")
            head[key] = value.strip()
        elif inside == "AttitudeTimeQuaternions" and line:
            rows.append(_row(path, k, line))
    if not ended or head.get("NumberOfAttitudePoints", str(len(rows))) != str(len(rows)):
        raise InvalidInput(f"{path}: must have its NumberOfAttitudePoints and end with 'END Attitude'; it is cut short")
    return _make(path, head, np.array(rows).reshape(-1, 5), stated, name)


def _row(path: pathlib.Path, k: int, line: str) -> list[float]:
    try:
        row = [float(part) for part in line.split()]
    except ValueError:
        row = []
    if len(row) != 5 or not all(map(math.isfinite, row)) or not abs(math.hypot(*row[1:]) - 1.0) < 1e-3:
        raise InvalidInput(f"{path}:{k}: must be a time and a unit quaternion, got {line[:60]!r}")
    return row


def _make(path: pathlib.Path, head: dict[str, str], rows: np.ndarray, stated: float, name: str) -> AttitudeEphemeris:
    found = _DATE.match(head.get("ScenarioEpoch", ""))
    if found is None or found[2] not in MONTHS:
        raise InvalidInput(f"{path}: must have a ScenarioEpoch such as '1 Mar 2026 06:00:00', "
                           f"got {head.get('ScenarioEpoch', '')!r}")
    day, month, year, hour, minute, second, rest = found.groups()
    try:
        epoch = datetime.datetime(int(year), MONTHS.index(month) + 1, int(day), int(hour), int(minute), int(second),
                                  round(float(rest or "0") * 1e6))
    except ValueError as error:
        raise InvalidInput(f"{path}: ScenarioEpoch must be an instant of the calendar ({error})") from None
    order = head.get("InterpolationOrder", "1")
    if not order.isdecimal() or not 1 <= int(order) <= 50 or len(rows) < 2:
        raise InvalidInput(f"{path}: must have two AttitudeTimeQuaternions, and an InterpolationOrder from 1 to 50")
    t, attitude = rows[:, 0], rows[:, 1:].copy()
    joins = (np.flatnonzero(np.diff(t) <= 0) + 1).tolist()   # where segments meet, a time stands twice
    segments = tuple(zip([0, *joins], [*joins, len(t)], strict=True))
    for first, last in segments:
        if last - first < 2:
            raise InvalidInput(f"{path}: times must ascend, and twice the same only where two segments meet")
        attitude[first:last] = interpolate.make_continuous(attitude[first:last])
    names = {there: here for here, there in AXES.items()}
    axes = head.get("CoordinateAxes", "")
    degree = int(order)
    return AttitudeEphemeris(t, attitude, stated, epoch, "UTC", names.get(axes, axes), name,
                             "lagrange" if degree > 1 else "linear", degree, segments=segments)
