#!/usr/bin/env bash
# Runs the tests of the scripts (tests/scripts).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
PYTHONPATH=scripts exec python3 -B -m unittest discover --quiet --start-directory tests/scripts --pattern '*_test.py'
