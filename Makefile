# make demo    set everything up, then chart speed against accuracy on the scenes
# make test    set everything up, then run every test, C++ and Python
# The rest is for those who work on polhode: see CONTRIBUTING.md.
SHELL := /bin/bash
.SHELLFLAGS := -euo pipefail -c
.DEFAULT_GOAL := help

VENV   := .venv
BUILD  := build/dev
PYTHON := $(CURDIR)/$(VENV)/bin/python
JOBS   ?= $(shell nproc)

# An editable install reads Python files where they stand: only their names matter, what is compiled or copied matters whole.
$(shell mkdir -p build; find python/polhode -type f -not -name '*.py[ci]' | sort > build/.names.new; \
        cmp -s build/.names.new build/.names || cp build/.names.new build/.names)
inputs := build/.names $(shell find CMakeLists.txt pyproject.toml cpp python/CMakeLists.txt python/bindings \
            tests/cpp/CMakeLists.txt scenes -type f 2>/dev/null)

.PHONY: help demo test same-bits check-long install module clang sanitize valgrind fuzz mutants \
        aarch64 debian13 free-threaded wheels stubs docs docs-pictures browser web web-check web-pictures clean
.NOTPARALLEL:
# An environment whose Python has gone is made anew.
ifneq ($(shell $(VENV)/bin/python -c 'import pip; print("there")' 2>/dev/null),there)
.PHONY: $(VENV)/.demo
endif
help:
	@sed -n '1,3s/^# //p' Makefile

# What the demo runs with, and all that the tests need.
$(VENV)/.demo: pyproject.toml .ci/prepare
	@.ci/prepare $(VENV) cli plot scipy
	@touch $@
$(VENV)/.ready: $(VENV)/.demo
	@.ci/prepare $(VENV) cli plot mesh ensemble test docs
	@touch $@

# One editable build serves the Python module and the C++ tests; ninja rebuilds only what changed.
build/.installed: $(VENV)/.demo $(inputs)
	@echo "building polhode (the first time takes a few minutes)"
	@# The build imports an installed polhode (its CMake entry point), which fails when its Python is ahead of its core.
	@$(PYTHON) -m pip uninstall -qq -y --disable-pip-version-check polhode
	@CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) $(PYTHON) -m pip install -qq --disable-pip-version-check \
	  --no-build-isolation --no-deps -Cbuild-dir=$(BUILD) -Ccmake.define.POLHODE_BUILD_TESTS=ON \
	  -Ccmake.define.POLHODE_WERROR=ON \
	  $$($(VENV)/bin/python .ci/eigen_dir.py) -e .
	@touch $@

install: $(VENV)/.ready build/.installed

# Half the usual time for the charts: fewer repeats, which they say. `polhode chart` alone takes two minutes.
demo: build/.installed
	@echo "charting scenes/S*.toml for a minute"
	@$(PYTHON) -m polhode chart scenes/S*.toml --budget 60s --brief -o demo

test: install
	@cmake --build $(BUILD) -j $(JOBS) --target polhode_tests polhode_headers_alone | sed -n '/warning:\|error:/p'
	@$(BUILD)/tests/cpp/polhode_tests
	@$(PYTHON) -m pytest

# Hashes of some hundred answers at every level of SIMD: the same on every machine. `--write` remakes them.
same-bits: install
	@$(PYTHON) tests/support/same_bits.py

check-long: install
	@$(PYTHON) -m pytest -m "long or not long"

# After an edit of C++ alone: rebuild the module in place, without pip.
module:
	@cmake --build $(BUILD) -j $(JOBS) --target _core > /dev/null && cmake --install $(BUILD) --prefix \
	  $$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_paths()["platlib"])')/polhode > /dev/null

# The library and its C++ tests by Clang, each file by itself, and each public header alone; no warning passes.
clang: $(VENV)/.demo
	@cmake -S . -B build/clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ -DPOLHODE_WERROR=ON \
	  -DPOLHODE_UNITY=OFF -DPOLHODE_BUILD_TESTS=ON $$($(VENV)/bin/python .ci/eigen_dir.py --cmake) > /dev/null
	@cmake --build build/clang -j $(JOBS) --target polhode_tests polhode_headers_alone | sed -n '/warning:\|error:/p'
	@build/clang/tests/cpp/polhode_tests

