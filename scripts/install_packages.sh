#!/usr/bin/env bash
# Installs the missing packages of one or more lists (packages/<list>.txt; of a folder of contrib, its packages.txt), which
# have the names of Debian 12; packages/releases.tsv has the names in other releases.
#   scripts/install_packages.sh build test contrib/studio
#   scripts/install_packages.sh --print runtime     prints the names in this release; installs nothing
#   scripts/install_packages.sh --lacks training    succeeds if this release lacks a package of the lists
#   scripts/install_packages.sh --try build test    fails if apt-get could not install the lists; installs nothing
# Returns quickly if none is missing. OS_RELEASE (default /etc/os-release) names the release.
set -euo pipefail

package_dir="$(cd "$(dirname "${BASH_SOURCE[0]}")/../packages" && pwd)"
readonly package_dir

fail() {
  printf '%s\n' "$@" >&2
  exit 1
}

# Prints the code name of this release, such as bookworm.
code_name() {
  sed -n 's/^VERSION_CODENAME=//p' "${OS_RELEASE:-/etc/os-release}" 2>/dev/null | tr -d '"'
}

# Prints the package names of a list in Debian 12, without comments and blank lines.
read_list() {
  local file="${package_dir}/$1.txt"
  [[ "$1" != contrib/* ]] || file="${package_dir}/../$1/packages.txt"
  [[ -f "${file}" ]] || fail "install_packages: no list '$1' in ${package_dir}"
  sed -e 's/#.*//' -e 's/[[:space:]]//g' -e '/^$/d' "${file}"
}

# Replaces names of Debian 12 by those of this release; "-" replaces a package that it does not have. Of an
# unknown release, the names stay.
translate() {
  awk -F '\t' -v release="$(code_name)" '
    NR == FNR && (/^#/ || NF == 0) { next }
    NR == FNR && !column { for (column = NF; column > 1 && $column != release; ) --column; next }
    NR == FNR { name[$1] = $column; next }
    { print ($1 in name) ? name[$1] : $1 }' "${package_dir}/releases.tsv" -
}

# Prints the names of all packages of some lists in this release.
names_of() {
  local list
  for list in "$@"; do read_list "${list}"; done | translate
}

# Prints the releases of the table, as "bookworm, trixie".
known_releases() {
  sed -n '/^[^#]/{s/\t/, /g;p;q}' "${package_dir}/releases.tsv"
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

# Lets apt-get plan an installation of all wanted packages, which finds names that the archive lacks and conflicts.
try_install() {
  apt-get -qq --simulate install --no-install-recommends "${wanted[@]}" >/dev/null ||
    fail "install_packages: expected packages of $(code_name)'s archive, got those above;" \
      "correct packages/*.txt or packages/releases.tsv"
  echo "${#wanted[@]} packages of $(code_name) can be installed: $*"
}

install_missing() {
  apt install -y --no-install-recommends "${missing[@]}"
}

main() {
  local mode=install
  case "${1:-}" in --print | --lacks | --try) mode="${1#--}" && shift ;; esac
  [[ $# -gt 0 ]] || fail "usage: install_packages.sh [--print|--lacks|--try] <list>..." "lists:" \
    "$(basename -s .txt -a "${package_dir}"/*.txt)"

  local names wanted=()
  names="$(names_of "$@")"
  case "${mode}" in
    lacks) grep -qx -e - <<<"${names}" && exit 0 || exit 1 ;;
    print) { grep -vx -e - <<<"${names}" || true; } && exit 0 ;;
  esac
  mapfile -t wanted < <(grep -vx -e - <<<"${names}")

  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    fail "install_packages: expected Debian or Ubuntu. Duet is built from their packages;" \
      "install the counterparts of these, or use the Dockerfile:" "  ${wanted[*]}"
  fi

  [[ "${mode}" != try ]] || { try_install "$@" && exit; }

  mapfile -t missing < <(missing_of "${wanted[@]}")
  [[ ${#missing[@]} -gt 0 ]] || return 0

  echo "Installing packages: ${missing[*]} (with their dependencies; a minute or two)"
  # Fetches the package index only if it is missing or too old.
  if ! compgen -G '/var/lib/apt/lists/*_Packages*' >/dev/null || ! install_missing; then
    apt update
    install_missing || fail "install_packages: apt-get could not install: ${missing[*]}" \
      "packages/releases.tsv knows $(known_releases), got $(code_name). Ubuntu needs the component universe."
  fi
}

missing=()
main "$@"
