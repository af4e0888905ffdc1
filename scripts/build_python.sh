#!/usr/bin/env bash
# Makes the Python package: a wheel and an sdist, from what stands in client/python, with Debian's
# build and setuptools and without a network.
#   scripts/build_python.sh [folder for both]       (build/python)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out="${1:-build/python}"
mkdir -p "${out}"
out="$(cd "${out}" && pwd)"

# Setuptools leaves its own files beside what it packs: it works on a copy.
copy="$(mktemp -d)"
trap 'rm -rf "${copy}"' EXIT
cp -r client/python/. LICENSE "${copy}"
find "${copy}" -name __pycache__ -prune -exec rm -rf {} +

# The same files give the same wheel: its times are of 1980, the first that a zip can hold.
export SOURCE_DATE_EPOCH=315532800
/usr/bin/python3 -m build --no-isolation --outdir "${out}" "${copy}" >"${copy}.log" 2>&1 || {
  cat "${copy}.log" >&2
  exit 1
}
rm "${copy}.log"
ls "${out}"/duet[-_]motion-*
