#!/usr/bin/env bash
# Builds everything, runs the quick checks (scripts/checks.tsv) and every test. `make test` and CI call it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

export JOBS="${JOBS:-$(scripts/build_jobs.sh)}"
scripts/check.py --quick
echo "== Built and checked in ${SECONDS} s; CTest prints the time of the tests."
# Four half cores: a test takes two, or one if it mostly waits (duet_share_cores).
exec ctest --test-dir build/release --output-on-failure --parallel 4
