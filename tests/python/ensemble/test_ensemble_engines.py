"""Engines of ensembles: one hash for all of them, chunks that kill their workers, and kills from outside."""

import concurrent.futures
import hashlib
import multiprocessing
import os
import pathlib
import signal
import threading

import ensembles
import numpy as np
import pytest

import polhode as ph
from polhode._ensemble import engine, processes, store

zarr = pytest.importorskip("zarr")
# Dask leaves sockets to the collector of garbage, also in tests that come later.
pytestmark = [pytest.mark.filterwarnings("ignore::ResourceWarning"),
              pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")]


@pytest.fixture(scope="module")
def whole(whole_store):
    """The bytes of a store of the recipe."""
    return ensembles.content(whole_store)


def to_hash(run):
    """A hash of all sums of an ensemble, whatever its chunks."""
    found = hashlib.sha256()
    for summary in run.summary.values():
        for name in ("count", "mean", "rms", "min", "max", "histogram"):
            found.update(np.ascontiguousarray(getattr(summary, name)).tobytes())
    return found.hexdigest()


# ---- one hash

@pytest.fixture(scope="module")
def cluster():
    distributed = pytest.importorskip("distributed")
    import dask

    with dask.config.set({"distributed.worker.daemon": True, "distributed.admin.log-format": "%(message)s"}):
        with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=":0",
                                      silence_logs=50) as local:
            yield local


def pool(workers):
    return concurrent.futures.ProcessPoolExecutor(workers, multiprocessing.get_context("spawn"))


@pytest.mark.parametrize("workers", [1, 2, 3])
def test_stores_do_not_depend_on_the_number_of_workers(recipe, whole, tmp_path, workers):
    run = ph.ensemble(recipe, out=tmp_path / "out.zarr", executor=workers)
    assert run.done == 500 and not run.failed
    assert ensembles.content(tmp_path / "out.zarr") == whole


def test_executors_of_the_standard_library_give_the_same_bytes(recipe, whole, tmp_path):
    with pool(2) as executor:
        ph.ensemble(recipe, out=tmp_path / "pool.zarr", executor=executor)
    with concurrent.futures.ThreadPoolExecutor(2) as executor:
        ph.ensemble(recipe, out=tmp_path / "threads.zarr", executor=executor)
    assert ensembles.content(tmp_path / "pool.zarr") == whole == ensembles.content(tmp_path / "threads.zarr")


