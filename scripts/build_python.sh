#!/usr/bin/env bash
# Builds the Python package, a wheel and an sdist, from client/python with Debian's build and setuptools and
# without network access. If a build folder has the extension module (target duet_python_module), the wheel
# contains it and is for this platform and Python; else it is for all. The sdist never contains it.
#   scripts/build_python.sh [output folder] [build folder]       (build/python, build/release)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out="${1:-build/python}"
readonly modules="${2:-build/release}/python/duet_motion"
mkdir -p "${out}"
out="$(cd "${out}" && pwd)"

# Setuptools writes files beside its sources, so it gets a copy.
copy="$(mktemp -d)"
trap 'rm -rf "${copy}"' EXIT

# Copies the package's sources to a folder.
copy_to() {
  cp -r client/python/. LICENSE "$1"
  rm -r "$1/extension"
  find "$1" -name __pycache__ -prune -exec rm -rf {} +
}

# The same files give the same wheel: all times are in 1980, the first year of a zip.
export SOURCE_DATE_EPOCH=315532800
# Builds one kind of distribution from a folder.
build() {
  /usr/bin/python3 -m build --no-isolation "$1" --outdir "${copy}/dist" "$2" >"${copy}/log" 2>&1 || {
    cat "${copy}/log" >&2
    exit 1
  }
}

# Adds the extension module to the package in a folder, and to its folder _libs abseil, whose version differs
# between systems, with the notices of the libraries that the wheel contains.
add_extension() {
  local libs="$1/_libs" file package
  cp "${modules}"/_motion_files.*.so "$1"
  mkdir "${libs}"
  ldd "${modules}"/_motion_files.*.so | awk '/libabsl_/ {print $1, $3}' | while read -r name file; do
    cp -L "${file}" "${libs}/${name}"
  done
  for package in libabsl-dev nlohmann-json3-dev pybind11-dev; do
    printf '%s\n\n' "== ${package} =="
    cat "/usr/share/doc/${package}/copyright"
    echo
  done >"${libs}/COPYRIGHT"
}

mkdir "${copy}/sdist" "${copy}/wheel"
copy_to "${copy}/sdist"
build --sdist "${copy}/sdist"
copy_to "${copy}/wheel"
if compgen -G "${modules}/_motion_files.*.so" >/dev/null; then
  add_extension "${copy}/wheel/duet_motion"
fi
build --wheel "${copy}/wheel"

# pip installs what a pattern matches: only one wheel may be left.
rm -f "${out}"/duet[-_]motion-*.{whl,tar.gz}
cp "${copy}"/dist/* "${out}"
ls "${out}"/duet[-_]motion-*
