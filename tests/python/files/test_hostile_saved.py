"""Saved motions and stores that lie: one sentence within two seconds, and little memory."""

import io
import json
import os
import pathlib
import select
import shutil
import subprocess
import sys
import time
import zipfile

import ensembles
import numpy as np
import pytest

import polhode as ph
from polhode import _folders, _saved_files

zarr = pytest.importorskip("zarr")

MOTION = ph.solve(ph.Scene.load("S5"), accuracy=1e-6)
MANY = ph.solve_many(ph.Scene.load("S5"), omega=np.eye(3), rtol=1e-6)
MEMORY = 300_000_000   # bytes above what the process has: hostile files claim 2 to 7 GB
DEEP = "[" * 200_000

LOAD = """
import json, resource, sys, time
import polhode as ph
for path in sys.argv[2:]:
    ph.load(path)   # modules and caches
used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_AS, (used + int(sys.argv[1]),) * 2)
for line in sys.stdin:
    start, said = time.perf_counter(), "loaded"
    try:
        ph.load(line.rstrip("\\n"))
    except BaseException as error:
        said = f"{type(error).__name__}: {error}"
    print(json.dumps([said, time.perf_counter() - start]), flush=True)
"""


class Loader:
    """A process with little memory that loads what it is told."""

    def __init__(self, good):
        files = [good / name for name in ("a.zarr", "a.npz", "store.zarr", "sums.npz")]
        self.process = subprocess.Popen([sys.executable, "-c", LOAD, str(MEMORY), *map(str, files)], text=True,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)

    def refused(self, path, message=""):
        """Return the sentence with which a file is refused."""
        print(path, file=self.process.stdin, flush=True)
        ready, _, _ = select.select([self.process.stdout], [], [], 60)
        assert ready, f"{path}: hangs"
        said, seconds = json.loads(self.process.stdout.readline())
        assert said.startswith("InvalidInput: ") and "\n" not in said and len(said) < 600, said
        assert seconds < 2 and message in said, (said, seconds)
        return said


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    folder = tmp_path_factory.mktemp("good")
    MOTION.save(folder / "a.zarr")
    MOTION.save(folder / "a.npz")
    recipe = ensembles.write(folder, ensembles.DRIVEN, count=64)
    run = ph.ensemble(recipe, out=folder / "store.zarr", executor=0)
    run.save(folder / "sums.npz")
    return folder


@pytest.fixture
def folder(good, tmp_path):
    return pathlib.Path(shutil.copytree(good, tmp_path / "copy"))


@pytest.fixture(scope="module")
def loader(good):
    """One process for all files, since a new one imports for seconds."""
    made = Loader(good)
    yield made
    made.process.kill()
    made.process.communicate()


def rewrite(path, change):
    content = json.loads(path.read_text())
    change(content)
    path.write_text(json.dumps(content))


def spoil(path, content):
    """Put in the place of a file another content, or a pipe, an endless device, a folder, or a file of holes."""
    path.unlink()
    match content:
        case "pipe":
            os.mkfifo(path)
        case "zero":
            path.symlink_to("/dev/zero")
        case "folder":
            path.mkdir()
        case "holes":
            with open(path, "wb") as file:
                file.truncate(3_000_000_000)
        case _:
            path.write_bytes(content.encode() if isinstance(content, str) else content)


# ---- metadata that are none, of motions and of stores

@pytest.mark.parametrize("name", ["a.zarr", "store.zarr"])
@pytest.mark.parametrize("inner", ["zarr.json", "omega/zarr.json"])
@pytest.mark.parametrize("kind, message", [
    ("deep", "nested too deep"), ("pipe", "a device or a pipe"), ("zero", ""), ("folder", ""), ("holes", "at most"),
    ("text", "damaged"), ("digits", "damaged"), ("list", ""), ("null", "")])
def test_metadata_that_are_none(folder, loader, name, inner, kind, message):
    path = folder / name / inner
    spoil(path, {"deep": DEEP, "text": "{", "digits": '{"shape": [' + "9" * 5000 + "]}", "list": "[]",
                 "null": '{"attributes": null}'}.get(kind, kind))
    loader.refused(folder / name, message)
    if name == "store.zarr" and kind in ("deep", "pipe", "zero") and inner == "zarr.json":
        status, _, err = ensembles.run("status", folder / name)
        assert status == 2 and err.count("\n") == 1 and "Traceback" not in err, err


