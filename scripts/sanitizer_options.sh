# shellcheck shell=bash
# Environment of programs built with a sanitizer; other scripts source this file.
#   source scripts/sanitizer_options.sh build/asan     reports go to build/asan/reports
# Afterwards `no_sanitizer_reports` prints the reports since, and succeeds if there are none.

sanitizer_reports="${PWD}/$1/reports"
rm -rf "${sanitizer_reports}"
mkdir -p "${sanitizer_reports}"

# The distribution builds protobuf, gRPC and abseil without sanitizers, so they do not mark what they put into
# containers.
export ASAN_OPTIONS="detect_container_overflow=0:log_path=${sanitizer_reports}/asan"
export LSAN_OPTIONS="suppressions=${PWD}/scripts/lsan_suppressions.txt:print_suppressions=0"
export UBSAN_OPTIONS="print_stacktrace=1:log_path=${sanitizer_reports}/ubsan"
export TSAN_OPTIONS="suppressions=${PWD}/scripts/tsan_suppressions.txt"
# Tests of memory allow several times as much under a sanitizer.
export DUET_SANITIZER=1

no_sanitizer_reports() {
  local files
  files="$(find "${sanitizer_reports}" -type f)"
  [[ -z "${files}" ]] && return
  while read -r file; do
    echo "== ${file}" >&2
    head -n 60 "${file}" >&2
  done <<<"${files}"
  return 1
}
