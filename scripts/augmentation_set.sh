#!/usr/bin/env bash
# Makes the synthetic set of the augmentation experiment through the product's own path: a server
# that serves the generator of one half of the data, and the client, once a motion.
#   duet-train --data DATA --out runs --protocol half --seeds 1
#   scripts/augmentation_set.sh build/release/bin runs/half-1 DATA sets/half-1 [--match 25 --mix 25]
#   duet-eval augmentation --data DATA --runs runs --seeds 1 --synthetic sets/half-1
# OUT then holds jobs.tsv, leaders/ and followers/. Given again after a failure, it goes on.
set -euo pipefail

readonly start_limit_s=60
readonly stop_limit_s=15

server_pid=""
address=""

fail() {
  echo "augmentation_set: $*" >&2
  exit 1
}

usage() {
  echo "usage: $0 BIN_FOLDER RUN DATA OUT [flags of duet-eval augmentation]" >&2
  exit 2
}

stop_server() {
  [[ -n "${server_pid}" ]] || return 0
  kill -TERM "${server_pid}" 2>/dev/null || true
  local deadline=$((SECONDS + stop_limit_s))
  while kill -0 "${server_pid}" 2>/dev/null && ((SECONDS < deadline)); do
    sleep 0.1
  done
  kill -KILL "${server_pid}" 2>/dev/null || true
  wait "${server_pid}" 2>/dev/null || true
  server_pid=""
}

# Prints the port that the server's log says it serves at, when it does.
serving_port() {
  sed -n 's/.*"event":"serving".*"port":\([0-9]*\).*/\1/p' "${out}/server.log"
}

start_server() {
  local deadline=$((SECONDS + start_limit_s)) port=""
  "${bin}/duet-server" --listen 127.0.0.1:0 --metrics-listen "" \
    --model-repository "${run}/checkpoint" >"${out}/server.log" 2>&1 &
  server_pid=$!
  until [[ -n "${port}" ]]; do
    if ! kill -0 "${server_pid}" 2>/dev/null || ((SECONDS >= deadline)); then
      tail -n 20 "${out}/server.log" >&2
      fail "the server did not start (${out}/server.log)"
    fi
    sleep 0.1
    port="$(serving_port)"
  done
  address="127.0.0.1:${port}"
}

# synthesize <id> <label;label;...> <direction or ->
synthesize() {
  local id="$1" flags=() label
  local -a labels
  IFS=';' read -ra labels <<<"$2"
  for label in "${labels[@]}"; do flags+=(--label "${label}"); done
  [[ "$3" == - ]] || flags+=("--partner-direction=$3")
  "${bin}/duet" synthesize --server "${address}" --priority bulk --quiet "${flags[@]}" \
    --leader "${out}/leaders/${id}.json" --out "${out}/followers/${id}.json" </dev/null ||
    fail "'duet synthesize' of ${id} failed with status $?"
}

make_followers() {
  local id class labels partner count=0
  while IFS=$'\t' read -r id class _ labels partner; do
    if [[ "${id}" == id && "${class}" == class ]]; then continue; fi # the header
    if [[ ! -e "${out}/followers/${id}.json" ]]; then
      synthesize "${id}" "${labels}" "${partner}"
    fi
    count=$((count + 1))
  done <"${out}/jobs.tsv"
  echo "${count} followers in ${out}/followers, ${SECONDS} s"
}

(($# >= 4)) || usage
readonly bin="$1" run="${2%/}" data="$3" out="${4%/}"
shift 4
seed="${run##*/half-}"
[[ "${seed}" =~ ^[0-9]+$ ]] || fail "RUN: '${run}' came, wanted a folder half-<seed> of duet-train --protocol half"
[[ -d "${run}/checkpoint" ]] || fail "RUN: ${run} has no checkpoint, wanted a finished run"

"${bin}/duet-eval" augmentation --data "${data}" --seeds "${seed}" --write-jobs "${out}" "$@"
trap stop_server EXIT
trap 'exit 130' INT TERM
start_server
make_followers
