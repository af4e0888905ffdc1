#!/usr/bin/env bash
# Makes what a release publishes in build/release_files/VERSION: Debian packages, the Python wheel and sdist, the
# images as archives, and SHA256SUMS. Each part is built first, and its version must be that of CMakeLists.txt.
#   scripts/make_release.sh                      everything
#   scripts/make_release.sh packages python      some parts: packages, python, images
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  printf 'make_release: %s\n' "$*" >&2
  exit 1
}

version="$(sed -n 's/^project(duet VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)"
readonly version out="build/release_files/${version}"

# expect_version WHAT VERSION
expect_version() {
  [[ "$2" == "${version}" || "$2" == "${version}-"* ]] || fail "$1: expected the version ${version}, got $2"
}

make_packages() {
  local package
  make build
  rm -rf build/release/packages
  (cd build/release && cpack -G DEB)
  for package in build/release/packages/*.deb; do
    expect_version "${package##*/}" "$(dpkg-deb -f "${package}" Version)"
    cp "${package}" "${out}"
  done
}

make_python() {
  local file
  make python
  for file in build/python/duet[-_]motion-*; do
    [[ "${file##*/}" =~ ^duet[-_]motion-([0-9.]+[0-9])[.-] ]] || fail "${file}: expected a version in its name, got none"
    expect_version "${file##*/}" "${BASH_REMATCH[1]}"
    cp "${file}" "${out}"
  done
}

make_images() {
  local name label
  deploy/image/build.sh
  deploy/image/build.sh --free
  for name in duet duet-free; do
    label="$(podman image inspect --format '{{index .Labels "org.opencontainers.image.version"}}' "localhost/${name}:${version}")"
    expect_version "${name}" "${label}"
    rm -f "${out}/${name}-image_${version}.tar"
    podman save --quiet --format oci-archive --output "${out}/${name}-image_${version}.tar" "localhost/${name}:${version}"
  done
}

# begin_folder COMMIT: makes the folder. Parts that another commit made are removed, so that all parts come from one.
begin_folder() {
  if [[ -d "${out}" && "$(cat "${out}/COMMIT" 2>/dev/null)" != "$1" ]]; then
    echo "make_release: removing ${out}, which another commit made"
    rm -rf "${out}"
  fi
  mkdir -p "${out}"
  echo "$1" >"${out}/COMMIT"
}

main() {
  local part sums parts=("$@")
  [[ $# -gt 0 ]] || parts=(packages python images)
  for part in "${parts[@]}"; do
    [[ "${part}" =~ ^(packages|python|images)$ ]] || fail "part: expected packages, python or images, got ${part}"
  done
  scripts/check_version.py
  [[ -z "$(git status --porcelain)" ]] || fail "expected a commit without changes beside it, got changed files (git status)"
  begin_folder "$(git rev-parse HEAD)"
  for part in "${parts[@]}"; do "make_${part}"; done
  rm -f "${out}/SHA256SUMS"
  sums="$(cd "${out}" && sha256sum -- *)"
  echo "${sums}" >"${out}/SHA256SUMS"
  echo "Duet ${version}, in ${out}:"
  cat "${out}/SHA256SUMS"
}

main "$@"
