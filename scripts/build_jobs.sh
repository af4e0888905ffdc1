#!/usr/bin/env bash
# Prints how many compilations to run at once: one a core, fewer where memory would not last. A file
# that includes LibTorch's headers takes 1.2 GB.
#   scripts/build_jobs.sh [SYSTEM_ROOT]      SYSTEM_ROOT: / but in tests
set -euo pipefail

readonly job_kib=$((1200 * 1024))
readonly root="${1:-}"

cores="$(nproc)"
available_kib="$(awk '/^MemAvailable:/ {print $2}' "${root}/proc/meminfo")"
# A container may hold less than the machine: version 2's limit, then version 1's. "max" is none, and
# so is version 1's largest number.
for file in memory.max memory/memory.limit_in_bytes; do
  if limit="$(cat "${root}/sys/fs/cgroup/${file}" 2>/dev/null)" && [[ "${limit}" =~ ^[0-9]+$ ]]; then
    limit_kib=$((limit / 1024))
    available_kib=$((limit_kib < available_kib ? limit_kib : available_kib))
  fi
done

jobs=$((available_kib / job_kib))
jobs=$((jobs < cores ? jobs : cores))
echo $((jobs < 1 ? 1 : jobs))
