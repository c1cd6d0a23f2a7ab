"""Counts the instructions of twenty jobs under callgrind, which no other work on the machine can disturb.

    python tests/counts/counts.py            compare with tests/counts/counts.json: 3 % more is a failure
    python tests/counts/counts.py --write    store the counts of this build

Callgrind knows AVX2 and no AVX-512, so the jobs run on AVX2. Counts hold for one version of the compiler and of the C
library; with another one there is nothing to compare.
"""

import argparse
import json
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import tempfile

import polhode as ph

ROOT = pathlib.Path(__file__).parents[2]
STORE = pathlib.Path(__file__).with_name("counts.json")
BOUND = 0.03


def setting():
    """What the counts belong to."""
    info = ph.build_info()
    return {"compiler": info["compiler"], "flags": info["flags"], "libc": " ".join(platform.libc_ver()),
            "machine": platform.machine()}


def refusal():
    """Why the counts cannot be compared here, or None."""
    if not shutil.which("valgrind"):
        return "needs valgrind"
    if not STORE.exists():
        return f"{STORE.name} is missing"
    stored = json.loads(STORE.read_text())["setting"]
    other = {key: value for key, value in setting().items() if stored.get(key) != value}
    before = {key: stored.get(key) for key in other}
    return f"needs {before}, to which the counts belong: here is {other}" if other else None


def count():
    """Instructions of each job by its name."""
    build = ROOT / "build/dev"
    subprocess.run(["cmake", "--build", build, "--target", "polhode_jobs"], check=True, stdout=subprocess.DEVNULL)
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run(["valgrind", "-q", "--tool=callgrind", f"--callgrind-out-file={folder}/out",
                        build / "tests/counts/polhode_jobs"], check=True, stdout=subprocess.DEVNULL,
                       env={"POLHODE_SIMD": "avx2", "PATH": "/usr/bin:/bin"})
        counts = {}
        for path in pathlib.Path(folder).glob("out.*"):
            text = path.read_text()
            name = re.search(r"^desc: Trigger: Client Request: (.*)$", text, re.M)
            total = re.search(r"^(?:totals|summary): (\d+)", text, re.M)
            if name and total:
                counts[name[1]] = int(total[1])
    return counts


def changes(stored, found):
    """A line for each job whose count left its bounds, or that is on one side only."""
    lines = [f"{name}: only {'stored' if name in stored else 'found'}" for name in sorted(stored.keys() ^ found.keys())]
    for name in stored.keys() & found.keys():
        ratio = found[name] / stored[name]
        if not 1 - BOUND <= ratio <= 1 + BOUND:
            lines.append(f"{name}: {stored[name]} instructions became {found[name]}, {100 * (ratio - 1):+.1f} %")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    if parser.parse_args().write:
        STORE.write_text(json.dumps({"setting": setting(), "counts": dict(sorted(count().items()))}, indent=1) + "\n")
        return None
    if why := refusal():
        return print(why)
    lines = changes(json.loads(STORE.read_text())["counts"], count())
    print("\n".join(lines) or "every count is within its bounds")
    return len(lines)


if __name__ == "__main__":
    sys.exit(main())
