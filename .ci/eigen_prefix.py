"""Prints the option that leads CMake to cmeel-eigen, where Debian's Eigen is not installed."""
import pathlib
import sys
import sysconfig

prefix = pathlib.Path(sysconfig.get_paths()["purelib"]) / "cmeel.prefix"
if not pathlib.Path("/usr/share/eigen3/cmake").is_dir() and prefix.is_dir():
    print(f"-DCMAKE_PREFIX_PATH={prefix}" if "--cmake" in sys.argv else f"-Ccmake.define.CMAKE_PREFIX_PATH={prefix}")
