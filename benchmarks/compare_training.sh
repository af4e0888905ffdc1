#!/usr/bin/env bash
# Compares the training throughput of Duet and of eager PyTorch: compare_training.sh [build folder].
# Needs python3-torch.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build_dir="${1:-build/release}"

for threads in 1 2; do
  export OMP_NUM_THREADS="${threads}"
  "${build_dir}/benchmarks/training_benchmark" --benchmark_filter="/${threads}/" \
    --benchmark_min_time=3 2>/dev/null | grep BM_
  /usr/bin/python3 benchmarks/training_eager.py "${threads}" 12
done
