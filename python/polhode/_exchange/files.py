"""Files of attitudes for other programs, by their suffixes."""

from __future__ import annotations

import pathlib
from typing import TYPE_CHECKING, Any

from .._core import InvalidInput
from . import aem, ck, stk
from .ephemeris import AttitudeEphemeris
from .write import make

if TYPE_CHECKING:
    from .. import Motion

OPTIONS = ("frame", "name", "time_system", "method", "degree")
FORMATS: dict[str, Any] = {".aem": aem, ".a": stk, ".bc": ck}


def save(motion: Motion, path: pathlib.Path, **options: Any) -> None:
    """Write a motion so that the file's interpolation keeps an angle; see `Motion.save`."""
    if unknown := sorted(set(options) - {"accuracy", "epoch", *OPTIONS}):
        raise InvalidInput(f"{unknown[0]}: must be one of {', '.join(OPTIONS)}")
    form = FORMATS[path.suffix]
    form.write(path, make(motion, **options, cut=form is ck))


def load(path: pathlib.Path) -> AttitudeEphemeris:
    """Read a file of attitudes."""
    made: AttitudeEphemeris = FORMATS[path.suffix].read(path)
    return made
