"""What the command writes, on full disks and closed pipes: one line, status 1, and no good file lost."""

import os
import re
import resource
import subprocess
import sys

import pytest

import polhode as ph
from polhode import _files

COMMAND = [sys.executable, "-m", "polhode"]
BUFFERED = {name: value for name, value in os.environ.items() if name != "PYTHONUNBUFFERED"}   # as users have it


def run(*arguments, limit=None, **more):
    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    return subprocess.run([*COMMAND, *map(str, arguments)], text=True, timeout=120,
                          preexec_fn=limited if limit else None,
                          **{"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **more})


def one_line(found, status=1):
    assert found.returncode == status, found.stderr
    assert found.stderr.startswith("polhode: ") and found.stderr.count("\n") == 1, found.stderr


@pytest.mark.parametrize("suffix", ["csv", "npz", "json"])
def test_a_full_disk_leaves_the_old_file(suffix, tmp_path):
    file = tmp_path / f"x.{suffix}"
    file.write_text("good and old")
    found = run("run", "S1", "-o", file, limit=1000)
    one_line(found)
    assert "File too large" in found.stderr
    assert file.read_text() == "good and old" and [p.name for p in tmp_path.iterdir()] == [file.name]


def test_a_full_disk_leaves_the_old_picture(tmp_path):
    pytest.importorskip("matplotlib", reason="needs matplotlib")
    file = tmp_path / "x.svg"
    file.write_text("good and old")
    found = run("run", "S1", "--plot", file, limit=20_000, env={**os.environ, "MPLCONFIGDIR": str(tmp_path / "mpl")})
    assert found.returncode == 1 and "Traceback" not in found.stderr, found.stderr
    assert file.read_text() == "good and old" and not list(tmp_path.glob(".x*"))


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize("env", [BUFFERED, BUFFERED | {"PYTHONUNBUFFERED": "1"}], ids=["buffered", "unbuffered"])
@pytest.mark.parametrize("arguments", ["run S1", "run S1 --json", "plan S1", "methods", "--version"])
def test_a_full_stdout_is_one_line(arguments, env):
    with open("/dev/full", "w") as full:
        one_line(run(*arguments.split(), stdout=full, env=env))


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
@pytest.mark.parametrize("env", [BUFFERED, BUFFERED | {"PYTHONUNBUFFERED": "1"}], ids=["buffered", "unbuffered"])
def test_files_are_written_before_a_full_stdout(tmp_path, env):
    with open("/dev/full", "w") as full:
        one_line(run("run", "S1", "-o", tmp_path / "x.csv", stdout=full, env=env))
    assert (tmp_path / "x.csv").read_text().startswith("t,omega_x")
    with open("/dev/full", "w") as full:   # stderr is full, too
        assert run("run", "S1", stdout=full, stderr=full, env=env).returncode == 1


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="needs /dev/full")
def test_a_full_stderr_changes_no_status():
    for arguments, status in ("run nothing.toml", 2), ("run --nothing", 2), ("plan S1", 0):
        with open("/dev/full", "w") as full:
            assert run(*arguments.split(), stderr=full, env=BUFFERED).returncode == status


def closed(stream, file, folder):
    """The command with a stream that its caller closed."""
    script = f'"$0" -m polhode run S1 -o {file} {stream}>&-'
    return subprocess.run(["sh", "-c", script, sys.executable], cwd=folder, text=True, capture_output=True, timeout=120)


def test_a_closed_stdout_is_one_line(tmp_path):
    one_line(closed(1, "x.csv", tmp_path))
    assert (tmp_path / "x.csv").read_text().startswith("t,omega_x")
    found = closed(2, "y.csv", tmp_path)
    assert found.returncode == 0 and "wrote y.csv" in found.stdout
    assert (tmp_path / "y.csv").read_text().startswith("t,omega_x")


PRINTING = ["run S1 --json", "run S1", "methods", "plan S1 S2 S3 S4", "inertia S1", "--help"]


@pytest.mark.parametrize("arguments", PRINTING)
def test_a_closed_pipe_is_no_failure(arguments):
    script = f'set -o pipefail; "$0" -m polhode {arguments} | head -c 10 > /dev/null'
    found = subprocess.run(["bash", "-c", script, sys.executable], capture_output=True, text=True, timeout=120)
    assert found.returncode == 0 and found.stderr == "", found.stderr
    reader, writer = os.pipe()   # closed before a word is written
    os.close(reader)
    found = run(*arguments.split(), stdout=writer)
    os.close(writer)
    assert found.returncode == 0 and found.stderr == ""


def test_a_draft_takes_the_place_of_a_file_when_it_is_whole(tmp_path):
    file, link = tmp_path / "a.txt", tmp_path / "link.txt"
    file.write_text("old")
    file.chmod(0o640)
    link.symlink_to("a.txt")
    with pytest.raises(KeyboardInterrupt), _files.whole(file) as draft:
        draft.write_text("half")
        assert draft.suffix == ".txt" and file.read_text() == "old"
        raise KeyboardInterrupt
    assert file.read_text() == "old" and len(list(tmp_path.iterdir())) == 2
    _files.write(link, "new")
    assert link.is_symlink() and file.read_text() == "new" and file.stat().st_mode & 0o777 == 0o640
    (tmp_path / "null.txt").symlink_to(os.devnull)
    _files.write(tmp_path / "null.txt", "gone")
    assert os.path.realpath(tmp_path / "null.txt") == os.devnull


def test_nothing_else_writes_in_place():
    """Every file of the package is written by `_files`; a program's source in a folder of its own is none of these.

    A picture for a notebook is written to memory.
    """
    allowed = {"_files.py", "charts/peers/odeint.py", "_plot/picture.py"}
    package = os.path.dirname(ph.__file__)
    for folder, _, names in os.walk(package):
        for name in names:
            path = os.path.join(folder, name)
            if name.endswith(".py") and os.path.relpath(path, package) not in allowed:
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                assert ".write_text(" not in text and ".write_bytes(" not in text, path
                written = [line for line in text.splitlines() if re.search(r"\.savefig\(|np\.savez", line)]
                assert all("draft" in line or "held" in line or "``" in line for line in written), path


@pytest.mark.parametrize("width", [30, 40, 60, 79, 200])
def test_no_number_is_cut_in_a_narrow_terminal(width, capsys, monkeypatch):
    from polhode.cli import show

    monkeypatch.setattr(show, "console", lambda stderr=False: show._Console(width=width, highlight=False))
    motion = ph.solve(ph.Scene.load("S1"), 1e-8)
    show.motion(motion)
    text = capsys.readouterr().out
    for row in (0, -1):
        for number in (motion.t[row], *motion.omega[row], *motion.attitude[row]):
            assert f"{number:.9g}" in text
    assert max(map(len, text.splitlines()[:20])) <= width
