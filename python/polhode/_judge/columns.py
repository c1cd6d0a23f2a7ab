"""Which column is what: names of time, rates and attitudes, with the units and orders that they state."""

from __future__ import annotations

import dataclasses
import math
import re
from collections.abc import Sequence

from .._core import InvalidInput

TIMES = {"s": 1.0, "sec": 1.0, "secs": 1.0, "second": 1.0, "seconds": 1.0, "ms": 1e-3, "msec": 1e-3, "us": 1e-6,
         "usec": 1e-6, "µs": 1e-6, "ns": 1e-9, "nsec": 1e-9, "min": 60.0, "h": 3600.0}  # fmt: skip
RATES = {"rad/s": 1.0, "rad_s": 1.0, "rad s^-1": 1.0, "rad*s^-1": 1.0, "rad/sec": 1.0, "1/s": 1.0, "s^-1": 1.0,
         "deg/s": 0.0, "deg_s": 0.0, "dps": 0.0, "deg s^-1": 0.0, "deg/sec": 0.0, "°/s": 0.0,
         "rpm": 2 * math.pi / 60, "rev/s": 2 * math.pi, "turns/s": 2 * math.pi, "hz": 2 * math.pi}  # fmt: skip
ANGLES = {"rad": 1.0, "radians": 1.0, "deg": 0.0, "degrees": 0.0, "°": 0.0}
NONE = {"": 1.0, "-": 1.0, "1": 1.0, "none": 1.0}
UNITS = {"t": TIMES, "omega": RATES, "euler": ANGLES, "quaternion": NONE, "matrix": NONE}
PARTS = {"roll": "x", "pitch": "y", "yaw": "z", "heading": "z", "phi": "x", "theta": "y", "psi": "z"}

_OTHER = re.compile(r"(cov|bias|std|sigma|_var|acc|dot$|noise|cmd|ref_|error|lower|upper|desired|target|mag|^b_)")
_PART = r"_?(x|y|z|w|roll|pitch|yaw|heading|[0-4])$"
_RATE = re.compile(
    r"(?:^|_)(?:angular_?(?:rate|velocity|vel)|angvel|ang_vel|body_rate|gyro(?:scope)?|gyr|omega|rates?)"
    rf"(?:_(?!cov)[a-z]+)*?{_PART}"
)
_RATE_SHORT = re.compile(r"^(?:w(?:_[a-z]+_[a-z]+)?)_?(x|y|z|[0-3])$")
_RATE_NAMED = re.compile(r"(?:^|_)(roll|pitch|yaw)_?(?:rate|speed|velocity)$")
_QUATERNION = re.compile(r"(?:^|_)(?:orientation|quaternion|quat|attitude|att|rotation)_?(x|y|z|w|[0-4])$")
_QUATERNION_SHORT = re.compile(r"^q(?:_[a-z]+)?_?(x|y|z|w|[0-4])$")
_MATRIX = re.compile(r"(?:^|_)(?:r|m|dcm|rot|rotation|matrix)_?([0-3])_?([0-3])$")
_EULER = re.compile(r"(?:^|_)(?:euler|eulers|euler_angles?|angles?|rpy)(?:_[a-z]+)*?_?(x|y|z|roll|pitch|yaw|[0-3])$")
_EULER_SHORT = re.compile(r"^(roll|pitch|yaw|heading|phi|theta|psi)$")
_TIME = re.compile(r"^(?:t|time|time_?stamp|stamp|elapsed_time|sim_?time|seconds|secs?|(?:.*_)?header_stamp)$")
_TIME_UNIT = re.compile(r"(t|time|timestamp|stamp|time_stamp)_(ns|us|ms|s|nsec|usec|msec)")


@dataclasses.dataclass(frozen=True)
class Role:
    """What a column is: a channel, its part such as "x" or "0", and the unit that its name states, None without one."""

    channel: str
    part: str
    unit: str | None = None


