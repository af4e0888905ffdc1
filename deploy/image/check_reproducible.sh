#!/usr/bin/env bash
# Compiles and builds the server's image a second time and compares it with the one that is there: every
# layer must have the digest that it had. Nothing that was compiled before is used.
#   deploy/image/build.sh && deploy/image/check_reproducible.sh
# Flags of `podman build` may follow, those that the first build had; with --no-cache the packages are
# installed a second time as well, which gives the same as long as Debian's have not been renewed.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly image=localhost/duet:latest

layers() {
  podman image inspect --format '{{range .RootFS.Layers}}{{println .}}{{end}}' "${image}"
}

first="$(layers)"
# Another folder than any before, which is empty: the compiler's cache.
DUET_CCACHE_DIR='' deploy/image/build.sh server \
  --build-arg "CCACHE_DIR=/var/cache/empty-$(date +%s)" "$@"
second="$(layers)"

if [[ "${first}" != "${second}" ]]; then
  printf 'check_reproducible: the layers differ\n%s\n\n%s\n' "${first}" "${second}" >&2
  exit 1
fi
printf 'Two builds, the same layers:\n%s\n' "${second}"
