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
  local job="job/$1" waits=()
  kubectl --namespace "${namespace}" wait --for=condition=complete --timeout="${limit}" "${job}" &
  waits+=("$!")
  (kubectl --namespace "${namespace}" wait --for=condition=failed --timeout="${limit}" "${job}" &&
    exit 1) &
  waits+=("$!")
  local status=0
  wait -n "${waits[@]}" || status=$?
  kill "${waits[@]}" 2>/dev/null || true
  ((status == 0)) || { echo "run.sh: ${job} failed; kubectl describe ${job} says which shards" >&2 && exit 1; }
}

kubectl apply -k .
wait_for duet-batch
kubectl apply -k merge
wait_for duet-batch-merge
kubectl --namespace "${namespace}" logs job/duet-batch-merge
