#!/usr/bin/env bash
# Checks that the programs have the protections of cmake/DuetHardening.cmake: position-independent code,
# relocations that are read-only before main() starts, a non-executable stack, stack protectors,
# fortified functions and the C++ library's assertions.
#   scripts/check_hardening.sh build/release/bin [PROGRAM...]     PROGRAM: duet* if absent
set -euo pipefail

readonly bin_dir="$1"
shift
if [[ $# -eq 0 ]]; then
  mapfile -t names < <(cd "${bin_dir}" && printf '%s\n' duet*)
  set -- "${names[@]}"
fi

failed=0
# Reports a program if its text does not match an expression.
expect() {
  local program="$1" what="$2" text="$3" pattern="$4"
  grep -qE "${pattern}" <<<"${text}" && return
  echo "${program}: expected ${what}" >&2
  failed=1
}

for program in "$@"; do
  file="${bin_dir}/${program}"
  headers="$(readelf --wide --file-header --program-headers --dynamic "${file}")"
  symbols="$(readelf --wide --dyn-syms "${file}" | awk '{print $8}')"
  expect "${program}" "a position-independent executable (PIE)" "${headers}" '^ *Type: +DYN'
  expect "${program}" "relocations that become read-only (RELRO)" "${headers}" '^ *GNU_RELRO'
  expect "${program}" "symbols bound at the start (BIND_NOW)" "${headers}" 'BIND_NOW|FLAGS_1.* NOW'
  expect "${program}" "a stack that is not executable" "${headers}" '^ *GNU_STACK .* RW +0x'
  expect "${program}" "stack protectors (-fstack-protector-strong)" "${symbols}" '^__stack_chk_fail'
  # A program may call nothing that is always fortified. vsnprintf does not count: std::to_string takes its address.
  if grep -qE '^(v?sprintf|snprintf|v?f?printf|strcpy|strcat)(@|$)' <<<"${symbols}"; then
    expect "${program}" "fortified functions (_FORTIFY_SOURCE)" "${symbols}" '^__[a-z]+_chk(@|$)'
  fi
  expect "${program}" "the C++ library's assertions (_GLIBCXX_ASSERTIONS)" "${symbols}" \
    '^_ZSt21__glibcxx_assert_fail'
done
[[ "${failed}" -eq 0 ]] && echo "$# programs are hardened: $*."
exit "${failed}"
