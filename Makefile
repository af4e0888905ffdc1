# The two commands of the README, and commands for development. Each installs missing packages, builds and
# runs; CMake does the build (CMakePresets.json).
SHELL := /bin/bash
.DEFAULT_GOAL := help

JOBS ?= $(shell scripts/build_jobs.sh)
BUILD := build/release
# With training and evaluation or without them: DUET_TRAINING=OFF, or a release without LibTorch.
BUILD_LISTS = $(shell scripts/with_training.sh --lists)

.PHONY: help
help: ## List the commands
	@grep -hE '^[a-z]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z]+):.*## /  make \1\t/' | expand -t 18

.PHONY: demo
demo: ## Build, start the server, synthesise some reactions, write pages to out/demo
	@scripts/install_packages.sh $(BUILD_LISTS)
	@JOBS=$(JOBS) scripts/build.sh $(BUILD) duet-server duet
	@scripts/demo.sh $(BUILD)/bin

.PHONY: test
test: ## Build everything, run the quick checks and every test
	@scripts/install_packages.sh $(BUILD_LISTS) test
	@JOBS=$(JOBS) scripts/check.py --test

.PHONY: contrib
contrib: ## Build and test the tools next to Duet: contrib/README.md
	@scripts/install_packages.sh $(BUILD_LISTS) test $(patsubst %/packages.txt,%,$(wildcard contrib/*/packages.txt contrib/*/tests/packages.txt))
	@JOBS=$(JOBS) scripts/contrib.sh

.PHONY: build
build: ## Build every program and library (release)
	@scripts/install_packages.sh $(BUILD_LISTS)
	@JOBS=$(JOBS) scripts/build.sh $(BUILD)

.PHONY: format
format: ## Format the sources with clang-format
	@scripts/install_packages.sh test
	@scripts/format.sh

.PHONY: lint
lint: ## Run clang-tidy on files that differ from main (LINT=all: on all files)
	@scripts/install_packages.sh $(BUILD_LISTS) test develop
	@JOBS=$(JOBS) scripts/lint.sh $(LINT)

.PHONY: check
check: ## Run every check, including slow ones (CHECK="docs tidy" runs only these)
	@scripts/install_packages.sh $(BUILD_LISTS) test develop
	@JOBS=$(JOBS) scripts/check.py $(CHECK)

.PHONY: bench
bench: ## Time the engine and its kernels beside the committed figures
	@scripts/install_packages.sh $(BUILD_LISTS) test
	@scripts/configure.sh release -DDUET_BUILD_BENCHMARKS=ON >/dev/null
	@JOBS=$(JOBS) scripts/build.sh $(BUILD) roofline_benchmark kernel_benchmark solver_benchmark \
	  synthesis_benchmark
	@benchmarks/bench.py $(BUILD)

.PHONY: python
python: ## Build the Python package, wheel and sdist in build/python
	@scripts/install_packages.sh test
	@scripts/build_python.sh

.PHONY: clean
clean: ## Remove build/ and out/
	rm -rf build out
