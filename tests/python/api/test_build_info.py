"""`build_info` tells what runs."""

import os
import pathlib
import subprocess
import sys

import pytest

CPUINFO = pathlib.Path("/proc/cpuinfo")
LEVELS = ("baseline", "avx2", "avx512")


def level_of_processor():
    """The level of SIMD that Linux' flags allow; the kernel hides those whose registers it does not save."""
    lines = [line for line in CPUINFO.read_text().splitlines() if line.startswith("flags")] if CPUINFO.exists() else []
    if not lines:
        pytest.skip("no /proc/cpuinfo with flags")
    flags = set(lines[0].split())
    if not {"avx2", "fma"} <= flags:
        return 0
    return 2 if {"avx512f", "avx512dq", "avx512vl"} <= flags else 1


@pytest.mark.parametrize("cap", ["", *LEVELS])
def test_simd_is_what_the_flags_of_the_processor_say(cap):
    print_level = "import polhode; print(polhode.build_info()['simd'])"
    found = subprocess.run([sys.executable, "-c", print_level], env={**os.environ, "POLHODE_SIMD": cap}, check=True,
                           capture_output=True, text=True).stdout.strip()
    most = level_of_processor()
    assert found == LEVELS[min(most, LEVELS.index(cap)) if cap else most]
