#!/usr/bin/env bash
# Generates the Python package's stubs from the proto files. Run it after a change to a proto file.
#   scripts/python_stubs.sh           rewrites client/python/duet_motion/{v1,rpc/v1}
#   scripts/python_stubs.sh FOLDER    writes them below FOLDER instead
# Uses protoc with gRPC's plugin: Debian 12's grpc_tools is from 2018 and does not support `optional`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

out="${1:-client/python}"
plugin="$(command -v grpc_python_plugin)" || {
  echo "python_stubs.sh: expected grpc_python_plugin, got none; install the package protobuf-compiler-grpc" >&2
  exit 1
}

made="$(mktemp -d)"
trap 'rm -rf "${made}"' EXIT
messages=(duet/v1/motion.proto duet/v1/model.proto duet/v1/reaction.proto duet/v1/live.proto
  duet/v1/synthesis.proto duet/rpc/v1/status.proto)
protoc -Iproto --python_out="${made}" --pyi_out="${made}" "${messages[@]}"
protoc -Iproto --grpc_python_out="${made}" --plugin=protoc-gen-grpc_python="${plugin}" \
  duet/v1/synthesis.proto

# protoc derives Python's module names from the protos' folder, but another library is named `duet`.
for stub in "${made}"/duet/*v1/*_pb2* "${made}"/duet/rpc/v1/*_pb2*; do
  target="${out}/duet_motion/${stub#"${made}/duet/"}"
  mkdir -p "$(dirname "${target}")"
  sed -E 's/^from duet\.(v1|rpc\.v1) import/from duet_motion.\1 import/' "${stub}" >"${target}"
done
