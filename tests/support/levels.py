"""What a program prints at each instruction set."""

import os
import subprocess
import sys

import pytest

import polhode as ph

LEVELS = ("baseline", "avx2", "avx512")
WIDE = ("avx2", "avx512")   # which promise the same bits


def there():
    """The levels that the processor has."""
    return LEVELS[:LEVELS.index(ph.build_info()["simd"]) + 1]


def output(level, program):
    """The bytes that a program writes in a process capped at a level. It imports what this one can import."""
    environment = {**os.environ, "POLHODE_SIMD": level, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    return subprocess.run([sys.executable, "-W", "ignore", "-c", program], env=environment,
                          check=True, capture_output=True).stdout


def outputs(program, levels=WIDE):
    """What the program writes at each level; the test is skipped where the processor lacks one."""
    if not set(levels) <= set(there()):
        pytest.skip(f"needs {', '.join(levels)}")
    return {level: output(level, f"import polhode\nassert polhode.build_info()['simd'] == {level!r}\n{program}")
            for level in levels}
