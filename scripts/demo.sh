#!/usr/bin/env bash
# Starts the server with its embedded models, synthesises reactions to the sample leaders, writes the results
# to out/demo, and always stops the server.
#   scripts/demo.sh build/release/bin
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly bin_dir="$1"
readonly out_dir=out/demo
readonly server_log="${out_dir}/server.log"
readonly start_limit_s=60
readonly stop_limit_s=15

server_pid=""
server_status=0

fail() {
  echo "demo: $*" >&2
  if [[ -s "${server_log}" ]]; then
    echo "demo: the server's last lines (${server_log}):" >&2
    tail -n 20 "${server_log}" >&2
  fi
  exit 1
}

stop_server() {
  [[ -n "${server_pid}" ]] || return 0
  kill -TERM "${server_pid}" 2>/dev/null || true
  local deadline=$((SECONDS + stop_limit_s))
  while kill -0 "${server_pid}" 2>/dev/null && ((SECONDS < deadline)); do
    sleep 0.1
  done
  kill -KILL "${server_pid}" 2>/dev/null || true
  wait "${server_pid}" 2>/dev/null || server_status=$?
  server_pid=""
}

# Sets `address` once the server serves its models. The kernel chooses the port: the default one lies in the range of
# outgoing connections, so another program's connection can occupy it.
start_server() {
  local flags=(--listen 127.0.0.1:0 --metrics-listen off) port="" deadline=$((SECONDS + start_limit_s))
  echo "\$ duet-server ${flags[*]}"
  "${bin_dir}/duet-server" "${flags[@]}" >"${server_log}" 2>&1 &
  server_pid=$!
  until [[ -n "${port}" ]]; do
    kill -0 "${server_pid}" 2>/dev/null || fail "the server exited before it served"
    ((SECONDS < deadline)) || fail "the server did not serve within ${start_limit_s} s"
    sleep 0.1
    port="$(sed -nE 's/.*"event":"serving".*"port":([0-9]+).*/\1/p' "${server_log}")"
  done
  address="127.0.0.1:${port}"
}

# Shows a client command, then runs it.
duet() {
  echo "\$ duet $*"
  "${bin_dir}/duet" "$@" || fail "'duet $*' failed with status $?"
}

# synthesize <name> <leader> <label>...: writes a page with a viewer, and the pair as glTF.
synthesize() {
  local name="$1" leader="$2" labels=() label
  shift 2
  for label in "$@"; do labels+=(--label "${label}"); done
  duet synthesize --server "${address}" --leader "${leader}" "${labels[@]}" \
    --out "${out_dir}/${name}.html" --out "${out_dir}/${name}.glb"
  echo
}

# A handshake by the model of everyday interactions, which is free for all uses.
hands() {
  duet synthesize --server "${address}" --model everyday --leader samples/shake_hands.bvh --label meet_hands=1 \
    --out "${out_dir}/hands.html" --out "${out_dir}/hands.glb"
  echo
}

# A dance of 30 s: the lead of the sample comes, asks for two turns, and leaves.
dance() {
  duet synthesize --server "${address}" --model salsa --leader samples/salsa.bvh --candidates 4 \
    --keyframe 0:apart=1 --keyframe 50:apart=1 --keyframe 60:approach=1 --keyframe 110:approach=1 \
    --keyframe 120:basic=1 --keyframe 270:basic=1 --keyframe 280:follower_turn=1 --keyframe 390:follower_turn=1 \
    --keyframe 400:basic=1 --keyframe 510:basic=1 --keyframe 520:cross_body=1 --keyframe 670:cross_body=1 \
    --keyframe 680:follower_turn=1 --keyframe 790:follower_turn=1 --keyframe 800:apart=1 \
    --out "${out_dir}/dance.html" --out "${out_dir}/dance.glb"
  echo
}

main() {
  rm -rf "${out_dir}"
  mkdir -p "${out_dir}"
  trap stop_server EXIT
  trap 'exit 130' INT TERM

  start_server
  echo
  duet models --server "${address}"
  echo
  hands
  synthesize kick samples/kick.bvh kick=1
  synthesize hug samples/hug.bvh hug=1
  synthesize half_hug_half_push samples/hug.bvh hug=0.5 push=0.5
  dance
  stop_server
  ((server_status == 0)) || fail "the server exited with status ${server_status} on SIGTERM"

  echo "Done in ${SECONDS} s:"
  find "${out_dir}" -name '*.html' -o -name '*.glb' | sort | xargs du -h | sed 's/^/  /'
  echo
  echo "Open a page in any browser (drag to orbit, space to play):"
  find "$(pwd)/${out_dir}" -name '*.html' | sort | sed 's,^,  file://,'
  echo "The studio, and Spar, where you are the leader, are in contrib/studio (README.md). After"
  echo "scripts/install_packages.sh contrib/studio, open http://127.0.0.1:8080 in a browser:"
  echo "  ${bin_dir}/duet-server & DUET_PROGRAM=${bin_dir}/duet contrib/studio/gateway.py"
  echo "Blender, three.js and game engines open the .glb (see docs/formats.md)."
}

address=""
main