def test_threads_that_open_an_array_together_write_its_chunks_of_nan(recipe, tmp_path, monkeypatch):
    out = str(tmp_path / "out.zarr")
    ph.ensemble(recipe, out=out, executor=0)
    first_opens, second_opens, first_has_it = (threading.Event() for _ in range(3))
    opened = store.group_of

    def group(path, mode):
        """The second thread begins while the first opens, and goes on when the first has its array."""
        if threading.current_thread().name == "first":
            first_opens.set()
            assert second_opens.wait(20)
        else:
            second_opens.set()
            assert first_has_it.wait(20)
        return opened(path, mode)

    found = {}

    def first():
        found["first"] = store._array(out, "error", "first")
        first_has_it.set()

    def second():
        assert first_opens.wait(20)
        found["second"] = store._array(out, "error", "second")

    monkeypatch.setattr(store, "group_of", group)
    threads = [threading.Thread(target=target, name=target.__name__) for target in (first, second)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    chunk = store.file_of(out, "error", 0)
    for array in found.values():
        chunk.unlink()
        array[:array.chunks[0]] = np.nan
        assert chunk.is_file()
    assert len(found) == 2 and not zarr.config.get("array.write_empty_chunks")


def test_dask_gives_the_same_bytes_by_client_and_by_address(recipe, whole, cluster, tmp_path):
    from distributed import Client

    with Client(cluster, set_as_default=False) as client:
        ph.ensemble(recipe, out=tmp_path / "client.zarr", executor=client)
    ph.ensemble(recipe, out=tmp_path / "address.zarr", executor=cluster.scheduler_address)
    assert ensembles.content(tmp_path / "client.zarr") == whole == ensembles.content(tmp_path / "address.zarr")


def test_sums_do_not_depend_on_the_chunks_or_the_engine(tmp_path, cluster):
    found = set()
    for chunk, executor in ((4096, 0), (8192, 2), (16384, cluster.scheduler_address), (32768, 1)):
        path = ensembles.write(tmp_path, ensembles.FREE, chunk=chunk)
        found.add(to_hash(ph.ensemble(path, executor=executor)))
    assert len(found) == 1


@pytest.mark.parametrize("wrong, message", [
    (-1, "executor: must be 0 to 4096 worker processes"), (True, "executor: must be None, a number"),
    (1.5, "executor: must be None, a number"), ("tcp://127.0.0.1:1", "executor: tcp://127.0.0.1:1 does not answer"),
    ("nonsense://", "does not answer")])
def test_wrong_executors_are_refused(tmp_path, wrong, message):
    recipe = ensembles.write(tmp_path, ensembles.FREE)
    if isinstance(wrong, str):
        pytest.importorskip("distributed")
        import dask

        dask.config.set({"distributed.comm.timeouts.connect": "1s"})
    try:
        with pytest.raises(ph.InvalidInput, match=message):
            ph.ensemble(recipe, executor=wrong)
    finally:
        if isinstance(wrong, str):
            dask.config.refresh()


def test_nannies_do_not_double_the_time_of_a_chunk(cluster):
    from distributed import Client

    with Client(cluster, set_as_default=False) as client:
        (before, faults), = [found for found in client.run(measure_faults).values()][:1]
    assert before and faults < 3000   # 60 arrays of 8 MB, mapped anew each time, have 56 000


def measure_faults():
    """What a worker of a nanny does with memory: was it told to return it, and page faults once that is undone."""
    import resource

    from polhode._ensemble import memory

    told = memory.keep()
    np.ones(1_000_000)
    start = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(60):
        np.ones(1_000_000)
    return told, resource.getrusage(resource.RUSAGE_SELF).ru_minflt - start


# ---- functions, and what goes wrong in them

TILT = ensembles.FREE.replace("samples = 6", "samples = 3") + '[[summary]]\nof = "function"\nfunction = "tilt"\n'


def test_a_users_function_is_summed_up(tmp_path):
    path = ensembles.write(tmp_path, TILT)
    run = ph.ensemble(path, executor=2, functions={"tilt": ensembles.tilt})
    values = ensembles.tilt(run.times, None, run.states(range(20000)).attitude)
    assert np.allclose(run.summary["tilt"].mean, values.mean(axis=0), rtol=1e-12)
    assert np.array_equal(run.summary["tilt"].max, values.max(axis=0))


def test_functions_are_refused_where_they_cannot_be_had(tmp_path):
    path = ensembles.write(tmp_path, TILT)
    with pytest.raises(ph.InvalidInput, match="functions: must have 'tilt', which the recipe names; files run no code"):
        ph.ensemble(path, executor=0)
    status, _, err = ensembles.run(path, "-o", tmp_path / "out.zarr")
    assert status == 2 and "functions: must have 'tilt'" in err and not (tmp_path / "out.zarr").exists()
    with pytest.raises(ph.InvalidInput, match="functions: tilt must be callable"):
        ph.ensemble(path, executor=0, functions={"tilt": 3})

    def local(times, omega, attitude):
        return attitude[..., 0]

    local.__module__ = "__main__"
    with pytest.raises(ph.InvalidInput, match="must stand in a module that worker processes can import"):
        ph.ensemble(path, executor=1, functions={"tilt": local})
    with pytest.raises(ph.InvalidInput, match="tilt must return an array of shape"):
        run = ph.ensemble(path, executor=0, functions={"tilt": lambda times, omega, attitude: omega})
        raise ph.InvalidInput(next(iter(run.failed.values())))


def with_first(tmp_path, monkeypatch):
    """A recipe of six chunks whose function knows the first chunk."""
    text = TILT.replace("chunk = 4096", "chunk = 1024")
    path = ensembles.write(tmp_path, text, count=6000)
    first = ph.ensemble(path, executor=0, functions={"tilt": ensembles.tilt}, count=8).states([0]).attitude[0, 0, 0]
    monkeypatch.setenv("POLHODE_TEST_FIRST", repr(float(first)))
    return path


def test_a_chunk_that_always_kills_its_worker_is_given_up_alone(tmp_path, monkeypatch):
    path, out = with_first(tmp_path, monkeypatch), tmp_path / "out.zarr"
    run = ph.ensemble(path, out=out, executor=2, functions={"tilt": ensembles.die_for_first})
    assert run.failed == {0: "the worker ended its process with status 9"} and run.chunks == (1, 2, 3, 4, 5)
    died = [event for event in ensembles.events(out) if event["event"] == "died"]
    assert [event["chunk"] for event in died] == [0] * engine.TRIES
    assert run.done == 6000 - 1024 and run.summary["tilt"].count[0] == run.done
    status, text, err = ensembles.run("status", out)
    assert status == 1 and "failed  chunk 0: the worker ended its process with status 9" in text


@pytest.mark.long
def test_dask_gives_up_that_chunk_alone_too(tmp_path, monkeypatch):
    distributed = pytest.importorskip("distributed")
    path = with_first(tmp_path, monkeypatch)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0", silence_logs=50) as local:
        run = ph.ensemble(path, out=tmp_path / "out.zarr", executor=local.scheduler_address,
                          functions={"tilt": ensembles.die_for_first})
    assert list(run.failed) == [0] and run.chunks == (1, 2, 3, 4, 5)


def test_a_chunk_that_raises_fails_alone_and_at_once(tmp_path, monkeypatch):
    path, out = with_first(tmp_path, monkeypatch), tmp_path / "out.zarr"
    run = ph.ensemble(path, out=out, executor=2, functions={"tilt": ensembles.fail_for_first})
    assert run.failed == {0: "ValueError: no such body"} and run.chunks == (1, 2, 3, 4, 5)
    assert len([event for event in ensembles.events(out) if event["event"] == "failed"]) == 1
    monkeypatch.setenv("POLHODE_TEST_FIRST", "7")
    done = ph.ensemble(path, out=out, executor=2, resume=True, functions={"tilt": ensembles.fail_for_first})
    assert not done.failed and done.done == 6000


def test_a_broken_executor_ends_the_run_with_its_reason(tmp_path, monkeypatch):
    path = with_first(tmp_path, monkeypatch)
    with pool(1) as executor:
        run = ph.ensemble(path, out=tmp_path / "out.zarr", executor=executor,
                          functions={"tilt": ensembles.die_for_first})
    assert run.failed and all("BrokenProcessPool" in why or "terminated abruptly" in why for why in run.failed.values())


# ---- progress

def test_progress_is_told_and_may_end_the_run(recipe, whole, tmp_path, capsys):
    seen, out = [], tmp_path / "out.zarr"

    def progress(done, total):
        seen.append((done, total))
        return done < 200

    run = ph.ensemble(recipe, out=out, executor=0, progress=progress)
    assert seen[-1] == (224, 500) and run.done == 224 and [done for done, _ in seen] == sorted(done for done, _ in seen)
    run = ph.ensemble(recipe, out=out, executor=0, progress=True, resume=True)
    assert run.done == 500 and ensembles.content(out) == whole
    assert "500 of 500 bodies" in capsys.readouterr().err
    with pytest.raises(ph.InvalidInput, match="progress: must be callable"):
        ph.ensemble(recipe, out=tmp_path / "never.zarr", executor=0, progress=3)
    assert not (tmp_path / "never.zarr").exists()


# ---- kills

def begin(recipe, out, moment, *arguments):
    """Start a run and let it go on until so many chunks are marked."""
    process = ensembles.start(recipe, "-o", out, "--workers", 2, "--resume", *arguments)
    ensembles.wait_for(lambda: len(ensembles.marks(out)) >= moment, process)
    return process


def resumed(recipe, out, whole, kept):
    """Resume a run; the store is as if undisturbed, and no marked chunk was computed again."""
    ph.ensemble(recipe, out=out, resume=True, executor=0)
    assert ensembles.content(out) == whole
    now = ensembles.marks(out)
    assert {name: now[name] for name in kept} == kept
    done = [event["chunk"] for event in ensembles.events(out) if event["event"] == "done"]
    assert len(done) == len(set(done))


MOMENTS = [pytest.param(3), *(pytest.param(k, marks=pytest.mark.long) for k in (1, 5, 8, 11, 14))]


@pytest.mark.parametrize("moment", MOMENTS)
def test_a_killed_worker_costs_its_chunk_alone(recipe, whole, tmp_path, moment):
    out = tmp_path / "out.zarr"
    process = begin(recipe, out, moment)
    ensembles.kill(*ensembles.children(process.pid)[:1])
    assert process.wait(timeout=120) == 0, process.stderr.read()
    process.communicate()
    assert ensembles.content(out) == whole


@pytest.mark.parametrize("moment", MOMENTS)
def test_a_killed_group_is_resumed_to_the_same_bytes(recipe, whole, tmp_path, moment):
    out = tmp_path / "out.zarr"
    process = begin(recipe, out, moment)
    assert pytest.importorskip("xarray").open_zarr(out).record.shape[0] == 16 and 0 < ph.load(out).done <= 500
    ensembles.kill(process.pid, *ensembles.children(process.pid))
    process.communicate()
    kept = ensembles.marks(out)
    status, text, _ = ensembles.run("status", out)
    assert status == 0 and f"{sum(min(32, 500 - 32 * int(name.split('.')[1])) for name in kept)} of 500 bodies" in text
    resumed(recipe, out, whole, kept)


@pytest.mark.parametrize("moment", MOMENTS)
def test_workers_of_a_killed_command_end_and_leave_a_whole_store(recipe, whole, tmp_path, moment):
    out = tmp_path / "out.zarr"
    process = begin(recipe, out, moment)
    workers = ensembles.children(process.pid)
    ensembles.kill(process.pid)
    process.communicate()
    ensembles.wait_for(lambda: not [pid for pid in workers if pathlib.Path(f"/proc/{pid}").exists()])
    resumed(recipe, out, whole, ensembles.marks(out))


@pytest.mark.parametrize("moment", MOMENTS)
@pytest.mark.parametrize("number", [signal.SIGINT, pytest.param(signal.SIGTERM, marks=pytest.mark.long)],
                         ids=["ctrl-c", "term"])
def test_ctrl_c_leaves_a_resumable_store_and_no_process(recipe, whole, tmp_path, number, moment):
    out = tmp_path / "out.zarr"
    process = begin(recipe, out, moment)
    workers = ensembles.children(process.pid)
    os.kill(process.pid, number)
    _, err = process.communicate(timeout=30)
    if number == signal.SIGINT:
        assert process.returncode == 130 and "Traceback" not in err, err
        assert not [pid for pid in workers if pathlib.Path(f"/proc/{pid}").exists()]
    ensembles.wait_for(lambda: not [pid for pid in workers if pathlib.Path(f"/proc/{pid}").exists()])
    resumed(recipe, out, whole, ensembles.marks(out))


@pytest.mark.parametrize("moment", MOMENTS)
def test_a_killed_scheduler_ends_the_run_and_the_store_goes_on_elsewhere(recipe, whole, tmp_path, moment):
    pytest.importorskip("distributed")
    quick = {**os.environ, "DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "2s"}
    out = tmp_path / "out.zarr"
    with ensembles.scheduler(tmp_path) as (address, group):
        process = ensembles.start(recipe, "-o", out, "--scheduler", address, env=quick)
        ensembles.wait_for(lambda: len(ensembles.marks(out)) >= moment, process)
        os.killpg(group, signal.SIGKILL)
        _, err = process.communicate(timeout=90)
        whole_already = len(ensembles.marks(out)) == 16   # the kill came after the last chunk
        told = err.splitlines()[-1].startswith("polhode: chunk ") and "was given up: " in err   # beside Dask's own log
        assert process.returncode == 1 and told or whole_already, err
    resumed(recipe, out, whole, ensembles.marks(out))


# ---- the processes

def test_a_process_serves_many_calls_and_dies_for_one():
    with processes.Processes(1) as executor:
        assert [executor.submit(pow, 2, k).result() for k in range(4)] == [1, 2, 4, 8]
        first, = executor.pids
        with pytest.raises(processes.WorkerDied, match="ended its process with status 3"):
            executor.submit(os._exit, 3).result()
        assert executor.submit(pow, 3, 2).result() == 9 and executor.pids != [first]
        with pytest.raises(RuntimeError, match="ZeroDivisionError"):
            executor.submit(divmod, 1, 0).result()
    assert executor.pids == []
