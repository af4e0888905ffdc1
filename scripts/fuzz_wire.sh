#!/usr/bin/env bash
# Builds duet-server with AddressSanitizer and UndefinedBehaviorSanitizer and fuzzes it over the wire
# (tests/e2e/wire_fuzzer.py; docs/fuzzing.md).
#   scripts/fuzz_wire.sh [SECONDS [OPTION...]]     default 600 seconds; OPTIONs of wire_fuzzer.py
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly seconds="${1:-600}" build_dir=build/asan
shift || true

scripts/configure.sh asan -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build "${build_dir}" --parallel "${JOBS:-$(scripts/build_jobs.sh)}" --target duet-server
# shellcheck source=scripts/sanitizer_options.sh
source scripts/sanitizer_options.sh "${build_dir}"
status=0
# AddressSanitizer keeps freed memory for a while to detect its use. Models load at low priority, many times
# slower than in a release build.
tests/e2e/wire_fuzzer.py "${build_dir}" --seconds "${seconds}" --memory 2000 --patience 300 "$@" ||
  status=$?
no_sanitizer_reports || status=1
exit "${status}"
