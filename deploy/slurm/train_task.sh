#!/usr/bin/env bash
# One fold of a training that leaves one subject out, as a task of a job array: trains without one
# subject. submit_training.sh submits it:
#   train_task.sh FOLDS [words of duet-train...]
#SBATCH --job-name=duet-train
#SBATCH --requeue
#SBATCH --open-mode=append
# Before the time limit training is ended, so that the task asks to be run again.
#SBATCH --signal=B:TERM@60
#
# A training that a signal ended (killed for memory, the time limit) is worth running again and goes on
# with the epoch after the last finished one; one that ended by itself, of its data or its words, is not.
#
# Slurm copies this file alone to the node, so that what it has in common with batch_task.sh (waiting behind a
# signal, asking to be run again) stands in both.
set -uo pipefail

readonly most_restarts=20

trainer_pid=""

say() {
  printf '%s %s: %s\n' "$(date --utc +%FT%TZ)" "task ${SLURM_ARRAY_TASK_ID}" "$*" >&2
}

main() {
  local status folds fold
  read -ra folds <<<"$1"
  shift
  fold="${folds[${SLURM_ARRAY_TASK_ID}]}"
  trap '[[ -z "${trainer_pid}" ]] || kill -TERM "${trainer_pid}" 2>/dev/null' TERM

  # BLAS has the task's cores; more threads than those only wait for one another.
  OMP_NUM_THREADS="${SLURM_CPUS_PER_TASK:-1}" duet-train --protocol loso --fold "${fold}" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" "$@" &
  trainer_pid=$!
  wait "${trainer_pid}"
  status=$?
  # A wait that a signal ended is no end of the training.
  while kill -0 "${trainer_pid}" 2>/dev/null; do
    wait "${trainer_pid}"
    status=$?
  done
  trainer_pid=""

  ((status != 0)) || { say "trained without ${fold}" && exit 0; }
  ((status > 128)) || { say "ended with ${status}: not worth running again" && exit "${status}"; }
  ((${SLURM_RESTART_COUNT:-0} < most_restarts)) ||
    { say "restarted ${SLURM_RESTART_COUNT} times: given up" && exit "${status}"; }
  say "ended with ${status}: asks to be run again"
  # Slurm ends this script as it requeues the task.
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
  sleep 60
  exit "${status}"
}

main "$@"
