#!/usr/bin/env bash
# Formats every C++ file with clang-format 14 (other versions format differently).
# Releases without it (packages/releases.tsv) skip the check.
#   scripts/format.sh          rewrites the files
#   scripts/format.sh --check  fails and names the files that would change
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

case "${1:-}" in
  "") mode=(-i) ;;
  --check) mode=(--dry-run -Werror --ferror-limit=1) ;;
  *) echo "usage: format.sh [--check]" >&2 && exit 2 ;;
esac

if ! command -v clang-format-14 >/dev/null; then
  echo "format.sh: clang-format 14 is not installed: the format is not checked."
  [[ "${mode[0]}" == --dry-run && "$(scripts/install_packages.sh --print test)" != *clang-format-14* ]]
  exit
fi

find model server client tests benchmarks contrib -name '*.h' -o -name '*.cc' |
  sort | xargs --no-run-if-empty --max-args=64 --max-procs="$(nproc)" clang-format-14 "${mode[@]}"
