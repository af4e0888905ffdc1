#!/usr/bin/env bash
# Prints the CMake option of every tool of contrib, one in each line: -DDUET_CONTRIB_LOAD=ON.
#   scripts/contrib_options.sh ON|OFF
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
shopt -s nullglob

for file in contrib/*/CMakeLists.txt; do
  tool="$(basename "$(dirname "${file}")")"
  echo "-DDUET_CONTRIB_${tool^^}=$1"
done
