"""`polhode ensemble`: what it prints, its exit status, and its report."""

import json
import resource
import subprocess
import sys

import ensembles
import pytest
import typer.testing

import polhode as ph
from polhode.cli.app import app

zarr = pytest.importorskip("zarr")
SMALL = {"count": 6000, "samples": 3}


def call(*arguments):
    return typer.testing.CliRunner().invoke(app, ["ensemble", *map(str, arguments)])


@pytest.fixture(scope="module")
def store(tmp_path_factory):
    folder = tmp_path_factory.mktemp("store")
    ph.ensemble(ensembles.write(folder, ensembles.FREE, **SMALL), out=folder / "out.zarr", executor=0)
    return folder / "out.zarr"


def test_a_run_prints_its_status_and_makes_a_store(tmp_path, store):
    path = ensembles.write(tmp_path, ensembles.FREE, **SMALL)
    done = call(path, "-o", tmp_path / "out.zarr", "--workers", 1, "--json")
    content = json.loads(done.stdout)
    assert done.exit_code == 0 and content["complete"] and content["bodies_done"] == 6000
    assert ensembles.content(tmp_path / "out.zarr") == ensembles.content(store)
    low, high = content["summary"]["angle"]["quantiles"]["0.99"]
    exact = ph.load(store).summary["angle"].quantile(0.99)
    assert (low, high) == (exact.lower[-1], exact.upper[-1])


def test_status_tells_what_is_done(store):
    done = call("status", store)
    assert done.exit_code == 0 and done.stdout.startswith("free: 6,000 of 6,000 bodies (100 %)\n")
    assert "omega  at the last time: rms " in done.stdout and "rad s-1" in done.stdout


def test_report_is_one_page_with_pictures(store, tmp_path):
    pytest.importorskip("matplotlib")
    done = call("report", store, "-o", tmp_path / "page.html")
    page = (tmp_path / "page.html").read_text()
    assert done.exit_code == 0 and done.stdout.strip() == str(tmp_path / "page.html")
    assert page.count("<svg") == 2 and "6000 of 6000" in page and "moments_relative" in page
    assert "src=" not in page and "time [s]" in page


def test_words_win_over_files_of_their_names(store, tmp_path, monkeypatch):
    for name in ("status", "report"):
        ensembles.write(tmp_path, ensembles.FREE, name=name)
    monkeypatch.chdir(tmp_path)
    assert call("status", store).exit_code == 0
    assert "must be followed by one store, got 0" in call("status", "-o", "x.zarr").output
    assert call("./status", "--dry-run").exit_code == 0


def test_a_dry_run_computes_almost_nothing_and_writes_nothing(tmp_path):
    path = ensembles.write(tmp_path, ensembles.DRIVEN)
    done = call(path, "--dry-run", "--json", "--count", 100_000, "-o", tmp_path / "out.zarr")
    content = json.loads(done.stdout)
    assert done.exit_code == 0 and content["bodies"] == 100_000 and content["states"] == 1_100_000
    assert content["chunks"] == 3125 and content["fits"] and 0 < content["hours"] < 1
    assert content["bytes"] > 100_000 * 11 * 56 and not (tmp_path / "out.zarr").exists()


FORECASTS = """
import sys
from polhode._ensemble import forecast
from polhode._ensemble.run import prepare
task = prepare(sys.argv[1], out=sys.argv[1] + ".zarr", count=100_000)
print(*(forecast.make(task).seconds for _ in range(10)))
"""


def limit_time():
    """Limit the time of this process, at most as it is limited already: nobody may raise that."""
    most = resource.getrlimit(resource.RLIMIT_CPU)[1]
    resource.setrlimit(resource.RLIMIT_CPU, (1000, 1000) if most == resource.RLIM_INFINITY else (most, most))


def test_hours_are_forecast_where_the_time_of_a_process_is_limited(tmp_path):
    """Under RLIMIT_CPU, Linux counts the time of a process in whole ticks of up to 10 ms: 32 bodies take about 1 ms."""
    path = ensembles.write(tmp_path, ensembles.DRIVEN)
    found = subprocess.run([sys.executable, "-c", FORECASTS, path], capture_output=True, text=True, timeout=120,
                           preexec_fn=limit_time)
    seconds = [float(word) for word in found.stdout.split()]
    assert found.returncode == 0 and len(seconds) == 10 and min(seconds) > 0, (seconds, found.stderr)


REFUSED = [(["nothing.toml", "-o", "x"], "recipe: must be a file, or one of S8"), (["{path}"], "--output: missing"),
           (["{path}", "-o", "x", "--workers", "0"], "--workers: must be 1 or more"),
           (["{path}", "-o", "x", "--workers", "2", "--scheduler", "tcp://x:1"], "got both"),
           (["{path}", "{path}", "-o", "x"], "recipe: must be one file, got 2"),
           (["{path}", "-o", "x", "--verify"], "--verify: must be used with status"),
           (["status", "{path}"], "must be a store of an ensemble, got a file"),
           (["status", "x", "--resume"], "--resume: must be used with a recipe"),
           (["status", "nothing.zarr"], "must be a store of an ensemble, got none that has begun"),
           (["report", "{store}", "-o", "page.txt"], "output: must end in .html"),
           (["{path}", "-o", "x", "--count", "0"], "count: must be a whole number of 1 or more, got 0")]


@pytest.mark.parametrize("arguments, message", REFUSED, ids=[message[:40] for _, message in REFUSED])
def test_wrong_calls_are_refused_in_one_line(arguments, message, store, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = ensembles.write(tmp_path, ensembles.FREE)
    done = call(*(argument.format(path=path, store=store) for argument in arguments))
    assert done.exit_code == 2 and message in done.output and done.output.count("\n") == 1, done.output
    assert not (tmp_path / "x").exists()
