#!/usr/bin/env bash
# Prints how many compilations to run in parallel: one for each core, fewer if memory is short. A file that
# includes LibTorch's headers takes 1.2 GB.
#   scripts/build_jobs.sh [SYSTEM_ROOT]      SYSTEM_ROOT: / except in tests
set -euo pipefail

readonly job_kib=$((1200 * 1024))
readonly root="${1:-}"

cores="$(nproc)"
available_kib="$(awk '/^MemAvailable:/ {print $2}' "${root}/proc/meminfo")"
# A container's limit may be below the machine's memory: control groups version 2, then version 1. "max" means
# no limit, and so does version 1's largest number.
for file in memory.max memory/memory.limit_in_bytes; do
  if limit="$(cat "${root}/sys/fs/cgroup/${file}" 2>/dev/null)" && [[ "${limit}" =~ ^[0-9]+$ ]]; then
    limit_kib=$((limit / 1024))
    available_kib=$((limit_kib < available_kib ? limit_kib : available_kib))
  fi
done

jobs=$((available_kib / job_kib))
jobs=$((jobs < cores ? jobs : cores))
echo $((jobs < 1 ? 1 : jobs))
