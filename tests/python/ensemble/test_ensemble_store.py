"""Stores of ensembles: the same bytes whoever computes them, marks, resuming, damage, and full disks."""

import asyncio
import json
import os
import pathlib
import shutil
import subprocess
import time

import ensembles
import numpy as np
import pytest

import polhode as ph

zarr = pytest.importorskip("zarr")
xarray = pytest.importorskip("xarray")


@pytest.fixture(scope="module")
def whole(whole_store):
    return whole_store


@pytest.fixture
def copy(whole, tmp_path):
    return pathlib.Path(shutil.copytree(whole, tmp_path / "copy.zarr"))


def remove_marks(store, chunks):
    for chunk in chunks:
        (store / "record" / f"c.{chunk}.0").unlink()


def test_the_store_is_zarr_with_names_and_units(recipe, whole):
    run = ph.load(whole)
    data = xarray.open_zarr(whole)
    assert data.attrs["Conventions"] == "CF-1.11"
    assert data.omega.dims == ("body", "state_time", "axis") and data.omega.attrs["units"] == "rad s-1"
    assert all({"units", "long_name"} & array.attrs.keys() for array in data.variables.values())
    states = run.states(range(500))
    assert np.array_equal(data.omega.values, states.omega) and np.array_equal(data.attitude.values, states.attitude)
    assert np.array_equal(data.status.values, states.status) and np.array_equal(data.time.values, run.times)
    summary = run.summary["angle"]
    assert np.array_equal(data.angle_mean.values, summary.mean) and np.array_equal(data.angle_max.values, summary.max)
    bounds = summary.quantile(data["quantile"].values)
    assert np.array_equal(data.angle_quantile_upper.values, bounds.upper)
    assert run.dataset.sizes == data.sizes and run.done == run.total == 500
    assert (np.diff(data["quantile"].values) > 0).all() and {0.01, 0.5, 0.99} <= set(data["quantile"].values)
    least, most = summary.quantile(0.0), summary.quantile(1.0)   # of the first and of the last body
    assert np.array_equal(least.lower, summary.min) and np.array_equal(most.upper, summary.max)


def test_a_swept_store_has_a_dimension_for_its_points(tmp_path):
    text = ensembles.DRIVEN + '[sweep]\n"torques.0.weight" = [1.0, 2.0]\n'
    run = ph.ensemble(ensembles.write(tmp_path, text), out=tmp_path / "a.zarr", executor=0, count=70)
    data = ph.load(tmp_path / "a.zarr").dataset
    assert data.omega.dims == ("point", "body", "state_time", "axis") and data.angle_mean.dims == ("point", "time")
    for point in (0, 1):
        assert np.array_equal(data.omega.values[point], run.states(range(70), point=point).omega)
        assert np.array_equal(data.angle_mean.values[point], run.summary["angle"].mean[point])
    assert ensembles.run("status", tmp_path / "a.zarr", "--verify")[0] == 0 and len(run.to_pandas()) == 22


def test_float32_states_at_every_second_time(tmp_path):
    text = ensembles.FREE + 'states = "float32"\nevery = 2\n'
    run = ph.ensemble(ensembles.write(tmp_path, text), out=tmp_path / "a.zarr", executor=0, count=6000)
    states = run.states(range(6000)).attitude[:, ::2]
    assert np.array_equal(run.dataset.attitude.values, states.astype(np.float32)) and states.shape == (6000, 3, 4)
    assert np.array_equal(run.dataset.state_time.values, run.times[::2])


def test_no_file_of_a_store_tells_time_host_or_workers(whole):
    texts = b"".join(data for name, data in ensembles.content(whole).items() if name.endswith("json"))
    for word in (os.uname().nodename, "worker", "host", "pid", "seconds", "\"date", str(whole.parent)):
        assert word.encode() not in texts, word
    assert {event["event"] for event in ensembles.events(whole)} == {"begin", "done", "end"}


