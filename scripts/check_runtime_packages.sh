#!/usr/bin/env bash
# Checks that packages/runtime.txt holds exactly the packages whose libraries the programs load by
# name, and that none of them is LibTorch.
#   scripts/check_runtime_packages.sh build/release/bin
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# The list names the packages of the release that the image is made from.
if ! grep -qx 'VERSION_CODENAME=bookworm' /etc/os-release; then
  echo "Not Debian 12: packages/runtime.txt is not checked."
  exit 0
fi

readonly bin_dir="$1"
readonly programs=(duet-server duet)

# Prints the files of the libraries that a program names.
libraries_of() {
  local program="$1" needed
  needed="$(readelf -d "${program}" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')"
  ldd "${program}" | awk '$2 == "=>" {print $1, $3} $1 ~ /^\// {print $1, $1}' |
    while read -r name file; do
      # The loader is named by its path.
      if grep -qxF "$(basename "${name}")" <<<"${needed}"; then readlink -f "${file}"; fi
    done
}

# Prints the package that a library file came with.
package_of() {
  local file="$1"
  # /lib is a link to /usr/lib; packages name their files by either.
  { dpkg-query -S "${file}" || dpkg-query -S "${file#/usr}" || echo "${file}: of no package"; } \
    2>/dev/null | sed -n '1s/:.*//p'
}

loaded="$(for program in "${programs[@]}"; do
  libraries_of "${bin_dir}/${program}" | while read -r file; do package_of "${file}"; done
done | sort -u)"
listed="$(sed -e 's/#.*//' -e '/^\s*$/d' packages/runtime.txt | sort -u)"

if ! difference="$(diff --label "runtime.txt lists" --label "the programs load" -u0 \
  <(echo "${listed}") <(echo "${loaded}"))"; then
  printf 'packages/runtime.txt is not what the programs load:\n%s\n' "${difference}" >&2
  exit 1
fi

for program in "${programs[@]}"; do
  if ldd "${bin_dir}/${program}" | grep -F libtorch >&2; then
    echo "${program} loads LibTorch." >&2
    exit 1
  fi
done
echo "packages/runtime.txt matches ${programs[*]}."