@dataclasses.dataclass
class Choice:
    """The columns of each channel in its own order, by place, and what their names state."""

    t: int
    time_unit: float = 1.0
    omega: list[int] = dataclasses.field(default_factory=list)
    rate_unit: float | None = None  # 0 stands for degrees a second
    attitude: list[int] = dataclasses.field(default_factory=list)
    kind: str = ""  # "quaternion", "matrix" or "euler"
    order: str = "xyzw"
    euler: str | None = None
    angle_unit: float | None = None  # 0 stands for degrees
    notes: list[str] = dataclasses.field(default_factory=list)


def plain(name: str) -> tuple[str, str | None]:
    """Return a name in small letters with `_` between its words, and the unit that it states."""
    text, unit = name.strip().strip('"').lstrip("%."), None
    if (found := re.search(r"\s*[\[(]([^\[\]()]*)[\])]$", text)) and not found[1].strip().isdigit():
        text, unit = text[: found.start()], found[1].strip()
    text = re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", text).lower()
    text = re.sub(r"[^a-z0-9]+", "_", text).strip("_")
    for known in ("deg_s", "rad_s", "dps", "rpm", "deg", "rad"):
        if (found := re.search(rf"_{known}(?=_|$)", text)) and unit is None:
            text, unit = text[: found.start()] + text[found.end() :], known
            break
    if unit is None and (found := _TIME_UNIT.fullmatch(text)):
        text, unit = found[1], found[2]
    return text, unit


def role(name: str) -> Role | None:
    """Return what a name says, or None."""
    text, unit = plain(name)
    if _OTHER.search(text):
        return None
    if _TIME.match(text):
        return Role("t", "", unit)
    for channel, *patterns in (
        ("omega", _RATE_NAMED, _RATE, _RATE_SHORT),
        ("quaternion", _QUATERNION, _QUATERNION_SHORT),
        ("matrix", _MATRIX),
        ("euler", _EULER, _EULER_SHORT),
    ):
        for pattern in patterns:
            if found := pattern.search(text):
                part = "".join(found.groups())
                return Role(channel, PARTS.get(part, part), unit)
    return None


def choose(names: Sequence[str], order: str | None, euler: str | None) -> Choice:
    """Choose the columns of time, rates and attitude by their names.

    Raises
    ------
    InvalidInput
        Without a time, for names that come twice or leave the order open, and for units that are not known.
    """
    roles = [role(name) for name in names]
    lower = [plain(name)[0] for name in names]
    if {"p", "q", "r"} <= set(lower):
        for part, letter in zip("pqr", "xyz", strict=True):
            place = lower.index(part)
            roles[place] = Role("omega", letter, plain(names[place])[1])
    placed: dict[str, dict[str, int]] = {}
    for k, found in enumerate(roles):
        if found is None:
            continue
        parts = placed.setdefault(found.channel, {})
        if found.part in parts:
            first = names[parts[found.part]]
            if first == names[k]:
                raise InvalidInput(f"column {first!r}: must come once, got two columns of this name")
            if found.channel == "t":
                continue
            raise InvalidInput(f"columns {first!r} and {names[k]!r}: both name one thing; choose one by --columns")
        parts[found.part] = k
    if "t" not in placed:
        raise InvalidInput(f"the time: must have a column such as 't', got {_list(names)}")
    choice = Choice(placed["t"][""])
    choice.time_unit = _unit(names, roles, [choice.t], "t") or 1.0
    if choice.time_unit != 1.0:
        choice.notes.append(f"times in {_said(roles, [choice.t])}")
    if "omega" in placed:
        choice.omega = _vector(names, placed["omega"], "the rates")
        choice.rate_unit = _unit(names, roles, choice.omega, "omega")
        if choice.rate_unit not in (None, 1.0):
            choice.notes.append(f"rates in {_said(roles, choice.omega)}")
    for kind in ("quaternion", "matrix", "euler"):
        if kind in placed and (found_places := _attitude(names, placed[kind], kind, order, euler, choice)):
            choice.attitude, choice.kind = found_places, kind
            break
    if euler is not None and choice.kind != "euler":
        raise InvalidInput(f"--euler: must be used with Euler angles, got {choice.kind or 'no attitude'}")
    if choice.kind == "euler":
        choice.angle_unit = _unit(names, roles, choice.attitude, "euler")
        if choice.angle_unit == 0.0:
            choice.notes.append("angles in degrees")
    if not choice.omega and not choice.attitude:
        raise InvalidInput(f"the motion: must have columns such as qx, qy, qz, qw or wx, wy, wz, got {_list(names)}")
    if order is not None and choice.kind == "quaternion" and not _counted(placed["quaternion"]):
        raise InvalidInput(f"--order: must be left out, as the columns name the scalar; got {order!r}")
    return choice


