"""C-kernels of SPICE (.bc): type 5 with Lagrange polynomials, type 3 with turns about fixed axes.

The library of SPICE writes and reads them. Ticks of the clock are microseconds: a file .tsc beside the kernel says so.
"""

from __future__ import annotations

import contextlib
import datetime
import importlib
import math
import pathlib
import re
from collections.abc import Iterator
from typing import Any

import numpy as np

from .. import _files
from .._core import InvalidInput
from . import interpolate, times
from .aem import EPOCH, STATED, round_up
from .ephemeris import AttitudeEphemeris
from .interpolate import Floats

CLOCK = -99                   # of a spacecraft that no mission has
BODY = 1000 * CLOCK
J2000 = datetime.datetime(2000, 1, 1, 12)
FRAMES = {"EME2000": "J2000", "GCRF": "J2000"}
LAGRANGE = 1                  # the subtype of type 5 whose packets are quaternions
COMMENTS = 5000               # characters for what the file says of itself
_FIRST = re.compile(r"tick 0 at (-?\d+) microseconds of them")
_KNOWN = re.compile(r"axes (\S+) of the body (.+)")


def write(path: pathlib.Path, made: AttitudeEphemeris) -> None:
    """Write the kernel, and its clock beside it.

    Raises
    ------
    InvalidInput
        Without SPICE, and for another time system than TDB.
    """
    if made.time_system != "TDB":
        raise InvalidInput(f"time_system: must be TDB for a kernel of SPICE, got {made.time_system!r}")
    spice = _spice()
    micros = np.rint(made.t * 1e6).astype(np.int64)
    ticks = (micros - micros[0]).astype(float)
    start = (made.epoch - J2000).total_seconds() + int(micros[0]) / 1e6
    to_body = made.attitude[:, [3, 0, 1, 2]] * (1.0, -1.0, -1.0, -1.0)   # of the rotation from space to body
    packets = np.ascontiguousarray(to_body)
    with _files.whole(path) as draft:
        handle = spice.ckopn(str(draft), "attitudes by polhode", COMMENTS)
        with contextlib.ExitStack() as stack:
            stack.callback(spice.ckcls, handle)
            spice.dafac(handle, _describe(made, int(micros[0])))
            for first, last in made.segments:
                part = ticks[first:last]
                about = (part[0], part[-1], BODY, FRAMES.get(made.frame, made.frame), False, made.name[:40])
                if made.method == "lagrange":
                    spice.ckw05(handle, LAGRANGE, made.degree, *about, part, packets[first:last], 1e-6, 1, part[:1])
                else:
                    spice.ckw03(handle, *about, last - first, part, packets[first:last], np.zeros((last - first, 3)), 1,
                                part[:1])
    _files.write(path.with_suffix(".tsc"), _clock(start))


def _spice() -> Any:
    try:
        return importlib.import_module("spiceypy")
    except ImportError:
        raise InvalidInput("path: kernels of SPICE need spiceypy: pip install spiceypy") from None


def _describe(made: AttitudeEphemeris, first: int) -> list[str]:
    return [f"attitude error at most {round_up(made.error)} rad", "as interpolated by this kernel's type",
            f"epoch of the times {times.show(made.epoch)}", f"tick 0 at {first} microseconds of them",
            f"axes {made.frame} of the body {made.name}"]


def _clock(start: float) -> str:
    """Return the kernel of a clock whose ticks are microseconds after a start [seconds of TDB after J2000]."""
    return "\n".join([
        "KPL/SCLK", "", "\\begindata", "SCLK_KERNEL_ID = ( @2000-01-01/12:00 )", "SCLK_DATA_TYPE_99 = ( 1 )",
        "SCLK01_TIME_SYSTEM_99 = ( 1 )", "SCLK01_N_FIELDS_99 = ( 2 )", "SCLK01_MODULI_99 = ( 4294967296 1000000 )",
        "SCLK01_OFFSETS_99 = ( 0 0 )", "SCLK01_OUTPUT_DELIM_99 = ( 1 )", "SCLK_PARTITION_START_99 = ( 0.0 )",
        "SCLK_PARTITION_END_99 = ( 4.0E+15 )", f"SCLK01_COEFFICIENTS_99 = ( 0.0 {start:.17g} 1.0 )", "\\begintext", ""])


def read(path: pathlib.Path) -> AttitudeEphemeris:
    """Read the attitudes of a kernel that polhode wrote.

    Raises
    ------
    InvalidInput
        Without SPICE, and for another file: the times of other kernels are of clocks that they do not state.
    """
    _files.size_of(path, _files.MESH)
    if _files.read(path, _files.MESH)[:7] != b"DAF/CK ":
        raise InvalidInput(f"{path}: must be a binary C-kernel")
    spice = _spice()
    try:
        with _opened(spice, path) as handle:
            _, lines, _ = spice.dafec(handle, 100, 100)
            said = "\n".join(lines)
            found = [form.search(said) for form in (STATED, EPOCH, _FIRST, _KNOWN)]
            if not all(found):
                raise InvalidInput(f"{path}: must be a C-kernel that polhode wrote: it does not say what its ticks are")
            stated, epoch, first, known = (one.groups() for one in found if one)
            parts = list(_parts(spice, handle))
    except InvalidInput:
        raise
    except Exception as error:   # of the library
        raise InvalidInput(f"{path}: must be a binary C-kernel ({type(error).__name__})") from None
    whole, rest = times.parse(epoch[0], str(path))
    ticks = np.concatenate([at for at, _, _ in parts])
    attitude = np.concatenate([interpolate.make_continuous(rows) for _, rows, _ in parts])
    ends = np.cumsum([0, *(len(at) for at, _, _ in parts)]).tolist()
    degree = parts[0][2]
    return AttitudeEphemeris((np.rint(ticks) + int(first[0])) / 1e6, attitude, float(stated[0]),
                             whole + datetime.timedelta(microseconds=round(rest * 1e6)), "TDB", known[0],
                             known[1].strip(), "lagrange" if degree > 1 else "linear", degree, True,
                             tuple(zip(ends[:-1], ends[1:], strict=True)))


@contextlib.contextmanager
def _opened(spice: Any, path: pathlib.Path) -> Iterator[int]:
    handle = spice.dafopr(str(path))
    try:
        yield handle
    finally:
        spice.dafcls(handle)


def _parts(spice: Any, handle: int) -> Iterator[tuple[Floats, Floats, int]]:
    """Give the ticks, attitudes (x, y, z, w) and degree of each segment (CK Required Reading, types 3 and 5)."""
    spice.dafbfs(handle)
    while spice.daffna():
        _, whole = spice.dafus(spice.dafgs(8), 2, 6)
        kind, begin, end = int(whole[2]), int(whole[4]), int(whole[5])
        numbers = np.asarray(spice.dafgda(handle, begin, end))
        count = int(numbers[-1])
        if kind not in (3, 5) or not 2 <= count <= len(numbers) // 5 or not math.isfinite(numbers.sum()):
            raise InvalidInput("a segment must be of type 3 or 5 with quaternions alone")
        rows, ticks = numbers[:4 * count].reshape(count, 4), numbers[4 * count:5 * count]
        degree = int(numbers[-3]) - 1 if kind == 5 else 1
        yield ticks, rows[:, [1, 2, 3, 0]] * (-1.0, -1.0, -1.0, 1.0), degree