def test_each_way_in_which_zarr_writes_leaves_the_file_whole(tmp_path):
    """Newer versions of zarr write at once, older ones in a loop of events: no draft is left by either."""
    from zarr.core.buffer import cpu

    from polhode._ensemble.files import LastingStore

    store = LastingStore(tmp_path)
    asyncio.run(store.set("a/loop", cpu.Buffer.from_bytes(b"12")))
    asyncio.run(store.set_if_not_exists("a/loop", cpu.Buffer.from_bytes(b"34")))
    if hasattr(zarr.storage.LocalStore, "set_sync"):
        store.set_sync("a/once", cpu.Buffer.from_bytes(b"56"))
        assert (tmp_path / "a/once").read_bytes() == b"56"
        (tmp_path / "a/once").unlink()
    assert {path.name: path.read_bytes() for path in (tmp_path / "a").iterdir()} == {"loop": b"12"}


def test_a_resumed_store_computes_only_what_has_no_mark(recipe, whole, copy):
    remove_marks(copy, (0, 3, 15))
    kept = ensembles.marks(copy)
    run = ph.ensemble(recipe, out=copy, resume=True, executor=0)
    assert ensembles.content(copy) == ensembles.content(whole) and run.done == 500
    assert {name: value for name, value in ensembles.marks(copy).items() if name in kept} == kept
    assert sorted(event["chunk"] for event in ensembles.events(copy) if event["event"] == "done") == [0, 3, 15]


def test_the_time_that_is_left_is_told_while_a_run_goes_on(copy, monkeypatch):
    """Two of sixteen chunks in ten seconds: fourteen more take seventy. Of a run that has ended nothing is foretold."""
    from polhode._ensemble import log
    from polhode._ensemble.status import status

    remove_marks(copy, range(2, 16))
    now = time.time()
    events = [{"event": "begin", "at": now - 10}, {"event": "done", "chunk": 0, "seconds": 5.0, "at": now - 5},
              {"event": "done", "chunk": 1, "seconds": 5.0, "at": now}]
    for more, left in (([], pytest.approx(70.0)), ([{"event": "interrupted", "at": now}], None)):
        monkeypatch.setattr(log, "read", lambda out, found=events + more: found)
        told = status(ph.load(copy))
        assert (told["running"], told["seconds_left"], told["chunks_done"]) == (left is not None, left, 2)


def test_a_worker_computes_no_chunk_that_another_run_has_marked(recipe, copy):
    from polhode._ensemble import chunk, run

    task = run.prepare(recipe, out=copy)
    assert chunk.run(task, 2).kind == "found"
    remove_marks(copy, [2])
    assert [chunk.run(task, 2).kind for _ in range(2)] == ["done", "found"]


def test_early_results_are_those_of_the_chunks_that_are_done(recipe, copy):
    remove_marks(copy, range(4, 16))
    run = ph.load(copy)
    assert run.done == 4 * 32 and run.total == 500 and run.chunks == (0, 1, 2, 3)
    omega = np.linalg.norm(run.states(range(128)).omega, axis=-1)
    assert np.allclose(run.summary["omega"].mean, omega.mean(axis=0), rtol=1e-13)
    assert np.isnan(run.dataset.record.values[4:]).all() and not np.isnan(run.dataset.record.values[:4]).any()


