# shellcheck shell=bash
# How programs built with a sanitizer run; for other scripts to source.
#   source scripts/sanitizer_options.sh build/asan     reports go to build/asan/reports
# Then `no_sanitizer_reports` succeeds if nothing was reported since, and prints what was.

sanitizer_reports="${PWD}/$1/reports"
rm -rf "${sanitizer_reports}"
mkdir -p "${sanitizer_reports}"

# Protobuf, gRPC and abseil come from the distribution, which builds them without sanitizers: what they put
# into a container is not marked.
export ASAN_OPTIONS="detect_container_overflow=0:log_path=${sanitizer_reports}/asan"
export LSAN_OPTIONS="suppressions=${PWD}/scripts/lsan_suppressions.txt:print_suppressions=0"
export UBSAN_OPTIONS="print_stacktrace=1:log_path=${sanitizer_reports}/ubsan"
export TSAN_OPTIONS="suppressions=${PWD}/scripts/tsan_suppressions.txt"
# Tests of memory allow more: a sanitizer takes several times as much.
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
