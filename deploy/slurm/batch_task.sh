#!/usr/bin/env bash
# One shard of a `duet batch`, as a task of a job array: starts a server on the task's own cores, has it
# answer the shard's items, drains it. submit_batch.sh submits it with the words of `duet batch`.
#SBATCH --job-name=duet-batch
#SBATCH --requeue
#SBATCH --open-mode=append
# Before the time limit the client is told to stop, so that its calls end and the task can go on later.
#SBATCH --signal=B:TERM@60
#
# Exit codes of `duet batch`: 0, the shard is settled; 1, worth running again, which this task asks for;
# 2 and 42, it is not. A task that is killed, or whose node is lost, goes on from the shard's journal.
#
# Slurm copies this file alone to the node, so that what it has in common with train_task.sh (waiting behind a
# signal, asking to be run again) stands in both.
set -uo pipefail

readonly most_restarts=20

server_pid="" client_pid="" scratch=""

say() {
  printf '%s %s: %s\n' "$(date --utc +%FT%TZ)" "task ${SLURM_ARRAY_TASK_ID}" "$*" >&2
}

# SIGTERM drains a server: calls end, then it does.
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

# Prints the port of the server once it serves; fails where it ended before.
port_of_server() {
  local log="$1" port=""
  while kill -0 "${server_pid}" 2>/dev/null; do
    port="$(sed -n 's/.*"event":"serving".*"port":\([0-9]*\),.*/\1/p' "${log}")"
    [[ -z "${port}" ]] || { echo "${port}" && return 0; }
    sleep 0.1
  done
  return 1
}

# Runs the task again, from its journal, unless it has been so often already that something is wrong.
requeue_or_fail() {
  local status="$1"
  if ((${SLURM_RESTART_COUNT:-0} >= most_restarts)); then
    say "restarted ${SLURM_RESTART_COUNT} times: given up"
    exit "${status}"
  fi
  say "ended with ${status}: asks to be run again"
  clean_up
  # Slurm ends this script as it requeues the task.
  scontrol requeue "${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}"
  sleep 60
  exit "${status}"
}

main() {
  scratch="$(mktemp -d)"
  trap clean_up EXIT
  trap '[[ -z "${client_pid}" ]] || kill -TERM "${client_pid}" 2>/dev/null' TERM

  # Any free port: tasks share nodes. The loopback alone: nobody else is meant. As many workers as the
  # task has cores, whether Slurm binds tasks to cores or not.
  : >"${scratch}/server.log"
  duet-server --listen 127.0.0.1:0 --metrics-listen off --workers "${SLURM_CPUS_PER_TASK:-1}" \
    2>>"${scratch}/server.log" &
  server_pid=$!
  local port status
  port="$(port_of_server "${scratch}/server.log")" ||
    { tail -n 5 "${scratch}/server.log" >&2 && requeue_or_fail 1; }

  # The shard is told by the array's index and count (SLURM_ARRAY_TASK_ID, SLURM_ARRAY_TASK_COUNT).
  duet batch "$@" --server "127.0.0.1:${port}" --patience 10 &
  client_pid=$!
  wait "${client_pid}"
  status=$?
  # A wait that a signal ended is no end of the client.
  while kill -0 "${client_pid}" 2>/dev/null; do
    wait "${client_pid}"
    status=$?
  done
  client_pid=""
  case "${status}" in
    0) say "settled" ;;
    2 | 42) say "ended with ${status}: not worth running again" && exit "${status}" ;;
    *) requeue_or_fail "${status}" ;;
  esac
}

main "$@"
