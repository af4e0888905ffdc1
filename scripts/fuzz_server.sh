#!/usr/bin/env bash
# Builds duet-server with AddressSanitizer and UndefinedBehaviorSanitizer and fuzzes it while it runs
# (docs/fuzzing.md).
#   scripts/fuzz_server.sh wire|live [SECONDS [OPTION...]]
# wire: malformed traffic, tests/e2e/wire_fuzzer.py. live: live sessions, tests/e2e/live_fuzzer.py. Default:
# 600 seconds. OPTIONs are the fuzzer's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case "${1:-}" in
  wire | live) ;;
  *)
    echo "fuzz_server.sh: expected wire or live, got \"${1:-}\"" >&2
    exit 2
    ;;
esac
readonly fuzzer="tests/e2e/$1_fuzzer.py" seconds="${2:-600}" build_dir=build/asan
shift "$(($# < 2 ? $# : 2))"

scripts/configure.sh asan -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=OFF >/dev/null
cmake --build "${build_dir}" --parallel "${JOBS:-$(scripts/build_jobs.sh)}" --target duet-server
# shellcheck source=scripts/sanitizer_options.sh
source scripts/sanitizer_options.sh "${build_dir}"
status=0
# AddressSanitizer keeps freed memory for a while to detect its use. Models load at low priority, many times
# slower than in a release build.
"${fuzzer}" "${build_dir}" --seconds "${seconds}" --memory 2000 --patience 300 "$@" || status=$?
no_sanitizer_reports || status=1
exit "${status}"
