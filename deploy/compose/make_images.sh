#!/usr/bin/env bash
# Builds the images of the compose file: the server's, and HAProxy and Prometheus from Debian's packages.
#   deploy/compose/make_images.sh [flags of podman build...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

base=debian:bookworm-slim
if podman image exists "localhost/${base}"; then base="localhost/${base}"; fi
for target in proxy prometheus; do
  podman build --format docker --build-arg "BASE=${base}" --target "${target}" \
    --tag "localhost/duet-${target}:latest" "$@" --file neighbours.Dockerfile .
done
../image/build.sh server "$@"
