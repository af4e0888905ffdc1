#!/usr/bin/env bash
# Copies what the listed packages and their dependencies installed into a folder that becomes an
# image's root: libraries, licences and dpkg's record of them, without shell, package manager or any
# program that may become root. Runs in a stage of the Dockerfile, where the packages are installed.
#   deploy/image/make_root.sh ROOT LIST...      LIST: packages/runtime.txt
set -euo pipefail

readonly root="$1"
shift

# Dependencies of maintainer scripts alone, which have run already.
readonly not_copied=" debconf debconf-2.0 dpkg "

# Prints the installed package behind each dependency of a package: of alternatives the first that
# is there.
dependencies_of() {
  local clause name
  dpkg-query -W -f '${Pre-Depends},${Depends}' "$1" | tr ',' '\n' | while read -r clause; do
    for name in $(tr '|' '\n' <<<"${clause}" | sed -e 's/(.*//' -e 's/:any//' -e 's/ //g'); do
      if dpkg-query -W -f '${db:Status-Status}' "${name}" 2>/dev/null | grep -qx installed; then
        echo "${name}"
        break
      fi
    done
  done
}

# Adds a package and all that it needs to `packages`.
declare -A packages=()
add() {
  local package="$1" dependency
  [[ -z "${packages[${package}]:-}" && "${not_copied}" != *" ${package} "* ]] || return 0
  packages["${package}"]=1
  for dependency in $(dependencies_of "${package}"); do add "${dependency}"; done
}

# The files of a package that the image has use for, one a line.
files_of() {
  local file
  dpkg-query -L "$1" | while read -r file; do
    [[ -f "${file}" || -L "${file}" ]] || continue
    case "${file}" in
      */copyright) echo "${file}" ;;
      /usr/share/* | /usr/bin/* | /usr/sbin/* | /sbin/* | /bin/* | /etc/*) ;;
      *) echo "${file}" ;;
    esac
  done
}

# What scanners read in images without dpkg: a record for each package.
record() {
  dpkg-query -s "$1" >"${root}/var/lib/dpkg/status.d/$1"
}

main() {
  local package
  while read -r package; do add "${package}"; done \
    < <(sed -e 's/#.*//' -e '/^[[:space:]]*$/d' "$@")

  mkdir -p "${root}"/{etc/ssl/certs,tmp,usr/lib,usr/lib64,usr/bin,usr/share/doc} \
    "${root}/var/lib/dpkg/status.d"
  chmod 1777 "${root}/tmp"
  # As on Debian: /lib is /usr/lib.
  ln -s usr/lib "${root}/lib"
  ln -s usr/lib64 "${root}/lib64"
  ln -s usr/bin "${root}/bin"

  local names=()
  mapfile -t names < <(printf '%s\n' "${!packages[@]}" | sort)
  for package in "${names[@]}"; do
    files_of "${package}" | tar --create --files-from=- --file=- 2>/dev/null |
      tar --extract --keep-directory-symlink --directory="${root}"
    record "${package}"
  done

  # Names for the two users that there are; where names are looked up; whom TLS clients believe; the
  # release, which scanners ask for.
  printf 'root:x:0:0:root:/:/nologin\nduet:x:65532:65532:Duet:/:/nologin\n' >"${root}/etc/passwd"
  printf 'root:x:0:\nduet:x:65532:\n' >"${root}/etc/group"
  printf 'hosts: files dns\n' >"${root}/etc/nsswitch.conf"
  cp /etc/ssl/certs/ca-certificates.crt "${root}/etc/ssl/certs/"
  cp -L /etc/os-release "${root}/etc/os-release"
  # The loader's cache for what lies here.
  ldconfig -r "${root}"
  rm -rf "${root}/var/cache"
  echo "make_root: ${#names[@]} packages: ${names[*]}"
}

main "$@"
