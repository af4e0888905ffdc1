#!/usr/bin/env bash
# Everything that must hold before a change lands: it builds without a warning, keeps to the layers
# and the layout, and every test passes. Called by `make test` and by CI.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly build_dir=build/release
jobs="${JOBS:-$(scripts/build_jobs.sh)}"

# Runs a step and says how long it took.
step() {
  local name="$1" start="${SECONDS}"
  shift
  echo "== ${name}"
  "$@"
  echo "== ${name}: $((SECONDS - start)) s"
}

configure() {
  cmake --preset release -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=ON \
    -DDUET_WARNINGS_AS_ERRORS="$([[ -n "${CI:-}" ]] && echo ON || echo OFF)"
}

step "Shell scripts" shellcheck .ci/run scripts/*.sh
step "Layout" scripts/format.sh --check
step "Layers, self-test" python3 scripts/check_layers_test.py
step "Layers" python3 scripts/check_layers.py
step "Configure" configure
step "Build" cmake --build "${build_dir}" --parallel "${jobs}"
step "Runtime packages" scripts/check_runtime_packages.sh "${build_dir}/bin"

echo "== Built and checked in ${SECONDS} s; the tests' own total closes the run."
exec ctest --test-dir "${build_dir}" --output-on-failure --parallel 2
