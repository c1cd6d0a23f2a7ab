"""`polhode inertia --fix` in a folder of somebody else: nothing is written through a link, or outside the folder."""

import os
import pathlib
import subprocess
import sys

import pytest

from polhode import _files
from polhode._core import InvalidInput

URDF = """<robot name="r"><link name="a"><inertial><mass value="1"/>
<inertia ixx="10833" iyy="8333" izz="4166" ixy="0" ixz="0" iyz="0"/></inertial>
<visual><geometry><box size="0.1 0.2 0.3"/></geometry></visual></link></robot>"""
FIXED = "<!-- was "


def fix(*arguments, cwd=None):
    """The command in a process of its own, which must not hang."""
    found = subprocess.run([sys.executable, "-m", "polhode", "inertia", *map(str, arguments), "--fix"], cwd=cwd,
                           capture_output=True, text=True, timeout=60)
    assert "Traceback" not in found.stderr, found.stderr
    return found


@pytest.fixture
def repo(tmp_path):
    """A folder with a robot that can be repaired, beside a file that is no business of it."""
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/precious").write_text("precious")
    folder = tmp_path / "repo"
    (folder / "sub").mkdir(parents=True)
    (folder / "sub/r.urdf").write_text(URDF)
    return folder


def everything(folder):
    return {str(path.relative_to(folder)): os.readlink(path) if path.is_symlink() else path.read_bytes()
            for path in folder.rglob("*") if path.is_symlink() or path.is_file()}


def test_the_copy_is_written_where_nothing_stands_in_the_way(repo):
    found = fix(repo)
    assert "wrote" in found.stderr and FIXED in (repo / "sub/r.fixed.urdf").read_text()
    assert sorted(path.name for path in (repo / "sub").iterdir()) == ["r.fixed.urdf", "r.urdf"]


@pytest.mark.parametrize("target", ["../../outside/precious", "../../outside/new", "r.urdf", "r.fixed.urdf",
                                    "/dev/null"])
def test_a_link_in_the_place_of_the_copy_is_not_followed(repo, target):
    (repo / "sub/r.fixed.urdf").symlink_to(target)
    before = everything(repo.parent)
    found = fix(repo)
    assert found.returncode == 1 and "r.fixed.urdf: is not written: a link stands there" in found.stderr
    assert everything(repo.parent) == before


@pytest.mark.parametrize("named", [False, True])
def test_a_pipe_in_the_place_of_the_copy_does_not_hang(repo, named):
    os.mkfifo(repo / "sub/r.fixed.urdf")
    found = fix(repo / "sub/r.urdf" if named else repo)
    assert found.returncode == 1 and "is not written: a device or a pipe stands there" in found.stderr


def test_a_device_and_a_folder_in_the_place_of_the_copy(repo):
    (repo / "sub/r.fixed.urdf").mkdir()
    assert "is not written: a folder stands there" in fix(repo).stderr
    (repo / "sub/r.fixed.urdf").rmdir()
    if os.geteuid():
        pytest.skip("needs root")
    os.mknod(repo / "sub/r.fixed.urdf", 0o20666, os.makedev(1, 3))
    assert "is not written: a device or a pipe stands there" in fix(repo).stderr


def test_another_name_of_the_old_copy_keeps_its_content(repo):
    os.link(repo.parent / "outside/precious", repo / "sub/r.fixed.urdf")
    assert "wrote" in fix(repo).stderr
    assert (repo.parent / "outside/precious").read_text() == "precious"
    assert FIXED in (repo / "sub/r.fixed.urdf").read_text()


def test_folders_that_are_links_are_not_entered(repo):
    (repo.parent / "outside/r.urdf").write_text(URDF)
    (repo / "away").symlink_to("../outside")
    before = everything(repo.parent / "outside")
    fix(repo)
    assert everything(repo.parent / "outside") == before
    fix(repo / "away/r.urdf")   # the caller names the link himself
    assert (repo.parent / "outside/r.fixed.urdf").exists()


def test_a_robot_that_is_a_link_is_not_copied(repo):
    (repo.parent / "outside/secret.urdf").write_text(URDF)
    (repo / "linked.urdf").symlink_to("../outside/secret.urdf")
    found = fix(repo)
    assert found.returncode == 1 and "linked.urdf: is not read: it is a link" in found.stderr
    assert not (repo / "linked.fixed.urdf").exists() and (repo / "sub/r.fixed.urdf").exists()   # the others go on


def swap(monkeypatch, change):
    """Let `change` happen after the look at the place of the copy, and before the writing."""
    look = _files.require_replaceable
    monkeypatch.setattr(_files, "require_replaceable", lambda path, handle=None: (look(path, handle), change()))


def test_a_link_that_comes_between_look_and_writing_is_replaced(repo, monkeypatch):
    swap(monkeypatch, lambda: (repo / "sub/a").symlink_to("../../outside/precious"))
    _files.write_below(repo, pathlib.PurePath("sub/a"), b"new")
    assert (repo / "sub/a").read_bytes() == b"new" and not (repo / "sub/a").is_symlink()
    assert (repo.parent / "outside/precious").read_text() == "precious"


def test_a_folder_that_becomes_a_link_between_look_and_writing_is_not_entered(repo, monkeypatch):
    def change():
        (repo / "sub").rename(repo / "moved")
        (repo / "sub").symlink_to("../outside")

    swap(monkeypatch, change)
    _files.write_below(repo, pathlib.PurePath("sub/precious"), b"new")
    assert (repo.parent / "outside/precious").read_text() == "precious"
    assert (repo / "moved/precious").read_bytes() == b"new"
    with pytest.raises(InvalidInput, match="sub: is not entered: it is a link"):
        _files.write_below(repo, pathlib.PurePath("sub/precious"), b"new")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_a_file_in_utf_16_is_said_to_be_not_supported(repo, encoding):
    (repo / "sub/r.urdf").write_bytes(URDF.encode(encoding))
    found = fix(repo)
    assert found.returncode == 1 and "PI" in found.stdout
    assert "nothing is repaired: files in UTF-16 are not repaired; save the file in UTF-8" in found.stderr
    assert not (repo / "sub/r.fixed.urdf").exists()


def test_names_that_polhode_chooses_are_not_written_through_links(repo):
    """Of reports, charts and the atlas: their files have names that a foreign folder may hold already."""
    precious = repo.parent / "outside/precious"
    (repo / "index.html").symlink_to(precious)
    with pytest.raises(InvalidInput, match="index.html: is not written: a link stands there"):
        _files.write(repo / "index.html", "new", follow=False)
    assert precious.read_text() == "precious"
    _files.write(repo / "index.html", "new")   # a name that the caller gave
    assert precious.read_text() == "new" and (repo / "index.html").is_symlink()
