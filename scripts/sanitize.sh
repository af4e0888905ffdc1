#!/usr/bin/env bash
# Builds the test programs that need no LibTorch with a sanitizer, and runs them. Without a LABEL, also builds
# servers and clients and runs every script that starts a server (CTest's label "server").
#   scripts/sanitize.sh PRESET [LABEL]     PRESET: asan or tsan; LABEL: only test programs with this label
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly preset="$1" label="${2:-}"
readonly build_dir="build/${preset}"
# The programs that scripts start. A script that needs others, with LibTorch, has the label "libtorch".
readonly programs=(duet duet-load duet-server duet-fake-server)

# With the tools whose tests put a load or malformed requests on the server.
scripts/configure.sh "${preset}" -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=OFF -DDUET_CONTRIB_LOAD=ON \
  -DDUET_CONTRIB_STUDIO=ON >/dev/null
mapfile -t tests < <(scripts/torch_free_tests.py "${build_dir}" ${label:+"${label}"})
if [[ ${#tests[@]} -eq 0 ]]; then
  echo "${preset}: expected test programs${label:+ with the label ${label}}, got none" >&2
  exit 1
fi
targets=("${tests[@]}")
[[ -z "${label}" ]] && targets+=("${programs[@]}")
cmake --build "${build_dir}" --parallel "${JOBS:-$(scripts/build_jobs.sh)}" --target "${targets[@]}"

# shellcheck source=scripts/sanitizer_options.sh
source scripts/sanitizer_options.sh "${build_dir}"
failed=0
# One alternative for each program, anchored.
pattern="$(IFS='|' && echo "^(${tests[*]})\$")"
ctest --test-dir "${build_dir}" --output-on-failure --parallel 4 --tests-regex "${pattern}" || failed=1
if [[ -z "${label}" ]]; then
  # One at a time: several scripts start many sanitized servers and clients each.
  ctest --test-dir "${build_dir}" --output-on-failure -L '^server$' -LE '^libtorch$' || failed=1
fi
# Includes reports of programs that a test kills, or whose exit status it ignores.
no_sanitizer_reports || failed=1
exit "${failed}"
