"""What web/build.py says where the build fails: the compiler's own words, which ninja prints on standard output."""

import importlib.util
import pathlib
import sys

import pytest

HERE = pathlib.Path(__file__).parents[3] / "web/build.py"


@pytest.fixture(scope="module")
def build():
    spec = importlib.util.spec_from_file_location("web_build", HERE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


NINJA = """[1/9] Building CXX object a.cpp.obj
FAILED: a.cpp.obj
zig-cxx -O3 -Werror=none -c a.cpp
a.cpp:3:10: error: no member named 'thread' in namespace 'std'
    3 | std::thread t;
      | ~~~~~^
ninja: build stopped: subcommand failed.
"""


def test_a_failure_shows_the_first_errors_in_one_message(build, tmp_path):
    (tmp_path / "ninja.py").write_text(f"print({NINJA!r})\nraise SystemExit(1)\n")
    with pytest.raises(SystemExit) as told:
        build.run([sys.executable, tmp_path / "ninja.py"], "the build of the web core")
    text = str(told.value)
    assert text.startswith("the build of the web core failed (exit code 1):\n\na.cpp:3:10: error: no member named")
    assert "std::thread t;" in text and "Traceback" not in text and "FAILED" not in text


def test_many_errors_are_counted_and_silent_failures_show_their_end(build):
    text = build.first_errors("\n".join(f"a.cpp:{i}:1: error: number {i}" for i in range(9)))
    assert "number 0" in text and text.endswith("and 4 more errors")
    assert build.first_errors("\n".join(f"line {i}" for i in range(99))).startswith("line 79")
    assert "cannot be found" in build.first_errors("CMake Error at CMakeLists.txt:4:\n  Eigen3 cannot be found")


def test_words_that_only_look_like_errors_are_not_shown(build):
    assert build.first_errors("-Werror: x\nld: error: undefined symbol: main").startswith("ld: error")


def test_a_module_that_is_too_large_ends_the_build(build, tmp_path, monkeypatch):
    (tmp_path / "cmake").mkdir()
    for name in build.MODULES:
        (tmp_path / "cmake" / name).write_bytes(b"\0asm")
    monkeypatch.setattr(build, "OUT", tmp_path)
    build.assemble()
    assert (tmp_path / "playground.html").exists()
    monkeypatch.setattr(build, "MOST", {"free.wasm": 1000, "solve.wasm": 10})
    with pytest.raises(SystemExit, match="solve.wasm is too large"):
        build.assemble()
