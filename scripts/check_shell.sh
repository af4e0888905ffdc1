#!/usr/bin/env bash
# Runs shellcheck over every shell script of the project.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mapfile -t scripts < <(find .ci scripts benchmarks contrib deploy tests \
  -name '*.sh' -o -path .ci/run -o -path 'scripts/hooks/*' | sort)
shellcheck "${scripts[@]}"
echo "Shell: shellcheck finds nothing in ${#scripts[@]} scripts."