def _list(names: Sequence[str]) -> str:
    text = ", ".join(name.strip() for name in names)
    return text if len(text) <= 60 else text[:57] + "..."


def _counted(parts: dict[str, int]) -> bool:
    return all(part.isdigit() for part in parts)


def _vector(names: Sequence[str], parts: dict[str, int], what: str) -> list[int]:
    for keys in ("xyz", "123", "012"):
        if set(keys) == set(parts):
            return [parts[key] for key in keys]
    given = ", ".join(repr(names[k]) for k in parts.values())
    raise InvalidInput(f"{what}: must have three columns such as wx, wy, wz, got {given}")


def _attitude(
    names: Sequence[str], parts: dict[str, int], kind: str, order: str | None, euler: str | None, choice: Choice
) -> list[int]:
    """Return the places of an attitude's columns."""
    given = ", ".join(names[k].strip() for k in parts.values())
    if kind == "matrix":
        for keys in ("123", "012"):
            if {a + b for a in keys for b in keys} == set(parts):
                return [parts[a + b] for a in keys for b in keys]
        return []
    if kind == "quaternion":
        if set(parts) == set("xyzw"):
            if min(parts, key=lambda key: parts[key]) == "w":
                choice.notes.append("quaternions with the scalar first")
            return [parts[key] for key in "xyzw"]
        if len(parts) == 4 and _counted(parts):
            if order is None:
                raise InvalidInput(f"columns {given}: do not say where the scalar is; tell it by --order wxyz or xyzw")
            choice.order = order
            return [parts[key] for key in sorted(parts)]
        raise InvalidInput(f"the quaternion: must have four columns such as qx, qy, qz, qw, got {given}")
    if set(parts) == set("xyz"):
        choice.euler = euler or "ZYX"
        letters = choice.euler.lower()
        if set(letters) != set("xyz"):
            raise InvalidInput(f"--euler: must have each of x, y, z with columns {given}, got {euler!r}")
        if euler is None:
            choice.notes.append("angles of the sequence ZYX: yaw, pitch, roll")
        return [parts[letter] for letter in letters]
    places = _vector(names, parts, "the angles")
    if euler is None:
        raise InvalidInput(f"columns {given}: do not say their sequence; tell it by --euler, such as --euler ZXZ")
    choice.euler = euler
    return places


def _said(roles: Sequence[Role | None], places: Sequence[int]) -> str:
    first = roles[places[0]]
    return {"deg_s": "deg/s", "rad_s": "rad/s"}.get(first.unit or "", first.unit or "") if first else ""


def _unit(names: Sequence[str], roles: Sequence[Role | None], places: Sequence[int], channel: str) -> float | None:
    """Return the factor of the unit that columns state, None where they state none."""
    found = {r.unit.lower() if r and r.unit is not None else None for r in (roles[k] for k in places)}
    if len(found) > 1:
        raise InvalidInput(f"column {names[places[0]]!r}: must have the unit of its neighbours, as all of one vector")
    unit = found.pop()
    if unit is None:
        return None
    if unit not in UNITS[channel]:
        raise InvalidInput(f"column {names[places[0]]!r}: has the unknown unit {unit!r}; name columns by --columns")
    return UNITS[channel][unit]
