# Two commands, each alone from a clean clone: `make demo` and `make test`. Both build .venv from the pinned lock files.
PYTHON ?= python3
BIN := .venv/bin
# Packages with compiled loops keep their cache beside the code; one BLAS thread: the matrices here are small.
export OPENBLAS_NUM_THREADS := 1
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo test inner lint install clean

demo: .venv/ready
	$(BIN)/hdrig demo

test: .venv/ready-dev lint
	$(BIN)/python -m pytest -n 2

inner: .venv/ready-dev  ## the fast part of the tests, under 60 s
	$(BIN)/python -m pytest -n 2 -m "not slow"

lint: .venv/ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports

install: .venv/ready

.venv/bin/python:
	$(PYTHON) -c 'import sys; sys.exit(None if (3, 11) <= sys.version_info[:2] < (3, 14) else f"hdrig needs Python 3.11 to 3.13, this is {sys.version.split()[0]}; try: make PYTHON=python3.12")'
	$(PYTHON) -m venv .venv

.venv/ready: requirements.lock pyproject.toml | .venv/bin/python
	$(BIN)/python -m pip install --quiet --require-hashes -r requirements.lock
	$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation -e .
	touch $@

.venv/ready-dev: requirements-dev.lock .venv/ready
	$(BIN)/python -m pip install --quiet --require-hashes -r requirements-dev.lock
	touch $@

clean:
	rm -rf .venv .mypy_cache .pytest_cache .ruff_cache .import_linter_cache
