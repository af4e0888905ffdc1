#!/usr/bin/env bash
# Runs a batch in the cluster to its end: the shards, then, once every one of them is done, the merge.
#   deploy/kubernetes/batch/run.sh [NAMESPACE]
# Interrupted, the same command goes on: what is applied stays, what is done is found done.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

readonly namespace="${1:-duet}"
readonly limit=168h

# Waits until a job is done; fails as soon as it has failed.
wait_for() {
  local job="job/$1" condition waits=() first="" status=0
  for condition in complete failed; do
    kubectl --namespace "${namespace}" wait "--for=condition=${condition}" --timeout="${limit}" "${job}" &
    waits+=("$!")
  done
  wait -n -p first "${waits[@]}" || status=$?
  # The other one would wait for a week.
  kill "${waits[@]}" 2>/dev/null || true
  wait "${waits[@]}" 2>/dev/null || true
  if [[ "${status}" -ne 0 || "${first}" != "${waits[0]}" ]]; then
    echo "run.sh: ${job} failed; kubectl describe ${job} says which shards" >&2
    exit 1
  fi
}

kubectl apply -k .
wait_for duet-batch
kubectl apply -k merge
wait_for duet-batch-merge
kubectl --namespace "${namespace}" logs job/duet-batch-merge
