#!/usr/bin/env bash
# Compiles and builds the server's image a second time and compares it with the one that is there: every
# layer must have the digest that it had. Nothing that the first build compiled is used.
#   deploy/image/build.sh && deploy/image/check_reproducible.sh
# Flags of `podman build` may follow, those that the first build had; with --no-cache the packages are
# installed a second time as well, which gives the same as long as Debian's have not been renewed.
# DUET_SECOND_CCACHE_DIR, a folder of this machine that no build but this one uses, keeps what is compiled
# here: a check that was interrupted goes on, and the next one compiles only what has changed since. Both
# builds then still have compiled each file by themselves.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly image=localhost/duet:latest

layers() {
  podman image inspect --format '{{range .RootFS.Layers}}{{println .}}{{end}}' "${image}"
}

# Another folder than any before: with no volume behind it, it is empty.
cache="/var/cache/second-ccache-$(date +%s)"
flags=(--build-arg "CCACHE_DIR=${cache}")
if [[ -n "${DUET_SECOND_CCACHE_DIR:-}" ]]; then
  mkdir -p "${DUET_SECOND_CCACHE_DIR}"
  if [[ "${DUET_SECOND_CCACHE_DIR}" -ef "${DUET_CCACHE_DIR:-}" ]]; then
    echo "check_reproducible: DUET_SECOND_CCACHE_DIR is the first build's cache, wanted another" >&2
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
