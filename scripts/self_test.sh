#!/usr/bin/env bash
# Runs the scripts' own tests (scripts/*_test.py).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
exec python3 -B -m unittest discover --quiet --pattern '*_test.py'
