# Sidestep: set up, fly, test. Needs Python 3.11 or newer and a package index; works with GNU make 3.81 and later.
#
#   make fly     set up .venv and fly the paper's mission     make fly SCENARIO=random ARGS="--obstacles 40 --seed 7"
#   make test    set up .venv with the tools and run all tests        make test ARGS="tests/avoidance -x"
#   make lint    ruff (lint and format), mypy --strict, import-linter
#   make bench   the benchmarks, as Markdown tables
#   make picture the head of the last first flight's report as docs/images/first-flight.png
#   make clean   remove what these commands made
#
# PYTHON=/path/to/python3.12 chooses the interpreter, VENV=… the environment's folder, UV= (empty) does without uv.

SHELL := /bin/sh
VENV ?= .venv
BIN := $(VENV)/bin
SCENARIO ?=
RUN ?= out/$(if $(SCENARIO),$(basename $(notdir $(SCENARIO))),first-flight)
UV ?= $(shell command -v uv 2>/dev/null)

# What the installed package is made from: when one of these changes it is installed again and the FMU rebuilt.
SOURCES := pyproject.toml hatch_build.py \
	$(filter-out fmu/library.py fmu/plant.py fmu/__init__.py,$(wildcard fmu/*.py)) \
	$(wildcard fmu/src/*.c fmu/src/*.h fmu/aircraft/*.toml)
FMU := fmu/sidestep_aircraft.fmu
AGAIN := $(if $(wildcard $(FMU)),,again)

.PHONY: help fly test lint bench picture clean again

help:
	@sed -n '/^#/!q; s/^# \{0,1\}//p' Makefile

fly: $(VENV)/.flies
	@$(BIN)/sidestep fly $(SCENARIO) -o "$(RUN)" $(ARGS); code=$$?; \
	if [ -f "$(RUN)/report.html" ]; then echo "The report: $(CURDIR)/$(RUN)/report.html"; fi; exit $$code

test: $(VENV)/.tests
	$(BIN)/python -m pytest $(ARGS)

lint: $(VENV)/.tests
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy --strict
	$(BIN)/lint-imports

bench: $(VENV)/.bench
	@for script in benchmarks/bench_*.py; do echo "## $$script"; $(BIN)/python "$$script" $(ARGS) || exit 1; done

picture:
	@test -f out/first-flight/report.html || { echo "make: no report yet; run make fly first" >&2; exit 1; }
	@for browser in chromium chromium-browser google-chrome; do \
	  if command -v $$browser >/dev/null 2>&1; then \
	    mkdir -p docs/images && profile=`mktemp -d` && \
	    $$browser --headless=new --no-sandbox --disable-gpu --hide-scrollbars --no-first-run --disable-sync \
	      --disable-background-networking --user-data-dir="$$profile" --virtual-time-budget=10000 \
	      --window-size=1280,1500 --screenshot="$(CURDIR)/docs/images/first-flight.png" \
	      "file://$(CURDIR)/out/first-flight/report.html" >/dev/null 2>&1; code=$$?; \
	    rm -rf "$$profile"; exit $$code; \
	  fi; \
	done; echo "make: no chromium, chromium-browser or google-chrome on the PATH" >&2; exit 1

clean:
	rm -rf $(VENV) out build dist $(FMU) fmu/sidestep_aircraft_fmi2.fmu .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(VENV)/.flies: $(SOURCES) $(AGAIN) | $(BIN)/python
	@echo "Installing Sidestep into $(VENV) (the first time takes a minute or two) ..."
	@$(call install,-e .)
	@touch $@

$(VENV)/.tests: $(SOURCES) $(AGAIN) | $(BIN)/python
	@echo "Installing Sidestep and its test tools into $(VENV) (the first time takes a minute or two) ..."
	@$(call install,-e '.[dev]')
	@touch $@ $(VENV)/.flies

$(VENV)/.bench: $(VENV)/.tests
	@$(call install,-e '.[bench]')
	@touch $@

ifeq ($(UV),)
install = $(BIN)/python -m pip install --quiet --disable-pip-version-check $(1)
else
install = "$(UV)" pip install --quiet --python $(BIN)/python --reinstall-package sidestep $(1)
endif

# The newest interpreter the dependencies are tested with, else whatever is there and new enough.
$(BIN)/python:
	@found=; \
	for name in $(or $(PYTHON),python3.13 python3.12 python3.11 python3 python); do \
	  found=`$$name -c 'import sys; sys.version_info >= (3, 11) and sys.stdout.write(sys.executable)' 2>/dev/null` || found=; \
	  if [ -n "$$found" ]; then break; fi; \
	done; \
	if [ -n "$(UV)" ]; then \
	  echo "Making $(VENV) with uv and $${found:-a Python that uv fetches}"; \
	  "$(UV)" venv --quiet --python "$${found:->=3.11}" $(VENV); \
	elif [ -n "$$found" ]; then \
	  echo "Making $(VENV) with $$found"; \
	  "$$found" -m venv $(VENV) || { rm -rf $(VENV); \
	    echo "make: $$found cannot make virtual environments. Debian and Ubuntu: install python3-venv; or install uv." >&2; exit 1; }; \
	else \
	  echo "make: no Python 3.11 or newer found. Install one, or name it: make fly PYTHON=/path/to/python3.12" >&2; exit 1; \
	fi
