"""The folder of a measurement."""

from __future__ import annotations

import os
import pathlib

from .._core import InvalidInput


def make_folder(folder: str | os.PathLike[str]) -> pathlib.Path:
    """Return the path of the output, made where it is missing; refuse one that cannot be written to."""
    output = pathlib.Path(folder)
    try:
        output.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InvalidInput(f"output: {output} cannot be made: {error.strerror}") from None
    if not os.access(output, os.W_OK):
        raise InvalidInput(f"output: {output} cannot be written to")
    return output
