#!/usr/bin/env bash
# Lints the wire contract with buf (proto/buf.yaml). Debian has no buf, so npm installs it once in
# build/tools. Without npm or network, the check is skipped with a message.
#   scripts/check_proto.sh
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly version=1.75.0 tools=build/tools
readonly buf="${tools}/node_modules/.bin/buf"

skip() {
  echo "Proto: SKIPPED, $1; expected npm and its package @bufbuild/buf ${version}."
  exit 0
}

if [[ ! -x "${buf}" ]]; then
  command -v npm >/dev/null || skip "npm is not installed"
  mkdir -p "${tools}"
  npm install --prefix "${tools}" --no-save --no-audit --no-fund --fetch-retries 0 --silent \
    "@bufbuild/buf@${version}" >/dev/null 2>&1 || skip "npm could not install buf"
fi

"${buf}" lint proto
echo "Proto: buf ${version} finds nothing."
