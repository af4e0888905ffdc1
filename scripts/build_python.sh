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
trap 'rm -rf "${copy}" "${copy}.log"' EXIT

# The same files give the same wheel: all times are in 1980, the first year of a zip.
export SOURCE_DATE_EPOCH=315532800
# Builds one kind of distribution from a folder.
build() {
  /usr/bin/python3 -m build --no-isolation "$1" --outdir "${copy}/dist" "$2" >"${copy}.log" 2>&1 || {
    cat "${copy}.log" >&2
    exit 1
  }
}

cp -r client/python/. LICENSE "${copy}"
find "${copy}" -name __pycache__ -prune -exec rm -rf {} +
build --sdist "${copy}"
build --wheel "${copy}"

# pip installs what a pattern matches: only one wheel may be left.
rm -f "${out}"/duet[-_]motion-*.{whl,tar.gz}
cp "${copy}"/dist/* "${out}"
ls "${out}"/duet[-_]motion-*
