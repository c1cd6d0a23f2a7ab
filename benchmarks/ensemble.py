"""Speed of ensembles: states summed up, driven bodies, and what the engines cost beside the chunks.

    python benchmarks/ensemble.py [sums] [driven] [overhead] [--small]

CPU times are those of all processes. `--small` takes a tenth of the bodies.
"""

import json
import pathlib
import resource
import shutil
import sys
import tempfile
import time

import polhode as ph
from polhode._build import processor

ROOT = pathlib.Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests/support"))
import ensembles  # noqa: E402

ANGLE = '[[summary]]\nof = "angle"\n'
FREE = ensembles.change(ensembles.FREE.partition("[store]")[0] + ANGLE, span=1000.0, samples=500)
HEAVY = ensembles.change(ensembles.DRIVEN.partition("[[summary]]")[0] + ANGLE, seed=8, samples=101)


def cpu():
    return sum(sum(resource.getrusage(who)[:2]) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))


def measure(text, count, executor, folder, store=True):
    """Run a recipe; return wall and CPU seconds, those of the chunks, and the largest memory of a child [MB]."""
    out = folder / "out.zarr"
    shutil.rmtree(out, ignore_errors=True)
    log = folder / "out.zarr.log"
    log.unlink(missing_ok=True)
    path = ensembles.write(folder, text, count=count)
    wall, start = time.perf_counter(), cpu()
    run = ph.ensemble(path, out=out if store else None, executor=executor)
    wall, total = time.perf_counter() - wall, cpu() - start
    assert run.done == count and not run.failed
    events = [json.loads(line) for line in log.read_text().splitlines()] if store else []
    chunks = [event["cpu"] for event in events if event["event"] == "done"]
    peak = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
    return {"wall": wall, "cpu": total, "chunks_cpu": sum(chunks), "chunks": len(chunks), "largest_child_MB": peak}


def show(name, bodies, times, found):
    rate, each = bodies / found["wall"], 1e9 * found["chunks_cpu"] / (bodies * times)
    over = 100 * (found["cpu"] / found["chunks_cpu"] - 1) if found["chunks_cpu"] else float("nan")
    print(f"{name:34s} {bodies * times:12.3g} states  wall {found['wall']:7.1f} s  CPU {found['cpu']:7.1f} s  "
          f"chunks {found['chunks_cpu']:7.1f} s in {found['chunks']:4d}  {each:7.1f} ns a state  "
          f"{rate:9.0f} bodies/s  beside the chunks {over:5.1f} %  child {found['largest_child_MB']:4.0f} MB",
          flush=True)


def main(words):
    small = "--small" in words
    wanted = [word for word in words if not word.startswith("--")] or ["sums", "driven", "overhead"]
    print(f"polhode {ph.__version__}, {ph.build_info()['simd']}, {processor()}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        if "sums" in wanted:
            count = 200_000 if small else 2_000_000
            show("free, angle, 1 process", count, 500, measure(FREE, count, 1, folder))
        if "driven" in wanted:
            count = 100_000 if small else 1_000_000
            for workers in (1, 2):
                show(f"heavy, taylor 1e-10, {workers} processes", count, 101, measure(HEAVY, count, workers, folder))
        if "overhead" in wanted:
            few, many = (33_000, 100_000) if small else (33_000, 500_000)
            overhead("2 processes", lambda count: measure(HEAVY, count, 2, folder), few, many)
            overhead("Dask, 2 workers", lambda count: by_dask(count, folder), few, many)
            overhead("Dask, quiet", lambda count: by_dask(count, folder, **QUIET), few, many)


# Without the profiler of Dask's workers, and with a slower clock of its event loops.
QUIET = {"distributed.worker.profile.enabled": False, "distributed.admin.tick.interval": "1s",
         "distributed.admin.system-monitor.interval": "5s"}


def by_dask(count, folder, **options):
    """Measure a run on a cluster of this machine; the workers' CPU is known once they have ended."""
    import dask
    from distributed import LocalCluster

    start = cpu()
    with dask.config.set(options), LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        found = measure(HEAVY, count, cluster.scheduler_address, folder)
    return {**found, "cpu": cpu() - start}


def overhead(name, run, few, many):
    """What an engine costs for each chunk: what two runs of different size differ by, beside the chunks themselves."""
    small, large = run(few), run(many)
    chunks, work = large["chunks"] - small["chunks"], large["chunks_cpu"] - small["chunks_cpu"]
    beside = large["cpu"] - small["cpu"] - work
    print(f"overhead, {name:20s} {work:6.1f} s of CPU in {chunks} chunks; beside {1e3 * beside / chunks:6.1f} ms a "
          f"chunk of {work / chunks:.2f} s: {100 * beside / work:.1f} %; start and end "
          f"{small['cpu'] - small['chunks_cpu'] - beside / chunks * small['chunks']:.1f} s", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
