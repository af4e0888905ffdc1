#!/usr/bin/env bash
# Tries this commit on another Debian or Ubuntu release: makes the release's root with debootstrap below
# build/roots, clones the repository into it, and runs a command there. Run it as root.
#   scripts/try_release.sh trixie demo          make demo
#   scripts/try_release.sh trixie test          make test
#   scripts/try_release.sh trixie image-root    collects the image's root, and runs both programs in it (after demo)
#   scripts/try_release.sh trixie lists         checks that its archive has the packages of every list
#   scripts/try_release.sh bookworm packages    installs build/release/packages, runs their demo, and removes them
#   scripts/try_release.sh noble COMMAND...     any other command, in the clone
# --again before the release keeps the clone's build folder from an earlier run. KEYRING, a file, replaces the
# release's archive keys, and MIRROR the address of its archive: by default the one that this machine's
# apt uses for the same distribution, else debootstrap's. DUET_TRAINING, JOBS and CI are passed on. `packages` has a
# root of its own. Remove a root with `rm -rf --one-file-system`.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly roots=build/roots
readonly source_folder=/src/duet

fail() {
  printf 'try_release: %s\n' "$*" >&2
  exit 1
}

# Prints the vendor whose archive has a release.
vendor_of() {
  case "$1" in
    bookworm | trixie | forky | sid) echo Debian ;;
    *) echo Ubuntu ;;
  esac
}

# Prints the archive of a vendor that this machine's apt uses; nothing if it uses none.
configured_mirror() {
  # shellcheck disable=SC2016  # apt expands these
  apt-get indextargets --format '$(ORIGIN) $(LABEL) $(REPO_URI)' 'Created-By: Packages' |
    sed -n "s/^$1 $1 //p" | head -n 1
}

# Prints the archive that debootstrap's script names first for releases that are not old.
default_mirror() {
  sed -n 's/^[[:space:]]*default_mirror //p' "$1" | grep -v //old | head -n 1
}

make_root() {
  command -v debootstrap >/dev/null || fail "expected debootstrap, got none; install it"
  local release="$1" root="$2" vendor mirror script flags=(--variant=minbase)
  vendor="$(vendor_of "${release}")"
  mirror="${MIRROR:-$(configured_mirror "${vendor}")}"
  # What its scripts for all newer releases of a vendor are; it may not know the newest names.
  script=/usr/share/debootstrap/scripts/sid
  if [[ "${vendor}" == Ubuntu ]]; then
    script=/usr/share/debootstrap/scripts/gutsy
    flags+=("--components=main,universe")
  fi
  [[ -z "${KEYRING:-}" ]] || flags+=("--keyring=${KEYRING}")
  echo "== ${release}: making its root in ${root}"
  mkdir -p "${roots}" && rm -rf --one-file-system "${root}.new"
  # debootstrap leaves mounts behind.
  unshare --mount debootstrap "${flags[@]}" "${release}" "${root}.new" "${mirror:-$(default_mirror "${script}")}" \
    "${script}" >"${root}.log" ||
    fail "debootstrap failed; ${root}.log has its output"
  mv "${root}.new" "${root}"
}

# Brings this commit into the root; with "again", the clone keeps what git ignores: its build folder.
clone() {
  local root="$1" again="$2" target="$1${source_folder}"
  if [[ "${again}" == yes && -d "${target}/.git" ]]; then
    git -C "${target}" fetch --quiet "$(pwd)" HEAD
    git -C "${target}" reset --quiet --hard FETCH_HEAD
    git -C "${target}" clean --quiet -ffd
  else
    rm -rf --one-file-system "${target}"
    git clone --quiet --no-hardlinks . "${target}"
  fi
}

# Runs a command in the clone, with mounts and processes that end with it.
in_root() {
  local root="$1"
  shift
  # shellcheck disable=SC2016  # the inner shells expand these
  unshare --mount --pid --fork bash -c '
    mount --make-rprivate / && root="$1" && shift
    mount -t proc proc "${root}/proc" && mount -t sysfs -o ro sysfs "${root}/sys" || exit
    mount --rbind /dev "${root}/dev" || exit  # with /dev/pts and /dev/shm
    mkdir -p "${root}/tmp" && chmod 1777 "${root}/tmp"
    exec chroot "${root}" env -i HOME=/root LANG=C.UTF-8 PATH=/usr/sbin:/usr/bin:/sbin:/bin \
      ${DUET_TRAINING:+"DUET_TRAINING=${DUET_TRAINING}"} ${JOBS:+"JOBS=${JOBS}"} ${CI:+"CI=${CI}"} \
      bash -c "cd \"\$0\" && exec \"\$@\"" "'"${source_folder}"'" "$@"' _ "${root}" "$@"
}

