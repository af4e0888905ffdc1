#!/usr/bin/env bash
# One fold of leave-one-subject-out training, as a task of a job array. submit_training.sh submits it:
#   train_task.sh FOLDS [arguments of duet-train...]
#SBATCH --job-name=duet-train
#SBATCH --requeue
#SBATCH --open-mode=append
# Stops the training before the time limit, so that the task can requeue itself.
#SBATCH --signal=B:TERM@60
#
# After a signal (killed for memory, the time limit) the task runs again and continues with the epoch after the
# last finished one. A training that fails because of its data or arguments does not run again.
#
# Slurm copies only this file to the node, so it repeats code of batch_task.sh (waiting for a process despite
# signals, requeueing).
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

  # BLAS gets as many threads as the task has cores; more would only wait for each other.
  OMP_NUM_THREADS="${SLURM_CPUS_PER_TASK:-1}" duet-train --protocol loso --fold "${fold}" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" "$@" &
  trainer_pid=$!
  wait "${trainer_pid}"
  status=$?
  # A signal can end the wait before the training ends.
  while kill -0 "${trainer_pid}" 2>/dev/null; do
    wait "${trainer_pid}"
    status=$?
  done
  trainer_pid=""

  ((status != 0)) || { say "trained without ${fold}" && exit 0; }
  ((status > 128)) || { say "ended with ${status}; not requeued" && exit "${status}"; }
  ((${SLURM_RESTART_COUNT:-0} < most_restarts)) ||
    { say "restarted ${SLURM_RESTART_COUNT} times; not requeued" && exit "${status}"; }
  say "ended with ${status}; requeued"
  # Slurm ends this script when it requeues the task.
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
  sleep 60
  exit "${status}"
}

main "$@"
