"""Files of a store: each appears whole and lasting, or not at all."""

from __future__ import annotations

import asyncio
import contextlib
import os
import pathlib
import uuid
from typing import Any

from zarr.storage import LocalStore

TRIES = 5


def sync_folder(folder: pathlib.Path) -> None:
    """Make the names in a folder last."""
    if os.name != "posix":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def write(path: pathlib.Path, data: Any) -> None:
    """Write a file that survives a loss of power. A draft beside it takes its place when it is whole.

    Another run on the same store may clean the draft away; it is then written again.
    """
    for left in reversed(range(TRIES)):
        path.parent.mkdir(parents=True, exist_ok=True)
        draft = path.with_name(f"{path.name}.{uuid.uuid4().hex}.partial")
        try:
            with open(draft, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.replace(draft, path)
            sync_folder(path.parent)
            return
        except FileNotFoundError:
            if not left:
                raise
        except BaseException:
            with contextlib.suppress(OSError):
                draft.unlink()
            raise


class LastingStore(LocalStore):
    """Zarr's store of local files, whose files are on the disk when a write returns."""

    async def set(self, key: str, value: Any, *rest: Any) -> None:
        """Write the value of a key."""
        if not self._is_open:
            await self._open()
        self._check_writable()
        await asyncio.to_thread(write, self.root / key, value.as_buffer_like())

    async def set_if_not_exists(self, key: str, value: Any) -> None:
        """Write the value of a key that has none."""
        if not (self.root / key).exists():
            await self.set(key, value)

    def set_sync(self, key: str, value: Any) -> None:
        """Write the value of a key."""
        self._ensure_open_sync()
        self._check_writable()
        write(self.root / key, value.as_buffer_like())