# The C++ tests under sanitizers: address and undefined behaviour, then threads, each by GCC and by Clang. A part alone:
# make sanitize SANITIZERS=thread COMPILERS=g++
SANITIZERS ?= address,undefined,float-cast-overflow thread
COMPILERS  ?= g++ clang++
sanitize: $(VENV)/.demo
	@for compiler in $(COMPILERS); do for sanitizer in $(SANITIZERS); do .ci/sanitize $$compiler $$sanitizer; done; done

# The C++ tests under valgrind, whose long double has 64 bits: those that need more are left out.
valgrind: install
	@.ci/valgrind

# Every door for FUZZ_SECONDS each by libFuzzer (Clang) and, for the readers of files, by atheris.
FUZZ_SECONDS ?= 60
fuzz: install
	@.ci/fuzz $(FUZZ_SECONDS)

# Which changes of the sources the tests see: a sample drawn by a seed. It goes on where the last run stopped.
# make mutants MUTANTS="--minutes 30", or --again for those that survived, --show for the results so far.
mutants: install
	@$(PYTHON) tests/mutants/run.py $(MUTANTS)

# The C++ tests for AArch64, emulated: among them that its answers have the bits of x86's baseline.
aarch64: $(VENV)/.demo
	@dpkg -s g++-aarch64-linux-gnu qemu-user > /dev/null 2>&1 || \
	  apt-get install -y -qq --no-install-recommends g++-aarch64-linux-gnu qemu-user > /dev/null
	@cmake -S . -B build/aarch64 -G Ninja -DCMAKE_BUILD_TYPE=Release -DPOLHODE_WERROR=ON -DPOLHODE_BUILD_TESTS=ON \
	  -DCMAKE_TOOLCHAIN_FILE=$(CURDIR)/.ci/machines/aarch64.cmake -Ddoctest_DIR=/usr/lib/cmake/doctest \
	  $$($(VENV)/bin/python .ci/eigen_dir.py --cmake | grep . || echo -DEigen3_DIR=/usr/share/eigen3/cmake) > /dev/null
	@cmake --build build/aarch64 -j $(JOBS) --target polhode_tests | sed -n '/warning:\|error:/p'
	@qemu-aarch64 -L /usr/aarch64-linux-gnu build/aarch64/tests/cpp/polhode_tests

# Debian 13: GCC 14, Clang 19, Python 3.13, in a folder made by debootstrap (needs root). DEBIAN13 names another folder.
DEBIAN13 ?= build/debian13
debian13:
	@.ci/machines/debian13 $(DEBIAN13)

# Free-threaded Python 3.13 in that folder, built from Debian's source, and the Python tests by it.
free-threaded:
	@.ci/machines/free_threaded $(DEBIAN13)

# A wheel for each Python at hand, checked and tested in a bare environment, and the sdist.
wheels:
	@.ci/wheels

# The site, with its notebooks and its gallery run: build/site/index.html.
docs: install
	@$(PYTHON) -m sphinx -W --keep-going -n -q docs build/site 2> >(grep -v IPKernelApp >&2)

# Screenshots of four pages, light and dark, wide and narrow, by a headless Chromium.
docs-pictures: docs
	@$(PYTHON) tests/support/site_pictures.py build/site build/site-pictures

# The core as WebAssembly by Zig's Clang, its sizes, its numbers against the native baseline, the playground as one file.
# The check skips nothing: POLHODE_WEB makes a test that lacks what it needs a failure.
web-check: web
web: install
	@$(PYTHON) -m pip install -qq --disable-pip-version-check "ziglang==0.17.1" wasmtime
	@JOBS=$(JOBS) $(PYTHON) web/build.py
	@POLHODE_WEB=required POLHODE_SIMD=baseline $(PYTHON) -m pytest -q tests/python/test_web.py

# The playground in a headless Chromium: two widths, light and dark. Pictures in build/web/pictures.
web-pictures: install
	@$(PYTHON) tests/support/web_pictures.py build/web/playground.html build/web/pictures

# The pages that polhode writes, in a headless Chromium: films of motions, and the report.
browser: install
	@$(PYTHON) -m pytest -q tests/python/test_film.py tests/python/test_report.py

stubs: install
	@$(PYTHON) tests/support/make_stubs.py

clean:
	@rm -rf build demo docs/auto_gallery
