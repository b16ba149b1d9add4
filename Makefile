# `make reproduce` and `make test` work on a machine with make, python3 (3.11 or later) and its
# venv module; what they install is pinned in constraints.txt. Both are quick when run again.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
JOBS ?= auto
# Each process of the tests has a core; threads of linear algebra would only get in their way.
PYTEST := OPENBLAS_NUM_THREADS=1 $(BIN)/python -m pytest -n $(JOBS)

.PHONY: reproduce test slow check bench docs pins clean
.DEFAULT_GOAL := reproduce

reproduce: report/.whole

report/.whole: $(VENV)/.package $(shell find src -type f -not -name '*.pyc')
	$(BIN)/somersault reproduce --out report
	touch $@

test: $(VENV)/.test
	$(PYTEST) -m "not slow"

slow: $(VENV)/.test
	$(PYTEST) -m slow

check: $(VENV)/.test
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

bench: $(VENV)/.test
	$(BIN)/python benchmarks/forward_dynamics.py
	$(BIN)/python benchmarks/stability_chart.py
	$(BIN)/python benchmarks/flights.py
	$(BIN)/python benchmarks/sensitivity.py
	$(BIN)/python benchmarks/planning.py
	$(BIN)/python benchmarks/ensembles.py
	$(BIN)/python benchmarks/films.py
	$(BIN)/python benchmarks/robots.py

docs: $(VENV)/.docs
	$(BIN)/mkdocs build --strict --quiet
	@echo "site/index.html"

$(VENV)/.venv:
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --upgrade pip
	touch $@

$(VENV)/.package: $(VENV)/.venv pyproject.toml constraints.txt
	$(BIN)/python -m pip install --quiet -c constraints.txt -e ".[film]"
	touch $@

$(VENV)/.test: $(VENV)/.package
	$(BIN)/python -m pip install --quiet -c constraints.txt -e ".[test]"
	touch $@

$(VENV)/.docs: $(VENV)/.package
	$(BIN)/python -m pip install --quiet -c constraints.txt -e ".[docs]"
	touch $@

# Write the pins anew from the newest releases that fit pyproject.toml.
pins:
	$(PYTHON) -m venv .venv-pins
	.venv-pins/bin/python -m pip install --quiet -e ".[test,docs]"
	.venv-pins/bin/python -m pip freeze --exclude-editable > constraints.txt
	rm -rf .venv-pins

clean:
	rm -rf $(VENV) report site
