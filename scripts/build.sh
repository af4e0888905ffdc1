#!/usr/bin/env bash
# Configures the release preset if necessary, and builds.
#   scripts/build.sh build/release [target...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build_dir="$1"
shift

# Tests are off because their libraries may be missing; `make test` installs these and turns tests on. An
# existing configuration stays; it is repeated because names in changed sources can change the batches (cmake/DuetBatches.cmake).
if [[ ! -f "${build_dir}/build.ninja" ]]; then
  scripts/configure.sh release -DDUET_BUILD_TESTS=OFF -DDUET_BUILD_BENCHMARKS=OFF
else
  cmake "${build_dir}" >/dev/null
fi
cmake --build "${build_dir}" --parallel "${JOBS:-$(scripts/build_jobs.sh)}" \
  ${1:+--target "$@"}