CLAIMS = {"3e8 samples": {"shape": [300_000_000, 3]}, "a negative size": {"shape": [-1, 3]},
          "1e30": {"shape": [10**30]},
          "text": {"shape": "201"}, "bytes": {"data_type": "S8"}, "objects": {"data_type": "object"},
          "a shape in another order": {"shape": [3, 201]}, "0-d": {"shape": [], "chunk_grid": {
              "name": "regular", "configuration": {"chunk_shape": []}}},
          "huge chunks": {"chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [10**10, 3]}}},
          "another codec": {"codecs": [{"name": "bytes"}, {"name": "gzip"}]}, "no codecs": {"codecs": None}}


@pytest.mark.parametrize("name", ["a.zarr", "store.zarr"])
@pytest.mark.parametrize("claim", CLAIMS)
def test_an_array_that_claims_what_it_is_not(folder, loader, name, claim):
    array = "omega" if name == "a.zarr" else "record"
    rewrite(folder / name / array / "zarr.json", lambda content: content.update(CLAIMS[claim]))
    if claim == "3e8 samples":
        shutil.rmtree(folder / name / array / "c", ignore_errors=True)   # no chunks: all would be filled
    said = loader.refused(folder / name)
    assert array in said


def frame(size, single=True):
    """A frame of Zstandard that claims a size."""
    return b"\x28\xb5\x2f\xfd" + bytes([0xC0 | single << 5]) + b"\0" * (not single) + size.to_bytes(8, "little")


def test_the_size_of_a_frame_is_read_as_the_format_says():
    from numcodecs.zstd import Zstd

    for size in (1, 100, 255, 256, 300, 65_791, 65_792, 100_000, 20_000_000):
        for level in (1, 3, 19):
            assert _folders.frame_size(Zstd(level=level).encode(b"\0" * size)[:18]) == size
    assert _folders.frame_size(frame(2**40)) == _folders.frame_size(frame(2**40, single=False)) == 2**40
    for head in (b"", b"\x28\xb5\x2f\xfd", b"\x28\xb5\x2f\xfd\x00\x00" + b"\0" * 9, b"x" * 18):
        assert _folders.frame_size(head) is None


@pytest.mark.parametrize("name, chunk", [("a.zarr", "omega/c/0/0"), ("store.zarr", "record/c.0.0")])
@pytest.mark.parametrize("content", [frame(5_000_000_000), b"", b"x" * 100, "pipe", "zero"], ids=range(5))
def test_a_chunk_that_inflates_or_is_none(folder, loader, name, chunk, content):
    path = folder / name / chunk
    spoil(path, content)
    if isinstance(content, bytes) and name == "store.zarr":   # a chunk is read when its sums are wanted
        with pytest.raises(ph.InvalidInput, match="the record of chunk 0 is damaged"):
            ph.load(folder / name).summary
    else:
        loader.refused(folder / name)


def test_a_layout_with_billions_of_chunks_is_counted_by_its_files(folder):
    def change(content):
        stored = content["attributes"]["polhode_ensemble"]
        stored["recipe"]["count"] = stored["layout"]["number"] = stored["stamp"]["count"] = 4_000_000_000
        stored["layout"]["chunk"] = stored["layout"]["slab"] = 1

    rewrite(folder / "store.zarr/zarr.json", change)
    start = time.perf_counter()
    with pytest.raises(ph.InvalidInput):
        ph.load(folder / "store.zarr").summary
    assert time.perf_counter() - start < 2


def test_an_array_beside_those_of_the_recipe_is_not_opened(folder):
    group = zarr.open_group(str(folder / "store.zarr"), mode="r+", use_consolidated=False)
    group.create_array("chunk", shape=(10**12,), chunks=(10**6,), dtype="f8", dimension_names=("chunk",))
    assert "chunk" not in ph.load(folder / "store.zarr").dataset.variables


def test_a_log_that_is_none_is_as_good_as_no_log(folder):
    from polhode._ensemble import status

    log = folder / "store.zarr.log"
    wrong = ['{"at": 1, "event": ["x"]}', '{"at": 1, "event": "done", "chunk": [], "seconds": 1}',
             '{"at": 1e400, "event": "done"}', '{"at": 1, "event": "done", "chunk": 1, "seconds": "x"}',
             '{"at": 1' + "0" * 500 + ', "event": "x"}',
             DEEP, "\udcff", '{"at": NaN, "event": "end"}', '{"at": 1, "event": "failed", "chunk": 1, "why": {}}']
    log.write_bytes("\n".join(wrong).encode(errors="surrogateescape"))
    content = []
    for kind in ("lines", "pipe", "zero", "folder"):
        if kind != "lines":
            log.rmdir() if log.is_dir() else log.unlink()
            {"pipe": lambda: os.mkfifo(log), "zero": lambda: log.symlink_to("/dev/zero"), "folder": log.mkdir}[kind]()
        content.append(status.status(ph.load(folder / "store.zarr")))
        assert content[-1]["seconds_left"] is None
    assert content[0] == content[1] == content[2] == content[3]


# ---- .npz

def entries(path):
    with zipfile.ZipFile(path) as table:
        return {name: table.read(name) for name in table.namelist()}


def write(path, parts):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as table:
        for name, data in parts.items():
            if callable(data):
                with table.open(name, "w", force_zip64=True) as part:
                    data(part)
            else:
                table.writestr(name, data)


def array(shape, dtype="<f8", values=b""):
    """The bytes of an array that claims a shape."""
    file = io.BytesIO()
    np.lib.format.write_array_header_1_0(file, {"shape": shape, "fortran_order": False, "descr": dtype})
    return file.getvalue() + values


def zeros(shape, dtype="<f8"):
    """The same with all its bytes, of zeros, written block by block."""
    def fill(part):
        part.write(array(shape, dtype))
        left = int(np.prod([float(size) for size in shape])) * np.dtype(dtype).itemsize
        while left > 0:
            part.write(bytes(min(left, 10_000_000)))
            left -= 10_000_000
    return fill


LIES = {
    "2.4 GB of zeros in 2.3 MB": {"omega.npy": zeros((100_000_000, 3))},
    "a description of 1 GB": {"about.npy": zeros((), "<U250000000")},
    "a shape without bytes": {"omega.npy": array((300_000_000, 3))},
    "a shape of 1e30": {"omega.npy": array((10**30, 3))},
    "two rows": {"omega.npy": array((2, 3), values=bytes(48))},
    "three times": {"t.npy": array((3,), values=bytes(24))},
    "more times than the scene has": {"t.npy": array((202,), values=bytes(1616))},
    "0-d": {"t.npy": array((), values=bytes(8))},
    "S8": {"omega.npy": array((201, 3), "|S8", bytes(4824))},
    "float32": {"omega.npy": array((201, 3), "<f4", bytes(2412))},
    "big-endian": {"omega.npy": array((201, 3), ">f8", bytes(4824))},
    "bounds of another shape": {"omega_lower.npy": array((201, 4), values=bytes(6432))},
    "a deep description": {"about.npy": array((), f"<U{len(DEEP)}", DEEP.encode("utf-32-le"))},
    "a description that is none": {"about.npy": array((2,), "<U1", b"{\0\0\0" * 2)},
    "a header of a megabyte": {
        "omega.npy": b"\x93NUMPY\x02\x00" + (1_000_000).to_bytes(4, "little") + b" " * 1_000_000},
    "no array": {"omega.npy": b"omega"},
}


@pytest.mark.parametrize("name", LIES)
def test_a_file_whose_arrays_are_not_those_of_its_scene(folder, loader, name):
    if "GB" in name and "zeros" not in name:   # one gigabyte takes seconds to make: a tenth shows it
        LIES[name] = {"about.npy": zeros((), "<U25000000")}
    write(folder / "a.npz", entries(folder / "a.npz") | LIES[name])
    loader.refused(folder / "a.npz", str(folder / "a.npz"))


def test_what_is_wanted_must_be_there(folder):
    for name in ("omega.npy", "attitude.npy", "t.npy", "about.npy"):
        parts = entries(folder / "a.npz")
        del parts[name]
        write(folder / "b.npz", parts)
        with pytest.raises(ph.InvalidInput, match="b.npz: (is damaged|must be a file that polhode saved)"):
            ph.load(folder / "b.npz")


def changed(path, **changes):
    """Change the description of a saved file."""
    with np.load(path) as table:
        arrays = dict(table)
    about = json.loads(str(arrays["about"]))
    np.savez(path, **{**arrays, "about": np.array(json.dumps(about | changes))})


@pytest.mark.parametrize("changes", [
    {"stats": {}}, {"stats": []}, {"stats": {"steps": "1", "seconds": 1}}, {"status": 3}, {"error": "x"},
    {"options": 1},
    {"events": [[0, 1.0, [1, 2], [0, 0, 0, 1]]]}, {"events": [[0, "x", [1, 2, 3], [0, 0, 0, 1]]]}, {"events": {}},
    {"asked": None}, {"message": None}, {"plan": {"wishes": {}}}], ids=str)
def test_parts_of_a_description_that_are_none(folder, changes):
    changed(folder / "a.npz", **changes)
    with pytest.raises(ph.InvalidInput, match="a.npz: "):
        ph.load(folder / "a.npz")


@pytest.mark.parametrize("name, data", [
    ("omega.npy", array((3, 200, 3), values=bytes(14400))), ("attitude.npy", array((2, 201, 4), values=bytes(12864))),
    ("error.npy", array((4,), values=bytes(32))), ("steps.npy", array((3,), "<f8", bytes(24))),
    ("success.npy", array((), "|b1", b"\1")), ("start_omega.npy", array((3, 4), values=bytes(96)))], ids=str)
def test_many_motions_whose_arrays_do_not_fit(folder, name, data):
    MANY.save(folder / "m.npz")
    ph.load(folder / "m.npz")
    write(folder / "m.npz", entries(folder / "m.npz") | {name: data})
    with pytest.raises(ph.InvalidInput, match=f"m.npz: is damaged: {name.removesuffix('.npy')} must be"):
        ph.load(folder / "m.npz")
    MANY.save(folder / "m.npz")
    changed(folder / "m.npz", message=["x"])
    with pytest.raises(ph.InvalidInput, match="m.npz: is damaged"):
        ph.load(folder / "m.npz")


@pytest.mark.parametrize("name, data", [
    ("records.npy", zeros((100_000_000, 3))), ("records.npy", array((2, 3), values=bytes(48))),
    ("chunks.npy", array((2,), values=bytes(16))), ("chunks.npy", array((3,), "<i8", bytes(24))),
    ("chunks.npy", array((2,), "<i8", bytes(16))), ("chunks.npy", array((2,), "<i8", bytes(8) + b"\xff" * 8))],
                         ids=range(6))
def test_sums_that_are_not_those_of_their_recipe(folder, loader, name, data):
    write(folder / "sums.npz", entries(folder / "sums.npz") | {name: data})
    loader.refused(folder / "sums.npz", "sums.npz: is damaged")


def test_a_file_that_cannot_be_loaded_again_is_not_saved(tmp_path, monkeypatch):
    monkeypatch.setattr(_folders, "ABOUT", 1000)
    for name in ("a.npz", "a.zarr"):
        with pytest.raises(ph.InvalidInput, match="must be described by at most 1000 characters"):
            MOTION.save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_honest_descriptions_inflate_less_than_is_allowed(tmp_path):
    """Of many bodies with the same scene, the kindest to compress, and of times in whole seconds."""
    scene = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 0, 0), times=np.arange(20_000.0), want=("omega",))
    short = ph.Scene(inertia=(1, 2, 2.5), omega=(1, 0, 0), times=[0.0, 1.0])
    ph.solve(scene, accuracy=1e-6).save(tmp_path / "a.npz")
    ph.solve_many([short] * 3000, rtol=1e-3).save(tmp_path / "b.npz")
    for name in ("a.npz", "b.npz"):
        with zipfile.ZipFile(tmp_path / name) as table:
            info = table.getinfo("about.npy")
        assert info.file_size < 0.7 * _saved_files.FACTOR * info.compress_size, info
        ph.load(tmp_path / name)
