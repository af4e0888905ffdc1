#!/usr/bin/env bash
# Runs a batch in the cluster: the shards and then, when all of them are done, the run that gathers them.
#   deploy/kubernetes/batch/run.sh [NAMESPACE]
# After an interruption, the same command continues: it keeps applied objects and finished jobs.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

readonly namespace="${1:-duet}"
readonly limit=168h

# Waits until a job is done; fails as soon as the job fails.
wait_for() {
  local job="job/$1" condition waits=() first="" status=0
  for condition in complete failed; do
    kubectl --namespace "${namespace}" wait "--for=condition=${condition}" --timeout="${limit}" "${job}" &
    waits+=("$!")
  done
  wait -n -p first "${waits[@]}" || status=$?
  # Otherwise this would wait for a week.
  kill "${waits[@]}" 2>/dev/null || true
  wait "${waits[@]}" 2>/dev/null || true
  if [[ "${status}" -ne 0 || "${first}" != "${waits[0]}" ]]; then
    echo "run.sh: ${job} failed; kubectl describe ${job} lists its shards" >&2
    exit 1
  fi
}

kubectl apply -k .
wait_for duet-batch
kubectl apply -k gather
wait_for duet-batch-gather
kubectl --namespace "${namespace}" logs job/duet-batch-gather
