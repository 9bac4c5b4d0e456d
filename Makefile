# Two commands, each alone from a clean clone: `make demo` and `make test`. Both build .venv from the pinned lock files.
PYTHON ?= python3
UV ?= uv
BIN := .venv/bin
PIP_INSTALL := $(BIN)/python -m pip install --quiet --no-compile --no-deps --require-hashes
# Packages with compiled loops keep their cache beside the code; one BLAS thread: the matrices here are small.
export OPENBLAS_NUM_THREADS := 1
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test pytest inner long blind bench pictures lint install lock clean

demo: .venv/ready
	$(BIN)/hdrig demo

test: .venv/ready-dev  ## types are checked beside the tests
	$(MAKE) -j2 lint pytest

# a worker more than two cores: some tests wait, for the time at the rig or for another process
pytest: .venv/ready-dev
	$(BIN)/python -m tests.compiled
	$(BIN)/python -m pytest -n 3 --dist loadgroup -m "not long"

inner: .venv/ready-dev  ## the fast part of the tests: a minute on an idle machine
	$(BIN)/python -m pytest -n 2 -m "not slow and not long"

blind: .venv/ready-dev  ## the tracer on thirty campaigns of an independent plant; the table goes to build/blind/TABLE.md
	rm -rf build/blind
	$(BIN)/python -m tests.blind.generate --suite 30 --seed $(or $(SEED),1) --jobs 2 --out build/blind
	$(BIN)/python -m tests.blind.score build/blind --jobs 2 --table build/blind/TABLE.md
	$(BIN)/python -m tests.blind.peers.compare build/blind --table build/blind/TABLE.md

bench: .venv/ready-dev  ## how fast, beside C floors and other libraries (built and installed in build/bench): twenty minutes
	$(BIN)/python -m tests.bench --table tests/bench/TABLE.md

long: .venv/ready-dev  ## real time over the wire, whole loops, more whole traces: an hour and more, on a machine that does nothing else
	$(BIN)/python -m pytest -m long

pictures: .venv/ready-dev  ## the README's pictures, from real runs on the twin: six minutes on a quiet machine
	$(BIN)/python -m tests.pictures

lint: .venv/ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

install: .venv/ready

.venv/bin/python:
	$(PYTHON) -c 'import sys; sys.exit(None if (3, 11) <= sys.version_info[:2] < (3, 14) else f"hdrig needs Python 3.11 to 3.13, this is {sys.version.split()[0]}; try: make PYTHON=python3.12")'
	$(PYTHON) -m venv .venv

.venv/ready: .lock/run.txt pyproject.toml | .venv/bin/python
	$(BIN)/python -m pip install --quiet --no-deps --require-hashes -r .lock/run.txt
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation -e .
	$(BIN)/python -m compileall -q rig drivers sim
	touch $@

# the product's packages and those of the tests at a time: none is in both files, and each takes half a minute of a core
.venv/ready-dev: .lock/run.txt .lock/dev.txt pyproject.toml | .venv/bin/python
	$(PIP_INSTALL) -r .lock/run.txt & run=$$!; $(PIP_INSTALL) -r .lock/dev.txt; dev=$$?; wait $$run && exit $$dev
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation -e .
	touch .venv/ready $@

lock:  ## renew the pinned versions (needs uv)
	$(UV) pip compile --universal --python-version 3.11 --generate-hashes --no-header --no-emit-index-url --no-annotate -q pyproject.toml .lock/build.in -o .lock/run.txt
	$(UV) pip compile --universal --python-version 3.11 --generate-hashes --no-header --no-emit-index-url --no-annotate -q --extra dev pyproject.toml .lock/build.in -c .lock/run.txt -o .lock/all.txt
	awk 'NR == FNR { seen[$$1]; next } /^[^ ]/ { new = !($$1 in seen) } new' .lock/run.txt .lock/all.txt >.lock/dev.txt
	rm .lock/all.txt

clean:
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .import_linter_cache
