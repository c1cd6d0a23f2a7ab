"""Files of motions: tables of text, and arrays in NPZ, JSON and MAT, as samples with what the file states of them."""

from __future__ import annotations

import dataclasses
import io
import pathlib
import zipfile
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .. import _files
from .._attitude.rotation import Rotation
from .._core import InvalidInput
from .columns import Choice, choose, plain
from .read import SEQUENCES, numbers
from .states import Array
from .table import MOST, MOST_ROWS, Table, short

TEXTS = (".csv", ".tsv", ".txt", ".dat", ".tum")
SUFFIXES = (*TEXTS, ".npz", ".json", ".mat")
TUM = ("t", "x", "y", "z", "qx", "qy", "qz", "qw")
ARRAYS = {
    "t": ("t", "time", "times", "timestamp", "timestamps"),
    "omega": ("omega", "w", "rates", "angular_velocity", "gyro", "gyr", "imu_gyr"),
    "attitude": ("attitude", "q", "quat", "quaternion", "quaternions", "orientation", "rotation", "euler", "opt_quat"),
}
EARTH = 7.292115e-5  # rad/s
EARTH_SOURCE = "WGS 84: the Earth turns by 7.292115e-5 rad/s"


@dataclasses.dataclass
class Source:
    """Samples of a file, as arguments of `polhode.judge`, with the line of each row and remarks."""

    t: Array
    attitude: Array | None
    omega: Array | None
    order: str = "xyzw"
    euler: str | None = None
    degrees: bool = False
    lines: Sequence[int] = ()
    notes: tuple[str, ...] = ()


def load(
    name: str | pathlib.Path,
    columns: str | None = None,
    order: str | None = None,
    euler: str | None = None,
    degrees: bool = False,
) -> Source:
    """Read a motion. `columns` names the columns of a table in their order, or arrays as `t=time,omega=gyr`.

    Raises
    ------
    InvalidInput
        For a file that is none, or that does not say what it holds; the message has the line, the column or the array.
    """
    file = _files.to_path(name, "file")
    suffix = file.suffix.lower()
    if suffix not in SUFFIXES:
        raise InvalidInput(f"{file}: must be one of {', '.join(SUFFIXES)}")
    if euler is not None and euler.upper() not in SEQUENCES:
        raise InvalidInput(f"--euler: must be one of the 24 sequences such as ZYX or zyx, got {euler!r}")
    if order not in (None, "xyzw", "wxyz"):
        raise InvalidInput(f"--order: must be xyzw or wxyz, got {order!r}")
    if suffix in TEXTS:
        return _from_text(file, columns, order, euler, degrees)
    return _from_arrays(file, _arrays(file, suffix), columns, order, euler, degrees)


def _from_text(file: pathlib.Path, columns: str | None, order: str | None, euler: str | None, degrees: bool) -> Source:
    table = Table(file)
    names = [part.strip() for part in columns.split(",")] if columns else table.names
    notes = []
    if not names:
        if len(table.cells(table.rows[0])) != 8 or table.separator is not None:
            raise InvalidInput(f"{file}: must have a header, or --columns must name its {table.width} columns")
        names = list(TUM)
        notes.append("the columns of TUM: t, position, qx, qy, qz, qw")
    if len(names) != table.width and columns:
        raise InvalidInput(f"--columns: must name the {table.width} columns of {file}, got {len(names)} names")
    try:
        choice = choose(names, order, euler)
    except InvalidInput as error:
        raise InvalidInput(f"{file}: {error}") from None
    notes += choice.notes
    local = _local(names, choice)
    places = [choice.t, *choice.omega, *choice.attitude, *local]
    values = table.numbers(places)
    t = values[:, 0] * choice.time_unit
    if values[0, 0] > 1e15 and (whole := table.integers(choice.t)) is not None:
        unit = choice.time_unit
        if unit == 1.0 and "time_unit" not in names and 1e17 < values[0, 0] < 1e20:
            unit = 1e-9  # the stamps of ROS
            notes.append("times in ns, as the stamps of ROS are")
        t = (whole - whole[0]) * unit
        notes.append(f"times counted from the first, {whole[0]}")
    omega = values[:, 1 : 1 + len(choice.omega)] if choice.omega else None
    attitude = values[:, 1 + len(choice.omega) : len(places) - len(local)] if choice.attitude else None
    omega, attitude, in_degrees = _in_one_unit(omega, attitude, choice, degrees)
    if choice.kind == "matrix" and attitude is not None:
        attitude = attitude.reshape(-1, 3, 3)
    source = Source(t, attitude, omega, choice.order, choice.euler, in_degrees, table.lines)
    if local:
        _to_space(source, values[:, len(places) - 2 :], notes)
    source.notes = tuple(notes)
    return source


