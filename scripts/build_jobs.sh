#!/usr/bin/env bash
# Prints how many compilations to run at once: one a core, fewer where memory would not last. A file
# that includes LibTorch's headers takes 1.2 GB.
set -euo pipefail

readonly job_kib=$((1200 * 1024))

cores="$(nproc)"
available_kib="$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)"
# A container may hold less than the machine.
if limit="$(cat /sys/fs/cgroup/memory.max 2>/dev/null)" && [[ "${limit}" =~ ^[0-9]+$ ]]; then
  limit_kib=$((limit / 1024))
  available_kib=$((limit_kib < available_kib ? limit_kib : available_kib))
fi

jobs=$((available_kib / job_kib))
jobs=$((jobs < cores ? jobs : cores))
echo $((jobs < 1 ? 1 : jobs))
