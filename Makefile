# Each target says in one line what it does: `make help` prints the usual ones, `make help-all` every one.
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

.PHONY: help help-all demo test format same-bits check-long install module clang sanitize valgrind fuzz mutants \
        aarch64 debian13 free-threaded wheels forge wings stubs docs docs-pictures browser web web-check web-pictures clean
.NOTPARALLEL:
# An environment whose Python has gone is made anew.
ifneq ($(shell $(VENV)/bin/python -c 'import pip; print("there")' 2>/dev/null),there)
.PHONY: $(VENV)/.demo
endif
help: ## the usual targets
	@$(call list,$(USUAL))
	@echo "make help-all       the rest"
help-all: ## every target
	@$(call list,[a-z0-9-]+)

USUAL := test|demo|module|docs|format
list  = sed -nE 's/^($(1)):.*\#\# (.*)/\1 \2/p' Makefile | while read -r name line; do printf 'make %-14s %s\n' "$$name" "$$line"; done

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

install: $(VENV)/.ready build/.installed ## the environment, the Python module and the C++ tests; all others call it

# Half the usual time for the charts: fewer repeats, which they say. `polhode chart` alone takes two minutes.
demo: build/.installed ## charts speed against accuracy on the scenes, in a minute
	@echo "charting scenes/S*.toml for a minute"
	@$(PYTHON) -m polhode chart scenes/S*.toml --budget 60s --brief -o demo

test: install ## every test, C++ and Python, as a fresh clone is checked
	@cmake --build $(BUILD) -j $(JOBS) --target polhode_tests polhode_headers_alone polhode_c | sed -n '/warning:\|error:/p'
	@$(BUILD)/tests/cpp/polhode_tests
	@$(PYTHON) -m pytest -n $(JOBS) --dist loadfile

same-bits: install ## every answer has the stored bits, at every level of SIMD
	@$(PYTHON) tests/support/same_bits.py

check-long: install ## the long sweeps too, and the instructions of twenty jobs
	@$(PYTHON) -m pytest -m "long or not long"

module: ## after an edit of C++ alone: the Python module in place, in seconds
	@cmake --build $(BUILD) -j $(JOBS) --target _core > /dev/null && cmake --install $(BUILD) --prefix \
	  $$($(PYTHON) -c 'import sysconfig; print(sysconfig.get_paths()["platlib"])')/polhode > /dev/null

clang: $(VENV)/.demo ## the library and its C++ tests by Clang, without a warning
	@cmake -S . -B build/clang -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++ -DPOLHODE_WERROR=ON \
	  -DPOLHODE_UNITY=OFF -DPOLHODE_BUILD_TESTS=ON $$($(VENV)/bin/python .ci/eigen_dir.py --cmake) > /dev/null
	@cmake --build build/clang -j $(JOBS) --target polhode_tests polhode_headers_alone | sed -n '/warning:\|error:/p'
	@build/clang/tests/cpp/polhode_tests

# A part alone: make sanitize SANITIZERS=thread COMPILERS=g++
SANITIZERS ?= address,undefined,float-cast-overflow thread
COMPILERS  ?= g++ clang++
sanitize: $(VENV)/.demo ## the C++ tests under sanitizers of addresses, undefined behaviour and threads, GCC and Clang
	@for compiler in $(COMPILERS); do for sanitizer in $(SANITIZERS); do .ci/sanitize $$compiler $$sanitizer; done; done

# Its long double has 64 bits: tests that need more are left out.
valgrind: install ## the C++ tests under valgrind
	@.ci/valgrind

FUZZ_SECONDS ?= 60
fuzz: install ## a minute of coverage-guided fuzzing for each target (FUZZ_SECONDS=60), by Clang and atheris
	@.ci/fuzz $(FUZZ_SECONDS)

# The sample is drawn by a seed.
# make mutants MUTANTS="--minutes 30", or --again for those that survived, --show for the results so far.
mutants: install ## changes of the sources that the tests should see; continues where the last run stopped
	@$(PYTHON) tests/mutants/run.py $(MUTANTS)