def _in_one_unit(
    omega: Array | None, attitude: Array | None, choice: Choice, degrees: bool
) -> tuple[Array | None, Array | None, bool]:
    """Return rates and attitudes, and whether both are in degrees: digits are counted in the file's own unit."""
    rates = None if omega is None else choice.rate_unit
    angles = choice.angle_unit if choice.kind == "euler" else None
    stated = [unit for unit in (rates, angles) if unit is not None]
    if degrees and any(stated):
        raise InvalidInput("--degrees: must be left out, as the columns state radians")
    if rates:  # not degrees
        assert omega is not None
        omega = omega * rates
    unknown = 0.0 if degrees else 1.0
    rate_degrees = (unknown if rates is None else rates) == 0.0
    angle_degrees = (unknown if angles is None else angles) == 0.0
    if omega is None or choice.kind != "euler" or rate_degrees == angle_degrees:
        return omega, attitude, rate_degrees if omega is not None else angle_degrees
    if rate_degrees:
        omega = np.radians(omega)
    else:
        assert attitude is not None
        attitude = np.radians(attitude)
    return omega, attitude, False


def _local(names: Sequence[str], choice: Choice) -> list[int]:
    """Return the columns of longitude and latitude of a table of NESC, whose angles are of axes that go with them."""
    known = {plain(name)[0]: k for k, name in enumerate(names)}
    wanted = ("longitude", "latitude")
    nesc = choice.kind == "euler" and any("eulerAngle_deg" in name for name in names)
    return [known[name] for name in wanted] if nesc and all(name in known for name in wanted) else []


def _to_space(source: Source, place: Array, notes: list[str]) -> None:
    """Turn the angles of local axes (north, east, down) into attitudes in axes that do not turn with the Earth."""
    assert source.attitude is not None
    longitude = np.radians(place[:, 0]) + EARTH * source.t
    zero = np.zeros(len(longitude))
    down = np.stack([longitude, -np.pi / 2 - np.radians(place[:, 1]), zero], axis=1)
    local = Rotation.from_euler("ZYX", down)
    angles = np.radians(source.attitude) if source.degrees else source.attitude
    good = np.isfinite(angles).all(axis=1) & np.isfinite(down).all(axis=1)
    quaternions = np.full((len(angles), 4), np.nan)
    if good.any():
        own = Rotation.from_euler(source.euler or "ZYX", angles[good])
        quaternions[good] = (Rotation.from_quat(local.as_quat()[good]) * own).as_quat()
    source.attitude, source.euler = quaternions, None
    notes.append(f"angles of local axes, with longitude and latitude; {EARTH_SOURCE}")


# ---- arrays


def _arrays(file: pathlib.Path, suffix: str) -> dict[str, Any]:
    """Return the arrays of a file by their names."""
    if suffix == ".json":
        content = _files.read_json(file, MOST)
        if not isinstance(content, dict):
            raise InvalidInput(f"{file}: must be a table of arrays, got {type(content).__name__}")
        return content
    if suffix == ".npz":
        return _from_zip(file)
    try:
        from scipy.io import loadmat  # type: ignore[import-untyped, import-not-found, unused-ignore]
    except ImportError:
        raise InvalidInput(f"{file}: needs SciPy to be read: pip install scipy") from None
    try:
        found = loadmat(io.BytesIO(_files.read(file, MOST)), squeeze_me=False)
    except NotImplementedError:
        raise InvalidInput(f"{file}: must be of MATLAB's version 5 or 7, got 7.3: save it with '-v7'") from None
    except InvalidInput:
        raise
    except Exception:  # of SciPy's reader
        raise InvalidInput(f"{file}: is damaged: it is no MAT file") from None
    return {name: _squeezed(value) for name, value in found.items() if not name.startswith("__")}


def _squeezed(value: Any) -> Any:
    """Return a column of MATLAB as an array of one axis."""
    return value.ravel() if getattr(value, "ndim", 0) == 2 and 1 in value.shape else value