def test_gaps_in_the_middle_are_no_obstacle(copy):
    remove_marks(copy, (0, 5, 6, 9))
    run = ph.load(copy)
    there = [i for i in range(500) if i // 32 not in (0, 5, 6, 9)]
    omega = np.linalg.norm(run.states(there).omega, axis=-1)
    assert np.allclose(run.summary["omega"].mean, omega.mean(axis=0), rtol=1e-13)


def test_a_store_that_is_there_is_refused_without_resume(recipe, whole):
    before = ensembles.content(whole)
    with pytest.raises(ph.InvalidInput, match="must be a new folder; resume=True or --resume goes on"):
        ph.ensemble(recipe, out=whole, executor=0)
    assert ensembles.content(whole) == before


def test_resume_begins_a_store_that_is_not_there_or_has_only_unfinished_metadata(recipe, whole, tmp_path):
    for name in ("none", "empty", "unfinished"):
        out = tmp_path / name
        if name != "none":
            out.mkdir()
        if name == "unfinished":
            shutil.copytree(whole / "time", out / "time")
            (out / "record").mkdir()
            (out / "record/zarr.json.0123.partial").write_bytes(b"{")
        ph.ensemble(recipe, out=out, resume=True, executor=0)
        assert ensembles.content(out) == ensembles.content(whole)


@pytest.mark.parametrize("name", ["notes.txt", "record/data.csv", "c.0.0"])
def test_a_folder_of_somebody_else_is_never_touched(recipe, tmp_path, name):
    file = tmp_path / "mine" / name
    file.parent.mkdir(parents=True)
    file.write_text("mine")
    for resume in (False, True):
        with pytest.raises(ph.InvalidInput, match="must be a store of an ensemble, got a folder with other files"):
            ph.ensemble(recipe, out=tmp_path / "mine", resume=resume, executor=0)
    assert file.read_text() == "mine"
    with pytest.raises(ph.InvalidInput, match="must be a store of an ensemble, got a file"):
        ph.ensemble(recipe, out=file, executor=0)


def set_stamp(store, **changes):
    path = store / "zarr.json"
    content = json.loads(path.read_text())
    content["attributes"]["polhode_ensemble"]["stamp"] |= changes
    path.write_text(json.dumps(content))


STAMPS = [({"version": "0.1.0"}, "the store was made by polhode 0.1.0, and this is "),
          ({"format": 99}, "the store has format 99, and this polhode writes 1"),
          ({"simd": "other"}, "the store was made with other arithmetic, and this machine uses "),
          ({"recipe": "0" * 64}, "the store was made from another recipe (000000000000, now ")]


@pytest.mark.parametrize("changes, message", STAMPS, ids=[next(iter(changes)) for changes, _ in STAMPS])
def test_another_stamp_is_refused_by_name(recipe, copy, changes, message):
    set_stamp(copy, **changes)
    with pytest.raises(ph.InvalidInput) as refused:
        ph.ensemble(recipe, out=copy, resume=True, executor=0)
    assert message in str(refused.value)
    with pytest.raises(ph.InvalidInput):
        ph.load(copy)


def test_another_count_or_recipe_is_refused(recipe, copy, tmp_path):
    with pytest.raises(ph.InvalidInput, match="the store has 500 bodies, and 400 were requested"):
        ph.ensemble(recipe, out=copy, resume=True, executor=0, count=400)
    other = ensembles.write(tmp_path, ensembles.DRIVEN, seed=4)
    with pytest.raises(ph.InvalidInput, match="the store was made from another recipe"):
        ph.ensemble(other, out=copy, resume=True, executor=0)


def test_the_baseline_of_simd_is_another_arithmetic(recipe, copy):
    if ph.build_info()["simd"] == "baseline":
        pytest.skip("lacks a level")
    env = {**os.environ, "POLHODE_SIMD": "baseline"}
    status, _, err = ensembles.run(recipe, "-o", copy, "--resume", env=env)
    assert status == 2 and "made with fused arithmetic, and this machine uses baseline" in err


def flip(path, place=-20):
    data = bytearray(path.read_bytes())
    data[place] ^= 1
    path.write_bytes(bytes(data))


def test_a_flipped_bit_of_a_record_is_refused_by_name(recipe, copy):
    flip(copy / "record/c.7.0")
    for attempt in (lambda: ph.ensemble(recipe, out=copy, resume=True, executor=0), lambda: ph.load(copy).summary):
        with pytest.raises(ph.InvalidInput, match=r"c.7.0: the record of chunk 7 is damaged .*; remove the file"):
            attempt()


def test_every_bit_of_a_record_is_guarded(whole, tmp_path):
    size = (whole / "record/c.2.0").stat().st_size
    store = pathlib.Path(shutil.copytree(whole, tmp_path / "bits.zarr"))
    good = (store / "record/c.2.0").read_bytes()
    for place in np.linspace(0, size - 1, 25).astype(int):
        (store / "record/c.2.0").write_bytes(good)
        flip(store / "record/c.2.0", place)
        with pytest.raises(ph.InvalidInput, match="chunk 2 is damaged"):
            ph.load(store).records([2])


@pytest.mark.parametrize("name", ["omega", "attitude", "error", "status"])
def test_a_file_cut_short_or_missing_is_refused_by_name(recipe, whole, tmp_path, name):
    store = pathlib.Path(shutil.copytree(whole, tmp_path / "cut.zarr"))
    (file,) = [path for path in (store / name).glob("c.4*")]
    data = file.read_bytes()
    file.write_bytes(data[:-1])
    with pytest.raises(ph.InvalidInput, match=rf"{name}/c.4[.0]*: must have {len(data)} bytes, got {len(data) - 1}"):
        ph.ensemble(recipe, out=store, resume=True, executor=0)
    file.unlink()
    with pytest.raises(ph.InvalidInput, match=f"must have {len(data)} bytes, got 0; remove .*record/c.4.0"):
        ph.ensemble(recipe, out=store, resume=True, executor=0)
    (store / "record/c.4.0").unlink()   # as the message says
    ph.ensemble(recipe, out=store, resume=True, executor=0)
    assert ensembles.content(store) == ensembles.content(whole)


def test_a_flipped_bit_of_states_is_found_by_verify_and_by_readers(copy):
    flip(copy / "omega/c.5.0.0", 100)
    status, _, err = ensembles.run("status", copy, "--verify")
    assert status == 2 and "omega/c.5.0.0: the checksum is wrong; remove " in err
    with pytest.raises(Exception, match="(?i)checksum"):
        ph.load(copy).dataset.omega.values
    assert ensembles.run("status", copy)[0] == 0


@pytest.mark.parametrize("changes", [{"slab": 0}, {"slab": 64}, {"chunk": 48}, {"number": 10**12}, {"points": 2},
                                     {"chunk": -32}, {"chunk": "32"}, {"slab": 2.5}])
def test_a_layout_that_is_none_is_refused(copy, changes):
    path = copy / "zarr.json"
    content = json.loads(path.read_text())
    content["attributes"]["polhode_ensemble"]["layout"] |= changes
    path.write_text(json.dumps(content))
    with pytest.raises(ph.InvalidInput, match="must have the layout of its recipe"):
        ph.load(copy)


def test_damaged_metadata_is_refused(recipe, copy):
    (copy / "zarr.json").write_bytes((copy / "zarr.json").read_bytes()[:-200])
    with pytest.raises(ph.InvalidInput, match="zarr.json is damaged, or is not that of an ensemble"):
        ph.ensemble(recipe, out=copy, resume=True, executor=0)


def test_states_are_on_the_disk_before_their_mark(recipe, tmp_path, monkeypatch):
    seen, sync, replace = [], os.fsync, os.replace
    monkeypatch.setattr(os, "fsync", lambda number: (seen.append("sync"), sync(number)))
    monkeypatch.setattr(os, "replace", lambda draft, path: (seen.append(path), replace(draft, path)))
    ph.ensemble(recipe, out=tmp_path / "out.zarr", executor=0)
    # A store begins in a folder aside.
    names = [pathlib.Path(item).relative_to(tmp_path).parts[1:] for item in seen if item != "sync"]
    files = [pathlib.Path(*parts) for parts in names]
    for place, item in enumerate(seen):   # each file, and its folder after the change of name
        assert item == "sync" or seen[place - 1] == seen[place + 1] == "sync", item
    for chunk in range(16):
        mark = files.index(pathlib.Path(f"record/c.{chunk}.0"))
        parts = [files.index(pathlib.Path(name)) for name in (f"omega/c.{chunk}.0.0", f"attitude/c.{chunk}.0.0",
                                                              f"status/c.{chunk}", f"error/c.{chunk}")]
        assert max(parts) < mark and files.index(pathlib.Path("zarr.json")) < min(parts)


def test_a_draft_that_another_run_cleaned_away_is_written_again(tmp_path, monkeypatch):
    from polhode._ensemble import files

    replace, left = os.replace, [2]

    def cleaned(draft, path):
        if left[0]:
            left[0] -= 1
            os.unlink(draft)
        return replace(draft, path)

    monkeypatch.setattr(os, "replace", cleaned)
    files.write(tmp_path / "a/b", b"whole")
    assert (tmp_path / "a/b").read_bytes() == b"whole" and len(list((tmp_path / "a").iterdir())) == 1


def test_orphans_are_cleaned(recipe, whole, copy):
    for name in ("record/c.3.0", "omega/c.99.0.0", "zarr.json"):
        (copy / f"{name}.0123456789abcdef.partial").write_bytes(b"half")
    remove_marks(copy, [3])
    ph.ensemble(recipe, out=copy, resume=True, executor=0)
    assert ensembles.content(copy) == ensembles.content(whole)


def test_two_resumes_at_once_give_the_same_bytes(recipe, whole, copy):
    remove_marks(copy, range(16))
    runs = [ensembles.start(recipe, "-o", copy, "--resume", "--workers", 1) for _ in range(2)]
    ends = [run.communicate(timeout=120) for run in runs]
    assert [run.returncode for run in runs] == [0, 0], ends
    assert ensembles.content(copy) == ensembles.content(whole)


# ---- full disks

@pytest.fixture
def small_disk(tmp_path):
    """A file system of its own whose size a function sets."""
    folder = tmp_path / "disk"
    folder.mkdir()

    def mount(*options):
        return subprocess.run(["mount", *options, str(folder)], capture_output=True).returncode == 0

    if os.name != "posix" or os.geteuid() or not mount("-t", "tmpfs", "-o", "size=40k", "none"):
        pytest.skip("needs root and mount")
    try:
        yield folder, lambda size: mount("-o", f"remount,size={size}")
    finally:
        subprocess.run(["umount", "-l", str(folder)], check=True)


def pages(sizes):
    """The bytes that files take on a tmpfs."""
    return sum(-(-size // 4096) * 4096 for size in sizes)


@pytest.mark.parametrize("kind", ["metadata", "states", "records"])
def test_a_full_disk_ends_the_run_at_once_and_is_resumable(tmp_path, small_disk, kind):
    folder, resize = small_disk
    text = ensembles.DRIVEN if kind != "records" else ensembles.DRIVEN.replace('states = "float64"', 'states = "none"')
    path, whole, store = ensembles.write(tmp_path, text), tmp_path / "whole.zarr", folder / "out.zarr"
    ph.ensemble(path, out=whole, executor=0)
    sizes = {name: len(data) for name, data in ensembles.content(whole).items()}
    fixed = pages(size for name, size in sizes.items() if name.endswith("zarr.json"))
    size = fixed // 2 if kind == "metadata" else fixed + (pages(sizes.values()) - fixed) // 2
    assert resize(size)
    status, out, err = ensembles.run(path, "-o", store, "--workers", 2)
    last = err.splitlines()[-1]
    assert status == 1 and "the disk is full" in last and "bytes more" in last and "Traceback" not in err, err
    events = ensembles.events(store)
    vain = [event for event in events if event["event"] == "full"]
    done = {event["chunk"] for event in events if event["event"] == "done"}
    assert len(vain) <= 2 and not {event["chunk"] for event in vain} & done
    assert kind == "metadata" or 0 < len(ensembles.marks(store)) < 16
    assert resize("64m")
    ph.ensemble(path, out=store, resume=True, executor=0)
    assert ensembles.content(store) == ensembles.content(whole)


def test_a_dry_run_refuses_a_disk_with_less(tmp_path, small_disk):
    folder, resize = small_disk
    path = ensembles.write(tmp_path, ensembles.DRIVEN)
    status, out, err = ensembles.run(path, "-o", folder / "out.zarr", "--dry-run")
    assert status == 1 and "are missing" in err and err.count("\n") == 1 and "bodies" in out
    assert not (folder / "out.zarr").exists()
    assert resize("64m")
    assert ensembles.run(path, "-o", folder / "out.zarr", "--dry-run")[0] == 0
