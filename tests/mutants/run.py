"""Changes one place of the sources at a time and asks whether the tests of its word see it: `make mutants`.

A sample is drawn by a seed: 200 places in Python, 100 in C++. The sources are copied to build/mutants, where the
changes are made. Each place is tried once; the state stands in build/mutants/state.json, and the next run goes on
there. C++ is changed in the files of cpp/src that are compiled once: headers and what is built for each instruction
set are left out.
"""

import argparse
import collections
import hashlib
import importlib.util
import json
import os
import pathlib
import resource
import shutil
import signal
import subprocess
import sys
import time

import cpp_changes
import python_changes
import words

ROOT = pathlib.Path(__file__).parents[2]
BUILD = ROOT / "build/mutants"
TREE = BUILD / "tree"
STATE = BUILD / "state.json"
LIMIT = 180   # [s] of a processor for a mutant; a test that hangs has seen it
WAIT = 20 * LIMIT   # [s], on a machine that has others to serve
SEED = 13
# The tests of a changed package: not the one that is installed.
SITE = '''import sys
sys.meta_path[:] = [finder for finder in sys.meta_path if "ScikitBuild" not in type(finder).__name__]
'''


def is_testable(file):
    """Whether what it talks to is here: the other programs of the charts are often not installed."""
    packages = {"heyoka": "heyoka", "mujoco": "mujoco", "numbalsoda": "numbalsoda", "orekit": "jpype",
                "sundials": "sksundae"}
    return file.parent.name != "peers" or file.stem not in packages or bool(
        importlib.util.find_spec(packages[file.stem]))


def sources(language):
    if language == "Python":
        return sorted(file for file in (ROOT / "python/polhode").rglob("*.py") if is_testable(file))
    return sorted(file for file in (ROOT / "cpp/src").rglob("*.cpp")
                  if "lanes" not in file.parts and file.name != "build_info.cpp")


def draw(language):
    """All places, in an order drawn by the seed: that of a hash, so that an edit elsewhere changes no sample."""
    find = python_changes.find if language == "Python" else cpp_changes.find
    sites = []
    for file in sources(language):
        name, alike = str(file.relative_to(ROOT)), collections.Counter()
        for number, (line, was, now, _) in enumerate(find(file.read_text())):
            alike[was, now] += 1
            sites.append({"key": f"{name}: {was} -> {now} #{alike[was, now]}", "language": language, "file": name,
                          "line": line, "was": was, "now": now, "number": number})
    return sorted(sites, key=lambda site: hashlib.sha256(f"{SEED} {site['key']}".encode()).digest())


def text_of(site):
    find = python_changes.find if site["language"] == "Python" else cpp_changes.find
    return list(find((ROOT / site["file"]).read_text()))[site["number"]][3]


def prepare():
    """The copy of the tree, with the compiled module that is installed."""
    files = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, files):
        there, here = TREE / name, ROOT / name
        if here.is_file() and not (there.is_file() and there.read_bytes() == here.read_bytes()):
            there.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(here, there)
    (TREE / "site").mkdir(exist_ok=True)
    (TREE / "site/sitecustomize.py").write_text(SITE)
    core = pathlib.Path(importlib.util.find_spec("polhode._core").origin)
    shutil.copyfile(core, TREE / "python/polhode" / core.name)
    for part, there in (("scenes", TREE), ("lib", core.parent), ("include", core.parent)):
        link = TREE / "python/polhode" / part
        if not link.exists():
            link.symlink_to(there / part)


def build(target):
    """Whether a target can be built in the copy."""
    folder = BUILD / "cmake"
    if not (folder / "build.ninja").exists():
        pybind11 = subprocess.run([sys.executable, "-m", "pybind11", "--cmakedir"], check=True, capture_output=True,
                                  text=True).stdout.strip()
        eigen = subprocess.run([sys.executable, ROOT / ".ci/eigen_dir.py", "--cmake"], check=True,
                               capture_output=True, text=True).stdout.split()
        subprocess.run(["cmake", "-S", TREE, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
                        "-DCMAKE_CXX_FLAGS=-O1 -fno-math-errno -fno-trapping-math", "-DPOLHODE_BUILD_TESTS=ON",
                        "-DPOLHODE_BUILD_PYTHON=ON", "-DPOLHODE_UNITY=OFF", f"-Dpybind11_DIR={pybind11}",
                        f"-DPython_EXECUTABLE={sys.executable}", *eigen], check=True, stdout=subprocess.DEVNULL)
    return subprocess.run(["cmake", "--build", folder, "-j2", "--target", target], stdout=subprocess.DEVNULL,
                          stderr=subprocess.DEVNULL).returncode == 0


def put_module():
    for module in (BUILD / "cmake/python").glob("_core*.so"):
        shutil.copyfile(module, TREE / "python/polhode" / module.name)


def run_tests(command):
    """"" if all tests pass, else what saw the change."""
    env = os.environ | {"PYTHONPATH": f"{TREE / 'site'}:{TREE / 'python'}", "PYTHONDONTWRITEBYTECODE": "1",
                        "HYPOTHESIS_STORAGE_DIRECTORY": str(BUILD / "hypothesis")}
    process = subprocess.Popen(command, cwd=TREE, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                               start_new_session=True,
                               preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT + 5)))
    try:
        output, _ = process.communicate(timeout=WAIT)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return "no end"
    if process.returncode == 0:
        return ""
    lines = [line for line in output.split("\n") if line.startswith(("FAILED", "ERROR", "TEST CASE"))]
    return (lines or ["ended by a signal" if process.returncode < 0 else output.strip()[-200:]])[0][:160]


