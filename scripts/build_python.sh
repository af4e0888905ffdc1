#!/usr/bin/env bash
# Builds the Python package, a wheel and an sdist, from client/python with Debian's build and setuptools and
# without network access.
#   scripts/build_python.sh [output folder]       (build/python)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out="${1:-build/python}"
mkdir -p "${out}"
out="$(cd "${out}" && pwd)"

# Setuptools writes files beside its sources, so it gets a copy.
copy="$(mktemp -d)"
trap 'rm -rf "${copy}"' EXIT
cp -r client/python/. LICENSE "${copy}"
find "${copy}" -name __pycache__ -prune -exec rm -rf {} +

# The same files give the same wheel: all times are in 1980, the first year of a zip.
export SOURCE_DATE_EPOCH=315532800
/usr/bin/python3 -m build --no-isolation --outdir "${out}" "${copy}" >"${copy}.log" 2>&1 || {
  cat "${copy}.log" >&2
  exit 1
}
rm "${copy}.log"
ls "${out}"/duet[-_]motion-*