def _from_zip(file: pathlib.Path) -> dict[str, Any]:
    try:
        with _files.opened(file, MOST) as (opened, _), zipfile.ZipFile(opened) as table:
            if sum(info.file_size for info in table.infolist()) > MOST:
                raise InvalidInput(f"{file}: must be at most {MOST // 1_000_000} MB when it is unpacked")
            out = {}
            for info in table.infolist():
                with table.open(info) as part:
                    out[info.filename.removesuffix(".npy")] = np.lib.format.read_array(part, allow_pickle=False)
            return out
    except InvalidInput:
        raise
    except Exception:  # of zip, zlib and NumPy
        raise InvalidInput(f"{file}: is damaged: it is no NPZ of plain arrays") from None


def _from_arrays(
    file: pathlib.Path,
    arrays: Mapping[str, Any],
    columns: str | None,
    order: str | None,
    euler: str | None,
    degrees: bool,
) -> Source:
    """Return the arrays of time, rates and attitude; single columns are taken as those of a table."""
    given = dict(arrays)
    for part in (columns or "").split(",") if columns else []:
        ours, equals, theirs = (text.strip() for text in part.partition("="))
        if not equals or ours not in ARRAYS:
            raise InvalidInput(f"--columns: must be such as t=time,omega=gyr,attitude=quat, got {short(part)!r}")
        if theirs not in given:
            raise InvalidInput(f"--columns: must name arrays of {file}, got {short(theirs)!r}; {_have(given)}")
        for name in ARRAYS[ours]:
            given.pop(name, None) if name != theirs else None
        given[ours] = arrays[theirs]
    found = {what: _take(file, what, given) for what in ARRAYS}
    if found["t"] is None:
        raise InvalidInput(f"{file}: must have an array of times, 't'; {_have(given)}")
    t = numbers(found["t"], f"{file}: t", ())
    if len(t) > MOST_ROWS:
        raise InvalidInput(f"{file}: must have at most {MOST_ROWS} rows, got {len(t)}; keep one of "
                           f"{-(-len(t) // MOST_ROWS)}")  # fmt: skip
    attitude, omega = found["attitude"], found["omega"]
    if attitude is None and omega is None:
        single = {n: a for n, a in given.items() if np.shape(a) == t.shape}
        choice = choose(list(single), order, euler)
        table = [np.asarray(a, float) for a in single.values()]
        omega = np.stack([table[k] for k in choice.omega], axis=1) if choice.omega else None
        attitude = np.stack([table[k] for k in choice.attitude], axis=1) if choice.attitude else None
        omega, attitude, in_degrees = _in_one_unit(omega, attitude, choice, degrees)
        if choice.kind == "matrix" and attitude is not None:
            attitude = attitude.reshape(-1, 3, 3)
        return Source(t * choice.time_unit, attitude, omega, choice.order, choice.euler, in_degrees, (),
                      tuple(choice.notes))  # fmt: skip
    angles = attitude is not None and np.ndim(attitude) == 2 and np.shape(attitude)[1] == 3
    if angles and euler is None:
        raise InvalidInput(f"{file}: attitude: has three numbers a sample; tell their sequence by --euler, such as ZYX")
    if euler is not None and not angles:
        raise InvalidInput("--euler: must be used with Euler angles, got no array of three angles a sample")
    return Source(t, attitude, omega, order or "xyzw", euler, degrees)


def _take(file: pathlib.Path, what: str, given: Mapping[str, Any]) -> Any:
    names = [name for name in given if name.lower() in ARRAYS[what]]
    first = next((name for name in names if name == what), None) or (names[0] if names else None)
    if first is None or (what != "t" and np.ndim(_numeric(file, first, given[first])) < 2):
        return None
    if len(names) > 1 and first != what:
        raise InvalidInput(f"{file}: arrays {names[0]!r} and {names[1]!r}: both name one thing; choose by --columns")
    return _numeric(file, first, given[first])


def _numeric(file: pathlib.Path, name: str, value: Any) -> Array:
    """Return an array of numbers; null is NaN."""
    try:
        array: Array = np.asarray(value, float)
    except (TypeError, ValueError):
        raise InvalidInput(f"{file}: {name}: must be an array of numbers with equal rows") from None
    return array


def _have(given: Mapping[str, Any]) -> str:
    text = ", ".join(map(str, given))
    return f"it has {short(text)}" if given else "it has none"
