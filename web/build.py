"""Builds the WebAssembly modules by Zig's Clang and puts the playground together: `make web`.

    python web/build.py            # the modules, then build/web/site and build/web/playground.html, which is one file
    python web/build.py --page     # the page alone, from modules that are there
"""

import base64
import gzip
import pathlib
import re
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


def build_modules():
    wrappers = write_wrappers(OUT / "zig")
    eigen = subprocess.run([sys.executable, ROOT / ".ci/eigen_dir.py", "--cmake"], check=True, capture_output=True,
                           text=True).stdout.split() or ["-DEigen3_DIR=/usr/share/eigen3/cmake"]
    subprocess.run(["cmake", "-S", HERE, "-B", OUT / "cmake", "-G", "Ninja", f"-DPOLHODE_ZIG={wrappers}",
                    f"-DCMAKE_TOOLCHAIN_FILE={HERE / 'wasm.cmake'}", *eigen], check=True, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", OUT / "cmake"], check=True, stdout=subprocess.DEVNULL)


def inline(page):
    """The page as one file, which runs from a folder without a server."""
    scripts = [(page / name).read_text() for name in ("core.js", "draw.js", "app.js")]
    code = "\n".join(re.sub(r"^import .*\n|^export ", "", script, flags=re.MULTILINE) for script in scripts)
    packed = {name: base64.b64encode(gzip.compress((page / name).read_bytes(), 9, mtime=0)).decode() for name in MODULES}
    text = (page / "index.html").read_text()
    text = text.replace('<link rel="stylesheet" href="style.css">', f"<style>\n{(page / 'style.css').read_text()}</style>")
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
