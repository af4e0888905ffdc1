#!/usr/bin/env bash
# Reads every shell script of the project with shellcheck.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mapfile -t scripts < <(find .ci scripts benchmarks deploy tests -name '*.sh' -o -path .ci/run | sort)
shellcheck "${scripts[@]}"
echo "Shell: shellcheck finds nothing in ${#scripts[@]} scripts."
