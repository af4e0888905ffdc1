#!/usr/bin/env bash
# Everything that must hold before a change lands: it builds without a warning, passes the checks that
# are quick (docs/guides/checks.md has all), and every test passes. Called by `make test` and by CI.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly build_dir=build/release
jobs="${JOBS:-$(scripts/build_jobs.sh)}"
export JOBS="${jobs}"

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

step "Shell scripts" scripts/check_shell.sh
step "Layout" scripts/format.sh --check
step "Checks, self-tests" scripts/self_test.sh
step "Layers" scripts/check_layers.py
step "Documents" scripts/check_docs.py
step "Wire contract" scripts/check_proto.sh
step "Configure" configure
step "Links" scripts/check_links.py
step "Build" cmake --build "${build_dir}" --parallel "${jobs}"
step "Headers" scripts/check_headers.py --torch-free
step "Thread safety" scripts/check_thread_safety.py
step "Thread sanitizer" scripts/check_tsan.sh
step "Hardening" scripts/check_hardening.sh "${build_dir}/bin"
step "Runtime packages" scripts/check_runtime_packages.sh "${build_dir}/bin"

echo "== Built and checked in ${SECONDS} s; the tests' own total closes the run."
exec ctest --test-dir "${build_dir}" --output-on-failure --parallel 2