def place(tests):
    """A folder of tests, or a file in one that words.py names without `test_`."""
    folder, _, name = tests.partition("/")
    return f"tests/python/{folder}/test_{name}.py" if name else f"tests/python/{folder}"


def python_command(tests):
    return [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider", "--no-header", "--tb=no",
            *map(place, tests)]


def cpp_command(word):
    return [BUILD / "cmake/tests/cpp/polhode_tests", "-nc", f"-sf=*tests/cpp/{word}/*"]


def judge(site):
    """(verdict, by what): killed, survived, or "does not compile"."""
    file = TREE / site["file"]
    original = file.read_text()
    file.write_text(text_of(site))
    try:
        if site["language"] == "Python":
            seen = run_tests(python_command(words.python_tests(site["file"].removeprefix("python/polhode/"))))
            return ("killed" if seen else "survived"), seen
        if not build("polhode_tests"):
            return "does not compile", ""
        word = words.word_of("C++", site["file"])
        if seen := run_tests(cpp_command(word)):
            return "killed", seen
        if not build("_core"):
            return "does not compile", ""
        put_module()
        seen = run_tests(python_command(words.CPP[word]))
        return ("killed" if seen else "survived"), seen
    finally:
        file.write_text(original)


def print_results(state):
    for language in ("Python", "C++"):
        table = collections.defaultdict(collections.Counter)
        for site in state.values():
            if site["language"] == language:
                table[words.word_of(language, site["file"])][site["verdict"]] += 1
        killed = sum(row["killed"] for row in table.values())
        all_of_them = killed + sum(row["survived"] for row in table.values())
        if not all_of_them:
            continue
        print(f"\n{language}: {killed} of {all_of_them} killed, {100 * killed / all_of_them:.0f} %")
        for word, row in sorted(table.items()):
            print(f"  {word:12s} {row['killed']:3d} killed {row['survived']:3d} survived")
    for site in state.values():
        if site["verdict"] == "survived":
            print(f"survived: {site['file']}:{site['line']}  {site['was']}  ->  {site['now']}")


def build_unchanged():
    """Why no place of C++ can be judged: in this build the sources as they are fail their own C++ tests."""
    if not build("polhode_tests"):
        return "the sources as they are do not compile"
    for word in words.CPP:
        if seen := run_tests(cpp_command(word)):
            return f"without a change, the C++ tests of {word} fail: {seen}"
    if not build("_core"):
        return "the module of the sources as they are does not compile"
    put_module()
    return ""


def check_unchanged(state):
    """A word without survivors proves nothing unless its Python tests pass on the sources as they are."""
    survived = {(site["language"], words.word_of(site["language"], site["file"])) for site in state.values()
                if site["verdict"] == "survived"}
    asked = {"Python": {}, "C++": {}}   # the tests, and a word that they belong to
    for site in state.values():
        word = words.word_of(site["language"], site["file"])
        tests = words.CPP[word] if site["language"] == "C++" else words.python_tests(
            site["file"].removeprefix("python/polhode/"))
        if (site["language"], word) not in survived:
            asked[site["language"]].setdefault(tuple(tests), word)
    failing = []
    for language, all_tests in asked.items():
        if not all_tests:
            continue
        prepare()   # the installed module, by which Python was judged
        if language == "C++" and (why := build_unchanged()):
            failing.append(why)
            continue
        for tests, word in all_tests.items():
            if seen := run_tests(python_command(tests)):
                failing.append(f"without a change, the tests of {word} fail: {seen}")
    return "\n".join(failing) or None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--python", type=int, default=200, help="how many places of Python")
    parser.add_argument("--cpp", type=int, default=100, help="how many places of C++")
    parser.add_argument("--minutes", type=float, default=1e9, help="stop after this time; the next run goes on")
    parser.add_argument("--again", action="store_true", help="try those once more that survived")
    parser.add_argument("--show", action="store_true", help="print the results of the runs so far")
    options = parser.parse_args()
    BUILD.mkdir(parents=True, exist_ok=True)
    state = json.loads(STATE.read_text()) if STATE.exists() else {}
    there = {str(file.relative_to(ROOT)) for language in ("Python", "C++") for file in sources(language)}
    state = {key: site for key, site in state.items() if site["file"] in there}
    if options.show:
        return print_results(state)
    end = time.monotonic() + 60 * options.minutes
    prepare()
    if options.again:
        state = {key: site for key, site in state.items() if site["verdict"] != "survived"}
    for language, count in (("Python", options.python), ("C++", options.cpp)):
        if language == "C++" and count and (why := build_unchanged()):
            return why
        for site in draw(language):
            done = sum(s["language"] == language and s["verdict"] != "does not compile" for s in state.values())
            if done >= count or time.monotonic() > end:
                break
            if site["key"] in state:
                continue
            start = time.monotonic()
            site["verdict"], site["by"] = judge(site)
            print(f"{site['verdict']:9s} {time.monotonic() - start:5.0f} s  {site['key']}  {site['by']}", flush=True)
            state[site["key"]] = site
            STATE.write_text(json.dumps(state, indent=1))
    print_results(state)
    return check_unchanged(state)


if __name__ == "__main__":
    sys.exit(main())
