"""Where the files are that a robot description names: packages, models, meshes, included files."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import urllib.parse
from collections.abc import Callable, Iterator, Mapping, Sequence

from ... import _files
from ..._core import InvalidInput

VARIABLES = ("ROS_PACKAGE_PATH", "AMENT_PREFIX_PATH", "GZ_SIM_RESOURCE_PATH", "IGN_GAZEBO_RESOURCE_PATH",
             "SDF_PATH", "GAZEBO_MODEL_PATH", "GAZEBO_RESOURCE_PATH")
MARKS = ("package.xml", "model.config", ".git", "setup.py", "pyproject.toml")
SCHEMES = ("package", "model", "file", "", "ament", "fuel")


@dataclasses.dataclass(frozen=True)
class Search:
    """Folders that may be read, and the packages that have a name.

    `folders` are searched for packages and models. `packages` maps names to folders. `allowed` are the folders in which
    a file may lie, links resolved; what lies in a folder of the user's own (`folders`, `packages`, the environment's)
    may be a link to anywhere.
    """

    folders: tuple[pathlib.Path, ...] = ()
    packages: Mapping[str, pathlib.Path] = dataclasses.field(default_factory=dict)
    allowed: tuple[pathlib.Path, ...] = ()

    @staticmethod
    def of(folders: Sequence[str | os.PathLike[str]] = (), packages: Mapping[str, str | os.PathLike[str]] | None = None,
           allowed: Sequence[pathlib.Path] = ()) -> Search:
        """Take the caller's folders, and those of the environment's variables."""
        from_environment = [pathlib.Path(p) for variable in VARIABLES
                            for p in os.environ.get(variable, "").split(os.pathsep) if p]
        return Search((*(_files.to_path(p, "path") for p in folders), *from_environment),
                      {name: _files.to_path(p, "package") for name, p in (packages or {}).items()},
                      tuple(folder.resolve() for folder in allowed))

    def find(self, uri: str, beside: pathlib.Path) -> pathlib.Path | None:
        """Find the file of a URI in the description `beside`; None if there is none.

        Raises
        ------
        InvalidInput
            For a file that lies outside all folders that may be read.
        """
        return self._first(uri, beside, _files.is_file)

    def find_model(self, uri: str, beside: pathlib.Path) -> pathlib.Path | None:
        """Find the folder of a model, or a model's file."""
        return self._first(uri, beside, _is_there)

    def folder(self, package: str, beside: pathlib.Path) -> pathlib.Path | None:
        """Find the folder of a package."""
        return self._first(f"package://{package}", beside, _is_there)

    def _first(self, uri: str, beside: pathlib.Path, fits: Callable[[pathlib.Path], bool]) -> pathlib.Path | None:
        refused = None
        for candidate, own in self._candidates(uri, beside):
            if fits(candidate):
                try:
                    return self._checked(candidate, own, beside, uri)
                except InvalidInput as error:
                    refused = refused or error
        if refused is not None:
            raise refused
        return None

    def check(self, file: pathlib.Path, beside: pathlib.Path) -> pathlib.Path:
        """Return a file if it lies where it may; raise InvalidInput if not."""
        own = next((root for root in (*self.folders, *self.packages.values()) if _within(file, root)), None)
        return self._checked(file, own, beside, str(file))

    def _candidates(self, uri: str, beside: pathlib.Path) -> Iterator[tuple[pathlib.Path, pathlib.Path | None]]:
        """Places to look at; with each the user's own folder that it must not leave, if it is in one."""
        scheme, _, rest = uri.strip().rpartition("://")
        rest = urllib.parse.unquote(rest) if scheme else rest.replace("\\", "/")
        if "\0" in rest or scheme not in SCHEMES:
            return
        if scheme == "file" and rest.startswith("$(find "):   # a macro that was not expanded
            package, _, inside = rest[len("$(find "):].partition(")")
            scheme, rest = "package", package + inside
        if scheme in ("", "file"):
            yield beside.parent / rest, None
            if scheme == "file":
                yield beside.parent / rest.lstrip("/"), None
            for root in self.folders:
                yield root / rest.lstrip("/"), root
            return
        package, _, inside = rest.lstrip("/").partition("/")
        if package in self.packages:
            yield self.packages[package] / inside, self.packages[package]
        folders = list(beside.absolute().parents)
        for folder in folders:
            if folder.name == package:
                yield folder / inside, None
        for folder in folders:
            yield folder / rest.lstrip("/"), None
            yield folder / "models" / rest.lstrip("/"), None
        for root in self.folders:
            yield root / rest.lstrip("/"), root
            yield root / "share" / rest.lstrip("/"), root
            if root.name == package:
                yield root / inside, root
        yield folders[0] / inside, None
        yield from ((folder / inside, None) for folder in folders[1:3] if inside)   # of a package with another name

    def _checked(self, file: pathlib.Path, own: pathlib.Path | None, beside: pathlib.Path, uri: str) -> pathlib.Path:
        if own is not None and _within(file, own):
            return file
        real = file.resolve()
        if any(real.is_relative_to(folder) for folder in (*self.allowed, *home(beside))):
            return file
        raise InvalidInput(f"{uri!r} lies outside the folders that may be read: name its folder by --path")


def _is_there(path: pathlib.Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def _within(file: pathlib.Path, folder: pathlib.Path) -> bool:
    """Return whether a path stays in a folder by its words, wherever its links lead."""
    return pathlib.Path(os.path.abspath(file)).is_relative_to(os.path.abspath(folder))


_homes: dict[pathlib.Path, tuple[pathlib.Path, ...]] = {}


def home(file: pathlib.Path) -> tuple[pathlib.Path, ...]:
    """The folders that belong to a description: its own, the one above, and those of its project."""
    folder = file.absolute().parent
    if folder not in _homes:
        parents = [folder, *folder.parents]
        marked = [i for i, parent in enumerate(parents[:-1]) if any(_is_there(parent / mark) for mark in MARKS)]
        reach = max([1, *(i + 1 if not _is_there(parents[i] / ".git") else i for i in marked)])
        top = parents[min(reach, max(len(parents) - 2, 0))]   # never the root of the file system
        if len(_homes) > 10_000:
            _homes.clear()
        _homes[folder] = (top.resolve(), folder.resolve())
    return _homes[folder]
