#!/usr/bin/env bash
# Builds the test programs that need no LibTorch under a sanitizer, and runs them.
#   scripts/sanitize.sh PRESET [LABEL]     PRESET: asan or tsan; LABEL: only tests with this label
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly preset="$1" label="${2:-}"
readonly build_dir="build/${preset}"

cmake --preset "${preset}" -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=OFF >/dev/null
mapfile -t tests < <(scripts/torch_free_tests.py "${build_dir}" ${label:+"${label}"})
if [[ ${#tests[@]} -eq 0 ]]; then
  echo "${preset}: no test program to run${label:+ with the label ${label}}" >&2
  exit 1
fi
cmake --build "${build_dir}" --parallel "${JOBS:-$(scripts/build_jobs.sh)}" --target "${tests[@]}"

# One alternative for each program, matched as a whole.
pattern="$(IFS='|' && echo "^(${tests[*]})\$")"
export UBSAN_OPTIONS="print_stacktrace=1"
export TSAN_OPTIONS="suppressions=${PWD}/scripts/tsan_suppressions.txt"
ctest --test-dir "${build_dir}" --output-on-failure --tests-regex "${pattern}"
