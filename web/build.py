"""Builds the WebAssembly modules by Zig's Clang and puts the playground together: `make web`.

    python web/build.py            # the modules, then build/web/site and build/web/playground.html, which is one file
    python web/build.py --page     # the page alone, from modules that are there
"""

import base64
import gzip
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).parent
ROOT = HERE.parent
OUT = ROOT / "build/web"
MODULES = ("free.wasm", "solve.wasm")
MOST = {"free.wasm": 150 * 1024, "solve.wasm": 600 * 1024}   # bytes after gzip


def write_wrappers(folder):
    """CMake wants one program where Zig has subcommands."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, words in {"zig-cxx": "c++", "zig-ar": "ar", "zig-ranlib": "ranlib"}.items():
        file = folder / name
        file.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m ziglang {words} "$@"\n')
        file.chmod(0o755)
    return folder


def first_errors(output, most=5):
    """What a compiler, a linker or CMake said first, each complaint with the lines that belong to it."""
    lines = output.splitlines()
    starts = [i for i, line in enumerate(lines) if re.search(r"(^|\s)(fatal )?error:|CMake Error", line)]
    parts = ["\n".join(lines[i:i + 4]) for i in starts[:most]] or ["\n".join(lines[-20:])]
    if len(starts) > most:
        parts.append(f"and {len(starts) - most} more errors")
    return "\n\n".join(parts)


def run(command, what):
    """Ninja, and with it the compiler, complains on standard output."""
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode != 0:
        raise SystemExit(f"{what} failed (exit code {done.returncode}):\n\n{first_errors(done.stdout)}\n\n"
                         f"all of it: {shlex.join(map(str, command))}")


def build_modules():
    wrappers = write_wrappers(OUT / "zig")
    eigen = subprocess.run([sys.executable, ROOT / ".ci/eigen_dir.py", "--cmake"], check=True, capture_output=True,
                           text=True).stdout.split() or ["-DEigen3_DIR=/usr/share/eigen3/cmake"]
    run(["cmake", "-S", HERE, "-B", OUT / "cmake", "-G", "Ninja", f"-DPOLHODE_ZIG={wrappers}",
         f"-DCMAKE_TOOLCHAIN_FILE={HERE / 'wasm.cmake'}", *eigen], "the set-up of the web core")
    run(["cmake", "--build", OUT / "cmake", "--parallel", os.environ.get("JOBS", os.cpu_count() or 1)],
        "the build of the web core")


def inline(page):
    """The page as one file, which runs from a folder without a server."""
    scripts = [(page / name).read_text() for name in ("core.js", "draw.js", "app.js")]
    code = "\n".join(re.sub(r"^import .*\n|^export ", "", script, flags=re.MULTILINE) for script in scripts)
    packed = {name: base64.b64encode(gzip.compress((page / name).read_bytes(), 9, mtime=0)).decode()
              for name in MODULES}
    text = (page / "index.html").read_text()
    style = (page / "style.css").read_text()
    text = text.replace('<link rel="stylesheet" href="style.css">', f"<style>\n{style}</style>")
    return text.replace('<script type="module" src="app.js"></script>',
                        f"<script>globalThis.polhodeModules = {packed};</script>\n"
                        f'<script type="module">\n{code}</script>')


def assemble():
    page = OUT / "site"
    shutil.rmtree(page, ignore_errors=True)
    shutil.copytree(HERE / "page", page)
    for name in MODULES:
        shutil.copyfile(OUT / "cmake" / name, page / name)
        size = len(gzip.compress((page / name).read_bytes(), 9))
        print(f"{name}: {size} bytes after gzip, at most {MOST[name]}")
        if size > MOST[name]:
            raise SystemExit(f"{name} is too large")
    (OUT / "playground.html").write_text(inline(page))


if __name__ == "__main__":
    if "--page" not in sys.argv:
        build_modules()
    assemble()
