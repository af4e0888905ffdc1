#!/usr/bin/env bash
# Runs every check, one after the other, whatever fails; ends with a table, and fails if one did.
# `make test` runs those that are quick; here are all.
#   scripts/check.sh [NAME...]     only these: the first words of the table
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit

# Name, then the command. Quick ones first.
readonly checks=(
  "shell scripts/check_shell.sh"
  "format scripts/format.sh --check"
  "self-tests scripts/self_test.sh"
  "layers scripts/check_layers.py"
  "docs scripts/check_docs.py"
  "proto scripts/check_proto.sh"
  "links scripts/check_links.py"
  "headers scripts/check_headers.py"
  "thread-safety scripts/check_thread_safety.py"
  "tidy scripts/lint.sh"
  "tsan scripts/check_tsan.sh"
  "asan scripts/check_asan.sh"
  "wire scripts/fuzz_wire.sh"
)

# Whether a check is one of those that were asked for.
wanted() {
  local name="$1" asked
  shift
  [[ $# -eq 0 ]] && return 0
  for asked in "$@"; do
    [[ "${asked}" == "${name}" ]] && return 0
  done
  return 1
}

cmake --preset release -DDUET_BUILD_TESTS=ON -DDUET_BUILD_BENCHMARKS=ON >/dev/null || exit 1

table="" failed=0
for check in "${checks[@]}"; do
  read -ra words <<<"${check}"
  wanted "${words[0]}" "$@" || continue
  echo "== ${words[0]}: ${words[*]:1}"
  start="${SECONDS}" result=ok
  "${words[@]:1}" || { result=FAILED && failed=1; }
  table+="$(printf '%-14s %-7s %4d s' "${words[0]}" "${result}" "$((SECONDS - start))")"$'\n'
done
printf '\n%s' "${table}"
[[ -n "${table}" ]] || { echo "check.sh: no check of that name" >&2 && exit 2; }
exit "${failed}"
