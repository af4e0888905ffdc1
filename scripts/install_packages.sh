#!/usr/bin/env bash
# Installs the missing Debian packages of one or more lists (packages/<list>.txt).
#   scripts/install_packages.sh build test
# Returns quickly if none is missing.
set -euo pipefail

package_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../packages" && pwd)"
readonly package_dir

fail() {
  printf '%s\n' "$@" >&2
  exit 1
}

# Prints the package names of a list, without comments and blank lines.
read_list() {
  sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "${package_dir}/$1.txt"
}

# Prints the arguments that are not installed.
missing_of() {
  local installed
  installed="$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' "$@" 2>/dev/null |
    sed -n 's/^installed //p' || true)"
  comm -23 <(printf '%s\n' "$@" | sort -u) <(sort -u <<<"${installed}")
}

as_root() {
  if [[ "$(id -u)" -eq 0 ]]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "install_packages: not root and no sudo; as root, run:" \
      "  apt-get install --no-install-recommends ${missing[*]}"
  fi
}

apt() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o DPkg::Lock::Timeout=300 \
    -o Dpkg::Use-Pty=0 "$@" >/dev/null
}

install_missing() {
  apt install -y --no-install-recommends "${missing[@]}"
}

main() {
  [[ $# -gt 0 ]] || fail "usage: install_packages.sh <list>..." "lists:" \
    "$(basename -s .txt -a "${package_dir}"/*.txt)"

  local list wanted=()
  for list in "$@"; do
    [[ -f "${package_dir}/${list}.txt" ]] ||
      fail "install_packages: no list '${list}' in ${package_dir}"
    mapfile -t -O "${#wanted[@]}" wanted < <(read_list "${list}")
  done

  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "install_packages: expected a Debian system. Duet is built from Debian 12 packages;" \
      "install the counterparts of these, or use the Dockerfile:" "  ${wanted[*]}"
  fi

  mapfile -t missing < <(missing_of "${wanted[@]}")
  [[ ${#missing[@]} -gt 0 ]] || return 0

  echo "Installing Debian packages: ${missing[*]} (with their dependencies; a minute or two)"
  # Fetches the package index only if it is missing or too old.
  if ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null || ! install_missing; then
    apt update
    install_missing || fail "install_packages: apt-get could not install: ${missing[*]}" \
      "The names are those of Debian 12 (bookworm), component main."
  fi
}

missing=()
main "$@"
