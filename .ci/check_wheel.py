"""Checks of `.ci/wheels`.

    check_wheel.py files WHEEL          metadata, files, names of symbols, needed libraries
    check_wheel.py bare                 by a Python that has the wheel `polhode` alone
    check_wheel.py link PREFIX FOLDER   builds README's C++ program against a prefix, and compares what it prints
"""

import contextlib
import email
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
NEEDED = {"libstdc++.so.6", "libm.so.6", "libgcc_s.so.1", "libc.so.6", "ld-linux-x86-64.so.2", "ld-linux-aarch64.so.1"}
FLIPS = [3.683441, 10.134064]   # README states them


def run(*command, cwd=None):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True, cwd=cwd).stdout


def check_module(folder):
    """The module alone: it brings no library for C++, needs few others, and lets only its door out."""
    assert not list(folder.rglob("*.a")) and not (folder / "polhode/include").exists()
    assert (folder / "polhode/scenes/S1.toml").exists() and (folder / "polhode/py.typed").exists()
    (module,) = folder.rglob("*.so*")
    needed = set(re.findall(r"NEEDED.*\[(.*?)\]", run("readelf", "-d", module)))
    assert needed <= NEEDED, needed - NEEDED
    rows = [line.split() for line in run("nm", "-D", "--defined-only", module).splitlines()]
    strong = {name for *_, kind, name in rows if kind in "TDBRA"}
    assert "PyInit__core" in strong and all(name.startswith("PyInit_") for name in strong), strong


def check_library(folder):
    """The C++ library: all that find_package reads, and no symbol that is not of the namespace polhode."""
    prefix = folder / "polhode_cpp"
    for name in ("__init__.py", "include/polhode/polhode.hpp", "lib/cmake/polhode/polhodeConfig.cmake"):
        assert (prefix / name).exists(), name
    assert not list(folder.rglob("*.so*"))
    rows = [line.split() for line in run("nm", "--defined-only", prefix / "lib/libpolhode.a").splitlines()]
    strong = {row[2] for row in rows if len(row) == 3 and row[1] in "TDBR"}
    assert strong and all("7polhode" in name or name.startswith("polhode_") for name in strong), strong


def check_files(wheel):
    version = re.search(r'POLHODE_VERSION "(.*)"', (ROOT / "cpp/include/polhode/core/version.hpp").read_text())[1]
    name, found, *_, platform = wheel.stem.split("-")
    assert found == version and "linux" in platform, wheel.name
    with tempfile.TemporaryDirectory() as temporary, zipfile.ZipFile(wheel) as archive:
        archive.extractall(temporary)
        folder = pathlib.Path(temporary)
        metadata = email.message_from_string((folder / f"{name}-{version}.dist-info/METADATA").read_text())
        assert metadata["Version"] == version and metadata["Name"].replace("-", "_") == name
        assert "BSD-3-Clause" in metadata["License-Expression"]
        licence = (folder / f"{name}-{version}.dist-info/licenses/LICENSE").read_text()
        assert licence == (ROOT / "LICENSE").read_text()
        {"polhode": check_module, "polhode_cpp": check_library}[name](folder)


def check_bare():
    import polhode as ph
    assert "scipy" not in sys.modules and ph.solve(ph.Scene.load("S1"), accuracy=1e-9).success
    (block,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.S)
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(compile(block, "README.md", "exec"), {})
    assert printed.getvalue().splitlines() == re.findall(r"^print\(.*\) +# (.*)$", block, flags=re.M)
    try:
        ph.cmake_prefix()
    except ph.InvalidInput as error:
        assert f"pip install polhode-cpp=={ph.__version__}" in str(error)
    else:
        raise AssertionError("a wheel without the C++ library names a prefix")


def check_link(prefix, folder):
    folder.mkdir(parents=True)
    (program,) = re.findall(r"```cpp\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.S)
    (folder / "readme.cpp").write_text(program)
    (folder / "CMakeLists.txt").write_text("""cmake_minimum_required(VERSION 3.24)
project(readme LANGUAGES CXX)
find_package(polhode REQUIRED)
add_executable(readme readme.cpp)
target_link_libraries(readme PRIVATE polhode::polhode)
""")
    eigen = [word for word in run(sys.executable, ROOT / ".ci/eigen_dir.py", "--cmake").split() if word]
    run("cmake", "-S", folder, "-B", folder / "build", f"-DCMAKE_PREFIX_PATH={prefix}", *eigen)
    assert f"polhode_DIR:PATH={prefix}/lib/cmake/polhode" in (folder / "build/CMakeCache.txt").read_text()
    run("cmake", "--build", folder / "build")
    times = [float(line) for line in run(folder / "build/readme").split()]
    assert len(times) == 2 and all(abs(t - flip) < 1e-4 for t, flip in zip(times, FLIPS, strict=True)), times


if __name__ == "__main__":
    os.chdir("/")   # never the package of the repository
    what, *words = sys.argv[1:]
    {"files": check_files, "bare": check_bare, "link": check_link}[what](*map(pathlib.Path, words))
