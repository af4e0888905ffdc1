#!/usr/bin/env bash
# Makes the image `localhost/debian:bookworm-slim` from Debian's packages, for machines that reach a
# Debian mirror but no image registry. As root; needs mmdebstrap and podman or buildah.
#   deploy/image/make_base.sh
# The Dockerfile then builds on it with --build-arg BASE=localhost/debian:bookworm-slim, which is what
# deploy/image/build.sh does where the image is there.
set -euo pipefail

readonly name=localhost/debian:bookworm-slim

fail() {
  printf 'make_base: %s\n' "$*" >&2
  exit 1
}

command -v mmdebstrap >/dev/null || fail "needs the package mmdebstrap"
command -v podman >/dev/null || fail "needs the package podman"

work="$(mktemp -d)"
readonly work
trap 'rm -rf "${work}"' EXIT

# What Debian's own slim image leaves out; copyright files stay.
readonly excluded=(/usr/share/man /usr/share/info /usr/share/locale /usr/share/doc /usr/share/groff
  /usr/share/lintian /usr/share/linda)
options=()
for folder in "${excluded[@]}"; do options+=(--dpkgopt="path-exclude=${folder}/*"); done
options+=(--dpkgopt='path-include=/usr/share/doc/*/copyright')

# No archive is named: mmdebstrap's own choice is bookworm with its updates and security fixes.
mmdebstrap --mode=root --variant=minbase --include=ca-certificates "${options[@]}" \
  bookworm "${work}/base.tar"
podman import --change 'CMD ["bash"]' "${work}/base.tar" "${name}"
echo "${name} is made."
