#!/usr/bin/env bash
# One fold of a training that leaves one subject out, as a task of a job array: trains without one
# subject. A task that is killed or stopped goes on from the fold's last state.
#   submit_training.sh submits it: train_task.sh FOLDS [words of duet-train...]
#SBATCH --job-name=duet-train
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

read -ra folds <<<"$1"
shift
# BLAS has the task's cores; more threads than those only wait for one another.
export OMP_NUM_THREADS="${SLURM_CPUS_PER_TASK:-1}"
exec duet-train --protocol loso --fold "${folds[${SLURM_ARRAY_TASK_ID}]}" \
  --threads "${SLURM_CPUS_PER_TASK:-1}" "$@"
