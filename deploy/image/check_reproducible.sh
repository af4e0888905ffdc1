#!/usr/bin/env bash
# Compiles and builds the server's image a second time, without anything that the first build compiled, and
# compares it with the existing one: every layer must have the same digest.
#   deploy/image/build.sh && deploy/image/check_reproducible.sh
# Flags of `podman build` may follow: those of the first build. With --no-cache the packages are installed a
# second time as well, with the same result unless Debian has updated them.
# DUET_SECOND_CCACHE_DIR, a folder of this machine that no other build uses, keeps the objects of this check: an
# interrupted check continues, and the next one compiles only what has changed. Each of the two builds has still
# compiled each file itself.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly image=localhost/duet:latest

layers() {
  podman image inspect --format '{{range .RootFS.Layers}}{{println .}}{{end}}' "${image}"
}

# A new folder, which is empty without a volume.
cache="/var/cache/second-ccache-$(date +%s)"
flags=(--build-arg "CCACHE_DIR=${cache}")
if [[ -n "${DUET_SECOND_CCACHE_DIR:-}" ]]; then
  mkdir -p "${DUET_SECOND_CCACHE_DIR}"
  if [[ "${DUET_SECOND_CCACHE_DIR}" -ef "${DUET_CCACHE_DIR:-}" ]]; then
    echo "check_reproducible: DUET_SECOND_CCACHE_DIR: expected another folder, got the first build's cache" >&2
    exit 2
  fi
  flags+=(--volume "$(realpath "${DUET_SECOND_CCACHE_DIR}"):${cache}")
fi

first="$(layers)"
DUET_CCACHE_DIR='' deploy/image/build.sh server "${flags[@]}" "$@"
second="$(layers)"

if [[ "${first}" != "${second}" ]]; then
  printf 'check_reproducible: the layers differ\n%s\n\n%s\n' "${first}" "${second}" >&2
  exit 1
fi
printf 'Two builds, the same layers:\n%s\n' "${second}"