# What the image's stages do, without a container.
# shellcheck disable=SC2016  # the inner shell expands these
readonly image_root='
  set -euo pipefail
  scripts/install_packages.sh runtime image_root
  rm -rf /image && mapfile -t packages < <(scripts/install_packages.sh --print runtime)
  deploy/image/make_root.sh /image "${packages[@]}"
  deploy/image/write_sbom.py --version 0 --created 1970-01-01T00:00:00Z /image >/image/sbom.json
  for program in duet-server duet; do
    strip -o "/image/usr/bin/${program}" "build/release/bin/${program}"
    chroot /image "/usr/bin/${program}" --version
  done
  du -sh /image'

# Of all lists together: a release must have them all.
# shellcheck disable=SC2016  # the inner shell expands these
readonly lists='
  set -euo pipefail
  apt-get -qq update
  mapfile -t names < <(basename -s .txt -a packages/*.txt; find contrib -name packages.txt -printf "%h\n")
  scripts/install_packages.sh --try "${names[@]}"'

# What a user does with the Debian packages. Fails if removing them leaves a package or a file.
# shellcheck disable=SC2016  # the inner shell expands these
readonly packages='
  set -euo pipefail
  export DEBIAN_FRONTEND=noninteractive
  list() { dpkg-query -W -f "\${Package}\n" | sort; }
  before="$(list)"
  apt-get -qq install -y --no-install-recommends /packages/*.deb >/dev/null
  dpkg-query -W -f "\${Package} \${Version}\n" "duet*" libduet-dev
  scripts/demo.sh /usr/bin
  duet-train --version
  mapfile -t installed < <(for file in /packages/*.deb; do dpkg-deb -f "${file}" Package; done)
  apt-get -qq purge -y --autoremove "${installed[@]}" >/dev/null
  diff <(echo "${before}") <(list) || { echo "removing the packages left or took others" >&2 && exit 1; }
  left="$(find / -xdev -iname "*duet*" -not -path "/src/*" -not -path "/packages/*" -not -path "/proc/*")"
  [[ -z "${left}" ]] || { printf "removing the packages left:\n%s\n" "${left}" >&2 && exit 1; }
  echo "installed, ran and removed: ${installed[*]}"'

main() {
  local again=no release root shown
  [[ "${1:-}" != --again ]] || { again=yes && shift; }
  [[ $# -ge 2 ]] || fail "usage: try_release.sh [--again] RELEASE demo|test|image-root|lists|packages|COMMAND..."
  [[ "$(id -u)" -eq 0 ]] || fail "expected root, which debootstrap and chroot need"
  release="$1" root="${roots}/$1"
  shift
  # The packages are tried where nothing is installed that only a build needs.
  [[ "$1" != packages ]] || root+=.packages
  shown="$*"
  [[ -d "${root}" ]] || make_root "${release}" "${root}"
  case "$1" in
    demo | test) set -- make "$1" ;;
    image-root) again=yes && set -- bash -c "${image_root}" ;;
    lists) set -- bash -c "${lists}" ;;
    packages)
      rm -rf "${root}/packages" && mkdir -p "${root}/packages"
      cp build/release/packages/*.deb "${root}/packages" || fail "expected packages, got none; run cpack -G DEB"
      set -- bash -c "${packages}"
      ;;
  esac
  mkdir -p "${root}${source_folder}"
  [[ -x "${root}/usr/bin/make" && -x "${root}/usr/bin/git" ]] ||
    in_root "${root}" apt-get -qq install -y --no-install-recommends make git >/dev/null
  clone "${root}" "${again}"
  echo "== ${release}: $(git rev-parse --short HEAD): ${shown}"
  in_root "${root}" "$@"
}

main "$@"; exit