aarch64: $(VENV)/.demo ## the C++ tests for AArch64 under qemu-user: among them, that answers have the bits of x86
	@dpkg -s g++-aarch64-linux-gnu qemu-user > /dev/null 2>&1 || \
	  apt-get install -y -qq --no-install-recommends g++-aarch64-linux-gnu qemu-user > /dev/null
	@cmake -S . -B build/aarch64 -G Ninja -DCMAKE_BUILD_TYPE=Release -DPOLHODE_WERROR=ON -DPOLHODE_BUILD_TESTS=ON \
	  -DCMAKE_TOOLCHAIN_FILE=$(CURDIR)/.ci/machines/aarch64.cmake -Ddoctest_DIR=/usr/lib/cmake/doctest \
	  $$($(VENV)/bin/python .ci/eigen_dir.py --cmake | grep . || echo -DEigen3_DIR=/usr/share/eigen3/cmake) > /dev/null
	@cmake --build build/aarch64 -j $(JOBS) --target polhode_tests | sed -n '/warning:\|error:/p'
	@qemu-aarch64 -L /usr/aarch64-linux-gnu build/aarch64/tests/cpp/polhode_tests

# DEBIAN13 names another folder.
DEBIAN13 ?= build/debian13
debian13: ## GCC 14, Clang 19 and Python 3.13, in a Debian 13 made by debootstrap (needs root)
	@.ci/machines/debian13 $(DEBIAN13)

# Python is built from Debian's source.
free-threaded: ## the Python tests by Python 3.13 without its lock, in the same Debian 13
	@.ci/machines/free_threaded $(DEBIAN13)

wheels: ## a wheel for each Python at hand, repaired, checked, tested in a bare environment; the sdist
	@.ci/wheels

forge: $(VENV)/.demo ## linters of workflows, forms and CITATION.cff
	@.ci/forge

wings: install ## deletes each wing in a copy, and imports and tests the rest: a minute
	@$(PYTHON) .ci/wings

ZIG := ziglang==0.17.1
docs: install ## the site, with its notebooks and gallery run, and the playground: some minutes, build/site/index.html
	@$(PYTHON) -m pip install -qq --disable-pip-version-check "$(ZIG)"
	@JOBS=$(JOBS) $(PYTHON) web/build.py
	@$(PYTHON) -m sphinx -W --keep-going -n -q docs build/site 2> >(grep -v IPKernelApp >&2)

docs-pictures: docs ## screenshots of the site, light and dark, wide and narrow, by a headless Chromium
	@$(PYTHON) tests/support/site_pictures.py build/site build/site-pictures

# The core as WebAssembly by Zig's Clang, its sizes, its numbers against the native baseline, the playground as one file.
# The check skips nothing: POLHODE_WEB makes a test that lacks what it needs a failure.
web-check: web ## `make web`, as .ci/run calls it: two minutes on two cores
web: install ## the core as WebAssembly, its numbers tested by wasmtime, and the playground as one file
	@$(PYTHON) -m pip install -qq --disable-pip-version-check "$(ZIG)" wasmtime
	@JOBS=$(JOBS) $(PYTHON) web/build.py
	@POLHODE_WEB=required POLHODE_SIMD=baseline $(PYTHON) -m pytest -q tests/python/web/test_web.py

web-pictures: install ## the playground in a headless Chromium, in two widths, light and dark
	@$(PYTHON) tests/support/web_pictures.py build/web/playground.html build/web/pictures

browser: install ## the pages that polhode writes, in a headless Chromium: films and the report
	@$(PYTHON) -m pytest -q tests/python/films/test_film.py tests/python/charts/test_report.py

format: $(VENV)/.demo ## Python by ruff; the C++ files that differ from the last commit by clang-format
	@.ci/prepare $(VENV) format > /dev/null
	@$(PYTHON) -m ruff check --fix .
	@git diff --name-only --diff-filter=d HEAD -- '*.cpp' '*.hpp' '*.inl' | xargs -r $(VENV)/bin/clang-format -i

stubs: install ## after an edit of a binding: the type stubs anew
	@$(PYTHON) tests/support/make_stubs.py

clean: ## removes the build
	@rm -rf build demo docs/auto_gallery
