#!/usr/bin/env bash
# Copies the installed files of the listed packages and their dependencies to a folder that becomes an
# image's root: libraries, licences and dpkg's records, without shell, package manager or setuid programs.
# Runs in a stage of the Dockerfile in which the packages are installed.
#   deploy/image/make_root.sh ROOT PACKAGE...     the packages of packages/runtime.txt in this release
set -euo pipefail

readonly root="$1"
shift

# Dependencies only of maintainer scripts, which have already run.
readonly not_copied=" debconf debconf-2.0 dpkg "

# Prints the installed package of a name, which may be a virtual one that a package provides; nothing if there is
# none.
installed_as() {
  if [[ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" == installed ]]; then
    echo "$1"
  else
    awk -F '|' -v name="$1" '
      { count = split($2, provided, /, */) }
      { for (i = 1; i <= count; ++i) { sub(/ .*/, "", provided[i]); if (provided[i] == name) { print $1; exit } } }
    ' <<<"${providers}"
  fi
}

# Prints the installed package for each dependency of a package: of alternatives, the first that is
# installed.
dependencies_of() {
  local clause name found
  dpkg-query -W -f '${Pre-Depends},${Depends}' "$1" | tr ',' '\n' | while read -r clause; do
    for name in $(tr '|' '\n' <<<"${clause}" | sed -e 's/(.*//' -e 's/:any//' -e 's/ //g'); do
      found="$(installed_as "${name}")"
      if [[ -n "${found}" ]]; then
        echo "${found}"
        break
      fi
    done
  done
}

# "package|names that it provides" for each package that provides any.
providers="$(dpkg-query -W -f '${db:Status-Status} ${Package}|${Provides}\n' | sed -n '/|./s/^installed //p')"
readonly providers

# Adds a package and its dependencies to `packages`.
declare -A packages=()
add() {
  local package="$1" dependency
  [[ -z "${packages[${package}]:-}" && "${not_copied}" != *" ${package} "* ]] || return 0
  packages["${package}"]=1
  for dependency in $(dependencies_of "${package}"); do add "${dependency}"; done
}

# Prints the files of a package that the image needs, one in each line.
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

# Scanners read these records in images without dpkg, one for each package.
record() {
  dpkg-query -s "$1" >"${root}/var/lib/dpkg/status.d/$1"
}

main() {
  local package
  for package in "$@"; do add "${package}"; done

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

  # The names of the two users; the order of name lookup; the trusted certificate authorities; the release,
  # which scanners need.
  printf 'root:x:0:0:root:/:/nologin\nduet:x:65532:65532:Duet:/:/nologin\n' >"${root}/etc/passwd"
  printf 'root:x:0:\nduet:x:65532:\n' >"${root}/etc/group"
  printf 'hosts: files dns\n' >"${root}/etc/nsswitch.conf"
  cp /etc/ssl/certs/ca-certificates.crt "${root}/etc/ssl/certs/"
  cp -L /etc/os-release "${root}/etc/os-release"
  # The loader's cache for these libraries.
  ldconfig -r "${root}"
  rm -rf "${root}/var/cache"
  echo "make_root: ${#names[@]} packages: ${names[*]}"
}

main "$@"
