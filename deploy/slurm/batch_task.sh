#!/usr/bin/env bash
# One shard of a `duet batch`, as a task of a job array, or as a job of its own the run that gathers the shards:
# starts a server on the task's own cores, runs the items on it, and drains it. submit_batch.sh submits it with the
# arguments of `duet batch`.
#SBATCH --job-name=duet-batch
#SBATCH --requeue
#SBATCH --open-mode=append
# Stops the client before the time limit, so that its calls end and the task can continue later.
#SBATCH --signal=B:TERM@60
#
# Exit codes of `duet batch`: 0, the shard is settled; 1, the task requeues itself; 2 and 42, it fails permanently.
# A task that is killed, or whose node is lost, continues from the shard's journal.
#
# Slurm copies only this file to the node, so it repeats code of train_task.sh (waiting for a process despite
# signals, requeueing).
set -uo pipefail

readonly most_restarts=20

server_pid="" client_pid="" scratch=""

say() {
  printf '%s %s: %s\n' "$(date --utc +%FT%TZ)" "task ${SLURM_ARRAY_TASK_ID:-gather}" "$*" >&2
}

# SIGTERM drains the server: it exits after its calls have ended.
stop_server() {
  [[ -n "${server_pid}" ]] || return 0
  kill -TERM "${server_pid}" 2>/dev/null
  wait "${server_pid}" 2>/dev/null
  server_pid=""
}

clean_up() {
  [[ -n "${client_pid}" ]] && kill -TERM "${client_pid}" 2>/dev/null && wait "${client_pid}"
  stop_server
  rm -rf "${scratch}"
}

# Prints the port of the server when it serves; fails if the server exits before.
port_of_server() {
  local log="$1" port=""
  while kill -0 "${server_pid}" 2>/dev/null; do
    port="$(sed -n 's/.*"event":"serving".*"port":\([0-9]*\),.*/\1/p' "${log}")"
    [[ -z "${port}" ]] || { echo "${port}" && return 0; }
    sleep 0.1
  done
  return 1
}

# Runs the task again, from its journal, unless it has already run too often.
requeue_or_fail() {
  local status="$1"
  if ((${SLURM_RESTART_COUNT:-0} >= most_restarts)); then
    say "restarted ${SLURM_RESTART_COUNT} times; not requeued"
    exit "${status}"
  fi
  say "ended with ${status}; requeued"
  clean_up
  # Slurm ends this script when it requeues the task.
  scontrol requeue "${SLURM_ARRAY_JOB_ID:-${SLURM_JOB_ID}}${SLURM_ARRAY_TASK_ID:+_${SLURM_ARRAY_TASK_ID}}"
  sleep 60
  exit "${status}"
}

main() {
  scratch="$(mktemp -d)"
  trap clean_up EXIT
  trap '[[ -z "${client_pid}" ]] || kill -TERM "${client_pid}" 2>/dev/null' TERM

  # Any free port, because tasks share nodes; only the loopback, because only this task calls the server. As many
  # workers as the task has cores, even if Slurm does not bind tasks to cores.
  : >"${scratch}/server.log"
  duet-server --listen 127.0.0.1:0 --metrics-listen off --workers "${SLURM_CPUS_PER_TASK:-1}" \
    2>>"${scratch}/server.log" &
  server_pid=$!
  local port status
  port="$(port_of_server "${scratch}/server.log")" ||
    { tail -n 5 "${scratch}/server.log" >&2 && requeue_or_fail 1; }

  local shard=()
  if [[ -n "${SLURM_ARRAY_TASK_ID:-}" ]]; then
    shard=(--shard "${SLURM_ARRAY_TASK_ID}/${SLURM_ARRAY_TASK_COUNT}")
  fi
  duet batch "$@" "${shard[@]}" --server "127.0.0.1:${port}" --patience 10 &
  client_pid=$!
  wait "${client_pid}"
  status=$?
  # A signal can end the wait before the client ends.
  while kill -0 "${client_pid}" 2>/dev/null; do
    wait "${client_pid}"
    status=$?
  done
  client_pid=""
  case "${status}" in
    0) say "settled" ;;
    2 | 42) say "ended with ${status}; not requeued" && exit "${status}" ;;
    *) requeue_or_fail "${status}" ;;
  esac
}

main "$@"
