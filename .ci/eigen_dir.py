"""Prints the option that leads CMake to cmeel-eigen, where Debian's Eigen is not installed."""
import pathlib
import sys
import sysconfig

folder = pathlib.Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix/share/eigen3/cmake"
if not pathlib.Path("/usr/share/eigen3/cmake").is_dir() and folder.is_dir():
    # Not by CMAKE_PREFIX_PATH: that would take the place of the one by which pybind11 is found.
    print(("-D" if "--cmake" in sys.argv else "-Ccmake.define.") + f"Eigen3_DIR={folder}")
