"""The examples run, and the C++ program prints what its Python twin prints, against both ways of installing polhode."""

import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
from fractions import Fraction

import numpy as np
import pytest

import polhode as ph

ROOT = pathlib.Path(__file__).parents[3]
DEV_BUILD = ROOT / "build/dev"
EXAMPLES = sorted((ROOT / "examples/python").glob("*.py"))


def run(*command):
    """Standard output; whatever goes to standard error is a failure."""
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stdout + done.stderr
    assert not done.stderr, done.stderr
    return done.stdout


def run_example(path):
    return run(sys.executable, "-W", "error", path)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_python_example_runs(path):
    assert run_example(path).count("\n") > 5


def test_the_homework_block_has_its_moments():
    text = run_example(ROOT / "examples/python/block.py")
    a, b, c = Fraction(3, 10), Fraction(2, 10), Fraction(1, 10)
    space = 8 * (a**2 * b**2 + b**2 * c**2 + a**2 * c**2) / (a**2 + b**2 + c**2)          # 2M/3 = 8
    face = 8 * (a**2 * b**2 + 2 * b**2 * c**2 + 2 * a**2 * c**2) / (a**2 + b**2)
    assert re.search(r"diagonal of the block: +(\S+)", text)[1] == f"{float(space):.6f}"
    assert re.search(r"diagonal of the face z = c: +(\S+)", text)[1] == f"{float(face):.6f}"
    assert "refused: inertia: must be within the triangle inequality" in text


def test_the_top_follows_its_closed_form():
    text = run_example(ROOT / "examples/python/top.py")
    assert float(re.search(r"closed form: (\S+) rad", text)[1]) < 1e-8


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """Prefix of `cmake --install`, with the ordinary layout of CMake packages."""
    if not (DEV_BUILD / "CMakeCache.txt").exists():
        pytest.skip("no build tree to install from")
    prefix = tmp_path_factory.mktemp("prefix")
    run("cmake", "--install", DEV_BUILD, "--prefix", prefix)
    return prefix


@pytest.mark.parametrize("source", ["cmake --install", "pip install"])
def test_cpp_example_links_and_prints_what_its_twin_prints(source, request, tmp_path):
    project = shutil.copytree(ROOT / "examples/cpp", tmp_path / "project")
    (readme,) = re.findall(r"```cpp\n(.*?)```", (ROOT / "README.md").read_text(), flags=re.S)
    (project / "readme.cpp").write_text(readme)
    with (project / "CMakeLists.txt").open("a") as file:
        file.write("add_executable(readme readme.cpp)\ntarget_link_libraries(readme PRIVATE polhode::polhode)\n")
    prefix = request.getfixturevalue("installed") if source == "cmake --install" else ph.cmake_prefix()
    cmeel = pathlib.Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix"   # Eigen, where Debian's is not installed
    configured = run("cmake", "-S", project, "-B", tmp_path, f"-DCMAKE_PREFIX_PATH={prefix};{cmeel}",
                     "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wconversion -Werror", "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")
    assert "Configuring done" in configured
    assert f"polhode_DIR:PATH={prefix}/lib" in (tmp_path / "CMakeCache.txt").read_text()
    run("cmake", "--build", tmp_path, *(["--target", "racket"] if source == "pip install" else []))   # one is enough
    assert run(tmp_path / "racket") == run_example(ROOT / "examples/python/racket.py")
    if source == "cmake --install":
        heavy, law, own, many = run(tmp_path / "scenes").splitlines()
        w = [float(x) for x in re.search(r"omega (\S+) (\S+) (\S+) at 10 s", heavy).groups()]
        same = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 3), times=10.0 ** np.arange(2),
                                 torques=[ph.torques.Gravity(2.0, (0.3, 0.2, 0.5))]), accuracy=1e-9)
        assert np.abs(np.array(w) - same.omega[-1]).max() < 1e-7 and float(heavy.split()[-1]) <= 1e-9
        text = "cross(axis, to_body(axis)) * stiffness - damping * omega"
        spring = ph.torques.Formula(text=text, axis=(0, 0, 1), stiffness=0.6, damping=0.5)
        twin = ph.solve(ph.Scene(inertia=(1, 2, 2.5), omega=(0.3, 0.2, 1), times=[5.0], torques=[spring]), 1e-9,
                        sensitivity="formula.damping")
        for number, pattern in ((twin.omega[0, 0], "omega_x"), (twin.sensitivity.d_omega[0, 0, 0], "damping")):
            assert float(re.search(pattern + r" (\S+?),? ", law).group(1)) == pytest.approx(number, abs=2e-8)
        found, by_hand = re.search(r"omega_z (\S+) rad/s, by hand (\S+)", own).groups()
        assert float(found) == pytest.approx(float(by_hand), rel=1e-8) and float(by_hand) == pytest.approx(3 / np.e)
        assert many == "many bodies: less than 1e-4 rad from the closed form"
        assert [float(line) for line in run(tmp_path / "readme").split()] == [3.68344, 10.1341]


def test_a_project_that_fetches_polhode_keeps_its_build_type(tmp_path):
    """The project of the page, and one without a build type: a subproject does not write into its parent's cache."""
    page = (ROOT / "docs/tutorials/cpp.md").read_text()
    (text,) = re.findall(r"```cmake\n(.*?)```", page, flags=re.S)
    shutil.copy(ROOT / "examples/cpp/racket.cpp", tmp_path)
    cmeel = pathlib.Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix"
    bare = re.sub(r"if\(NOT CMAKE_BUILD_TYPE\).*?endif\(\)\n", "", text, flags=re.S)
    for name, lines in (("page", text), ("bare", bare)):
        (tmp_path / "CMakeLists.txt").write_text(lines)
        configured = run("cmake", "-S", tmp_path, "-B", tmp_path / name, f"-DFETCHCONTENT_SOURCE_DIR_POLHODE={ROOT}",
                         f"-DCMAKE_PREFIX_PATH={cmeel}", "-DCMAKE_FIND_USE_PACKAGE_REGISTRY=OFF")
        assert "Generating done" in configured
        cache = (tmp_path / name / "CMakeCache.txt").read_text()
        assert re.search(r"^CMAKE_BUILD_TYPE:\w+=$", cache, flags=re.M), name
