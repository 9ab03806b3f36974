# Everything goes through a virtual environment in .venv that these targets make themselves.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed

.PHONY: demo test test-slow test-faults test-fuzz test-seeds check bench format setup clean system-libraries furniture browser

demo: setup
	$(BIN)/slamgym study quick --out out/quick

test: setup
	$(BIN)/python -m pytest $(PYTEST_ARGS)

test-slow: setup
	$(BIN)/python -m pytest -m slow $(PYTEST_ARGS)

test-faults: setup
	$(BIN)/python -m pytest -m faults $(PYTEST_ARGS)

test-fuzz: setup
	$(BIN)/python -m pytest -m fuzz $(PYTEST_ARGS)

test-seeds: setup
	$(BIN)/python -m pytest -m seeds $(PYTEST_ARGS)

check: setup
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy slamgym tests examples
	$(BIN)/lint-imports

format: setup
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

bench: setup
	for bench in tests/benchmarks/bench_*.py; do $(BIN)/python $$bench || exit 1; done

setup: system-libraries $(STAMP)

system-libraries:
	@sh .ci/system_libraries.sh $(PYTHON)

furniture:
	@sh .ci/system_libraries.sh $(PYTHON) sweethome3d-furniture

browser:
	@sh .ci/system_libraries.sh $(PYTHON) chromium

$(STAMP): pyproject.toml
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "slamgym needs Python 3.11 or later, $(PYTHON) is $$($(PYTHON) --version); name one with make PYTHON=..." >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --upgrade pip
	$(BIN)/pip install --quiet --editable '.[dev]'
	@touch $@

clean:
	rm -rf $(VENV) build dist *.egg-info .mypy_cache .ruff_cache .pytest_cache .hypothesis
