#!/usr/bin/env bash
# Builds the fuzzers (Clang 14, libFuzzer, AddressSanitizer, UndefinedBehaviorSanitizer) and runs them. Fails on
# a finding; docs/fuzzing.md describes the next steps.
#   scripts/fuzz.sh [--seconds N] [--jobs N] [TARGET...]
#       --seconds N   CPU time for each target (60)
#       --jobs N      targets in parallel (1)
#       TARGET        folders of tests/fuzz/corpus (all)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

options=() targets=()
while [[ $# -gt 0 ]]; do
  case "$1" in
    --seconds | --jobs) options+=("$1" "${2:?$1: expected a number, got nothing}") && shift 2 ;;
    -*) sed -n '2,7s/^# \{0,1\}//p' scripts/fuzz.sh >&2 && exit 2 ;;
    *) targets+=("$1") && shift ;;
  esac
done
if [[ ${#targets[@]} -eq 0 ]]; then
  mapfile -t targets < <(ls tests/fuzz/corpus)
fi

scripts/configure.sh fuzz -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build build/fuzz --parallel "${JOBS:-$(scripts/build_jobs.sh)}" \
  --target "${targets[@]/#/fuzz_}"
exec scripts/run_fuzzers.py "${options[@]}" build/fuzz "${targets[@]}"
