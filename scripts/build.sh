#!/usr/bin/env bash
# Configures the release preset where that was not done yet, and builds.
#   scripts/build.sh build/release [target...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

build_dir="$1"
shift

# Without the test libraries: `make test` adds them, and turns the tests on. What was configured
# before stays as it is.
if [[ ! -f "${build_dir}/build.ninja" ]]; then
  cmake --preset release -DDUET_BUILD_TESTS=OFF -DDUET_BUILD_BENCHMARKS=OFF
fi
cmake --build "${build_dir}" --parallel "${JOBS:-$(scripts/build_jobs.sh)}" \
  ${1:+--target "$@"}
