#!/usr/bin/env bash
# Builds an image with podman, fills in its labels from the working tree, and checks the server image's size.
#   deploy/image/build.sh                 localhost/duet:VERSION
#   deploy/image/build.sh training        localhost/duet-training:VERSION
#   deploy/image/build.sh --free          localhost/duet-free:VERSION, without the weights for research only;
#                                         with `training`, localhost/duet-training-free:VERSION
# BASE names another base; the default is `localhost/debian:bookworm-slim` if make_base.sh made it.
# DUET_CCACHE_DIR, a folder of this machine, is the compiler cache. Flags of `podman build` may follow the
# target's name.
# The same sources and packages give the same layers: all files have the time SOURCE_DATE_EPOCH (default
# 1970), so layers that a change does not affect stay in the cache. The label `created` has the time of the last
# commit.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly limit_mb=250

research_weights=ON
if [[ "${1:-}" == --free ]]; then
  research_weights=OFF
  shift
fi
target="${1:-server}"
shift || true
case "${target}" in
  server) name=localhost/duet ;;
  training) name=localhost/duet-training ;;
  *) echo "build.sh: target: expected server or training, got ${target}" >&2 && exit 2 ;;
esac
[[ "${research_weights}" == ON ]] || name+=-free

version="$(sed -n 's/^project(duet VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)"
revision="$(git rev-parse HEAD)$(git diff --quiet HEAD || echo -dirty)"
source_url="$(git remote get-url origin 2>/dev/null || echo unknown)"
epoch="${SOURCE_DATE_EPOCH:-0}"
rfc3339() { date --utc --date "@$1" +%Y-%m-%dT%H:%M:%SZ; }
created="$(rfc3339 "$(git log -1 --format=%ct)")"

flags=()
local_base=localhost/debian:bookworm-slim
if [[ -z "${BASE:-}" ]] && podman image exists "${local_base}"; then BASE="${local_base}"; fi
[[ -z "${BASE:-}" ]] || flags+=(--build-arg "BASE=${BASE}")
[[ -z "${DUET_CCACHE_DIR:-}" ]] || flags+=(
  --volume "${DUET_CCACHE_DIR}:/var/cache/host-ccache" --build-arg CCACHE_DIR=/var/cache/host-ccache)

# Podman's default format has no HEALTHCHECK.
podman build --format docker --timestamp "${epoch}" --target "${target}" \
  --build-arg "VERSION=${version}" --build-arg "REVISION=${revision}" \
  --build-arg "SOURCE=${source_url}" --build-arg "CREATED=${created}" \
  --build-arg "SBOM_TIME=$(rfc3339 "${epoch}")" \
  "${flags[@]}" "$@" --build-arg "RESEARCH_WEIGHTS=${research_weights}" \
  --tag "${name}:${version}" --tag "${name}:latest" .

bytes="$(podman image inspect --format '{{.Size}}' "${name}:${version}")"
echo "${name}:${version}: $((bytes / 1000000)) MB"
if [[ "${target}" == server ]] && ((bytes > limit_mb * 1000000)); then
  echo "build.sh: the server's image exceeds ${limit_mb} MB" >&2
  exit 1
fi
