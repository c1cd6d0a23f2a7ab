"""Files that two threads or processes write at once, and writers that are killed: each name holds one whole file."""

import json
import os
import pathlib
import subprocess
import sys
import threading

import ensembles
import numpy as np
import pytest

import polhode as ph
from polhode import _files, _folders

MOTION = ph.solve(ph.Scene.load("S5"), accuracy=1e-6)


def in_threads(work, count=6):
    """Run `work(number)` in threads at once; return what was raised."""
    raised, begin = [], threading.Barrier(count)

    def guarded(number):
        begin.wait()
        try:
            work(number)
        except Exception as error:
            raised.append(error)

    threads = [threading.Thread(target=guarded, args=(number,)) for number in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return raised


def test_six_threads_save_one_file(tmp_path):
    def work(number):
        for _ in range(12):
            MOTION.save(tmp_path / "same.npz")
            assert np.array_equal(ph.load(tmp_path / "same.npz").omega, MOTION.omega)

    assert in_threads(work) == [] and [path.name for path in tmp_path.iterdir()] == ["same.npz"]


def test_names_with_the_same_first_letters_do_not_share_a_draft(tmp_path):
    def work(number):
        for _ in range(50):
            path = tmp_path / f"{'x' * 100}{number}.bin"
            with _files.whole(path) as draft:
                draft.write_bytes(bytes([number]) * 100_000)
            assert path.read_bytes() == bytes([number]) * 100_000

    assert in_threads(work) == [] and len(list(tmp_path.iterdir())) == 6


def test_a_long_name_beyond_ascii_has_a_draft(tmp_path):
    _files.write(tmp_path / f"{'日' * 80}.txt", "whole")   # 244 bytes
    assert [path.read_text() for path in tmp_path.iterdir()] == ["whole"]


def test_three_threads_save_one_folder(tmp_path):
    pytest.importorskip("zarr")

    def work(number):
        for _ in range(5):
            MOTION.save(tmp_path / "same.zarr")

    assert in_threads(work, 3) == [] and [path.name for path in tmp_path.iterdir()] == ["same.zarr"]
    assert np.array_equal(ph.load(tmp_path / "same.zarr").omega, MOTION.omega)


# ---- folders of Zarr

@pytest.fixture
def saved(tmp_path):
    pytest.importorskip("zarr")
    MOTION.save(tmp_path / "a.zarr")
    return tmp_path / "a.zarr"


@pytest.mark.parametrize("name", ["notes.txt", "omega/notes.txt", "omega/c/notes.txt", "mine/x", "c/0", "empty/",
                                  "link"])
def test_a_folder_with_a_file_of_the_user_is_not_replaced(saved, name):
    mine = saved / name
    mine.parent.mkdir(exist_ok=True)
    if name == "link":
        mine.symlink_to("omega")
    elif name.endswith("/"):
        mine.mkdir()
    else:
        mine.write_text("mine")
    before = sorted(map(str, saved.parent.rglob("*")))
    with pytest.raises(ph.InvalidInput, match=f"{name.strip('/').split('/')[0]}.*(which polhode did not write|a link)"):
        MOTION.save(saved)
    assert sorted(map(str, saved.parent.rglob("*"))) == before


def test_through_a_link_the_end_is_replaced(saved):
    other = ph.solve(ph.Scene.load("S1"), accuracy=1e-6)
    link = saved.parent / "link.zarr"
    link.symlink_to("a.zarr")
    other.save(link)
    assert link.is_symlink() and np.array_equal(ph.load(saved).omega, other.omega)
    assert sorted(path.name for path in saved.parent.iterdir()) == ["a.zarr", "link.zarr"]
    (saved.parent / "new.zarr").symlink_to("end.zarr")
    MOTION.save(saved.parent / "new.zarr")
    assert np.array_equal(ph.load(saved.parent / "end.zarr").omega, MOTION.omega)


def test_a_file_is_no_folder_and_a_folder_no_file(tmp_path):
    pytest.importorskip("zarr")
    (tmp_path / "a.npz").mkdir()
    (tmp_path / "a.zarr").write_text("mine")
    for name, message in (("a.npz", "is a folder"), ("a.zarr", "is there and is not a saved motion")):
        with pytest.raises(ph.InvalidInput, match=message):
            MOTION.save(tmp_path / name)
    assert (tmp_path / "a.zarr").read_text() == "mine" and len(list(tmp_path.iterdir())) == 2


KILLED = """
import os, sys
import polhode as ph
motion, left, calls = ph.load(sys.argv[1]), int(sys.argv[2]), []
def counted(function):
    def call(*arguments, **options):
        calls.append(function)
        if len(calls) > left:
            os._exit(9)
        return function(*arguments, **options)
    return call
os.rename, os.unlink, os.rmdir = map(counted, (os.rename, os.unlink, os.rmdir))
motion.save(sys.argv[1])
"""


@pytest.mark.parametrize("left", range(5))
def test_a_kill_between_two_steps_leaves_a_whole_motion(saved, left):
    """Before the first rename, between both, before the removal, and within it."""
    found = subprocess.run([sys.executable, "-c", KILLED, saved, str(left)], capture_output=True, timeout=60)
    assert found.returncode == 9, found.stderr
    there = [saved] if saved.exists() else list(saved.parent.glob("a.zarr.*.old"))
    assert len(there) == 1 and np.array_equal(ph.load(there[0]).omega, MOTION.omega)
    MOTION.save(saved)
    assert np.array_equal(ph.load(saved).omega, MOTION.omega)


def test_what_comes_in_while_a_folder_is_replaced_stays(saved, monkeypatch):
    require, calls = _folders.require_saved, []

    def late(folder):
        files = require(folder)
        if folder == saved:
            calls.append(folder)
        if len(calls) == 2:   # after the last look
            (folder / "late.txt").write_text("mine")
        return files

    monkeypatch.setattr(_folders, "require_saved", late)
    MOTION.save(saved)
    assert [path.read_text() for path in saved.parent.rglob("late.txt")] == ["mine"]


# ---- one store, two runs

@pytest.fixture(scope="module")
def recipe(tmp_path_factory):
    pytest.importorskip("zarr")
    return ensembles.write(tmp_path_factory.mktemp("recipe"), ensembles.DRIVEN, count=96)


@pytest.fixture(scope="module")
def whole(recipe):
    out = recipe.parent / "whole.zarr"
    ph.ensemble(recipe, out=out, executor=0)
    return out


BOTH = """
import os, pathlib, sys, time
import polhode as ph
from polhode._ensemble import begin
inner = begin.{at}
def together(*arguments):
    mine, other = pathlib.Path(sys.argv[3]), pathlib.Path(sys.argv[4])
    mine.touch()
    while not other.exists():
        time.sleep(0.001)
    return inner(*arguments)
begin.{at} = together
run = ph.ensemble(sys.argv[1], out=sys.argv[2], executor=0)
assert run.done == run.total
"""


@pytest.mark.parametrize("at", ["begin", "_fill"])
@pytest.mark.parametrize("leftover", [False, True])
def test_two_runs_that_begin_one_store_write_the_same_bytes(recipe, whole, tmp_path, at, leftover):
    """Both find no store, and begin at once; of an older run that was killed there may be something left."""
    out = tmp_path / "out.zarr"
    if leftover:
        (out / "time").mkdir(parents=True)
        (out / "time/zarr.json").write_bytes((whole / "time/zarr.json").read_bytes())
    names = [str(tmp_path / name) for name in ("one", "two")]
    runs = [subprocess.Popen([sys.executable, "-c", BOTH.format(at=at), recipe, out, *order], stderr=subprocess.PIPE,
                             text=True) for order in (names, names[::-1])]
    ends = [run.communicate(timeout=120)[1] for run in runs]
    assert [run.returncode for run in runs] == [0, 0], ends
    assert ensembles.content(out) == ensembles.content(whole)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["one", "out.zarr", "out.zarr.log", "two"]


def test_two_commands_at_once(recipe, whole, tmp_path):
    """As a user would: whichever is late finds a store, and says so in one line."""
    out = tmp_path / "out.zarr"
    runs = [ensembles.start(recipe, "-o", out, "--workers", 1) for _ in range(3)]
    ends = [run.communicate(timeout=120)[1] for run in runs]
    for run, said in zip(runs, ends, strict=True):
        assert run.returncode == 0 or run.returncode == 2 and "must be a new folder" in said, said
        assert "Traceback" not in said
    assert 0 in [run.returncode for run in runs] and ensembles.content(out) == ensembles.content(whole)


def test_a_run_of_another_recipe_that_begins_meanwhile_is_refused(recipe, whole, tmp_path, monkeypatch):
    from polhode._ensemble import begin, run

    other, out = ensembles.write(tmp_path, ensembles.DRIVEN, count=96, seed=4), tmp_path / "out.zarr"
    fill = begin._fill

    def late(folder, task):
        fill(folder, task)
        monkeypatch.setattr(begin, "_fill", fill)
        ph.ensemble(recipe, out=out, executor=0)

    monkeypatch.setattr(begin, "_fill", late)
    with pytest.raises(ph.InvalidInput, match="the store was made from another recipe"):
        run.open_store(run.prepare(other, out=out), resume=False)
    assert ensembles.content(out) == ensembles.content(whole)


def test_a_folder_that_cannot_be_replaced_holds_a_store_too(recipe, whole, tmp_path, monkeypatch):
    """The folder of a mount: the files take their names one by one."""
    out = tmp_path / "out.zarr"
    out.mkdir()
    number = out.stat().st_ino
    monkeypatch.setattr(os.path, "ismount", lambda path: pathlib.Path(path) == out)
    ph.ensemble(recipe, out=out, executor=0)
    assert ensembles.content(out) == ensembles.content(whole) and out.stat().st_ino == number


@pytest.mark.parametrize("name", ["time/notes.txt", "quantile/data.csv", "deep/er/zarr.json"])
def test_a_folder_that_looks_like_the_beginning_of_a_store_is_not_removed(recipe, tmp_path, name):
    file = tmp_path / "mine" / name
    file.parent.mkdir(parents=True)
    file.write_text("mine")
    with pytest.raises(ph.InvalidInput, match="got a folder with other files"):
        ph.ensemble(recipe, out=tmp_path / "mine", resume=True, executor=0)
    assert file.read_text() == "mine"


@pytest.mark.parametrize("kind", ["link", "pipe"])
def test_the_log_is_not_written_through_what_stands_there(recipe, tmp_path, kind):
    log, precious = tmp_path / "out.zarr.log", tmp_path / "precious"
    precious.write_text("precious")
    log.symlink_to("precious") if kind == "link" else os.mkfifo(log)
    ph.ensemble(recipe, out=tmp_path / "out.zarr", executor=0)
    assert precious.read_text() == "precious"
    status, out, err = ensembles.run("status", tmp_path / "out.zarr", "--json")
    assert status == 0 and json.loads(out)["complete"], err


def test_a_store_with_a_link_is_not_resumed(recipe, whole, tmp_path):
    outside, store = tmp_path / "outside", tmp_path / "store.zarr"
    outside.mkdir()
    subprocess.run(["cp", "-r", whole, store], check=True)
    for path in (store / "record").glob("c.*"):
        path.unlink()
    (store / "record").rename(outside / "record")
    (store / "record").symlink_to(outside / "record")
    before = ensembles.content(outside)
    with pytest.raises(ph.InvalidInput, match="record: cannot be read: it is a link"):
        ph.ensemble(recipe, out=store, resume=True, executor=0)
    assert ensembles.content(outside) == before
