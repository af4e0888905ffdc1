#!/usr/bin/env bash
# Makes the image `localhost/debian:RELEASE-slim` from Debian's packages, for machines that reach a
# Debian mirror but no image registry. Run it as root; it needs mmdebstrap and podman.
#   deploy/image/make_base.sh           bookworm (Debian 12)
#   deploy/image/make_base.sh trixie    Debian 13
# deploy/image/build.sh uses bookworm's image if it exists; for other builds, pass
# --build-arg BASE=localhost/debian:RELEASE-slim, or set BASE for deploy/image/build.sh.
set -euo pipefail

readonly release="${1:-bookworm}"
readonly name="localhost/debian:${release}-slim"

fail() {
  printf 'make_base: %s\n' "$*" >&2
  exit 1
}

command -v mmdebstrap >/dev/null || fail "needs the package mmdebstrap"
command -v podman >/dev/null || fail "needs the package podman"

work="$(mktemp -d)"
readonly work
trap 'rm -rf "${work}"' EXIT

# Paths that Debian's slim image omits; copyright files stay.
readonly excluded=(/usr/share/man /usr/share/info /usr/share/locale /usr/share/doc /usr/share/groff
  /usr/share/lintian /usr/share/linda)
options=()
for folder in "${excluded[@]}"; do options+=(--dpkgopt="path-exclude=${folder}/*"); done
options+=(--dpkgopt='path-include=/usr/share/doc/*/copyright')

# Names no archive: mmdebstrap's default is the release with its updates and security fixes.
mmdebstrap --mode=root --variant=minbase --include=ca-certificates "${options[@]}" \
  "${release}" "${work}/base.tar"
podman import --change 'CMD ["bash"]' "${work}/base.tar" "${name}"
echo "${name} is made."
