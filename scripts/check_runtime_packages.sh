#!/usr/bin/env bash
# Checks that packages/runtime.txt lists exactly the packages whose libraries the programs load by name, that
# LibTorch is not among them, and that packages/training.txt lists the other packages of training. The names are
# those of this release (packages/releases.tsv).
#   scripts/check_runtime_packages.sh build/release/bin
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly bin_dir="$1"
readonly programs=(duet-server duet)
training_programs=(duet-train duet-eval duet-import)

# Prints the library files that a program loads by name.
libraries_of() {
  local program="$1" needed
  needed="$(readelf -d "${program}" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p')"
  ldd "${program}" | awk '$2 == "=>" {print $1, $3} $1 ~ /^\// {print $1, $1}' |
    while read -r name file; do
      # The loader has a path instead of a name.
      if grep -qxF "$(basename "${name}")" <<<"${needed}"; then readlink -f "${file}"; fi
    done
}

# Prints the packages of the libraries that programs load by name; a file of no package as itself.
packages_of() {
  local program line file
  local -a files
  local -A owners
  mapfile -t files < <(for program in "$@"; do libraries_of "${bin_dir}/${program}"; done | sort -u)
  # All files in one query, because it reads the lists of every package. /lib is a link to /usr/lib; packages use either path.
  while IFS= read -r line; do
    owners["${line##*: }"]="${line%%:*}"
  done < <(dpkg-query -S "${files[@]}" "${files[@]#/usr}" 2>/dev/null || true)
  for file in "${files[@]}"; do
    echo "${owners["${file}"]:-${owners["${file#/usr}"]:-${file}}}"
  done | sort -u
}

# Prints the packages of lists, with their names in this release.
listed_in() {
  scripts/install_packages.sh --print "$@" | sort -u
}

loaded="$(packages_of "${programs[@]}")"
listed="$(listed_in runtime)"

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
if [[ ! -x "${bin_dir}/duet-train" ]]; then
  echo "Built without training: packages/training.txt is not checked."
  training_programs=(duet-import)
fi
missing="$(comm -23 <(packages_of "${training_programs[@]}") <(listed_in runtime training))"
if [[ -n "${missing}" ]]; then
  printf 'packages/training.txt lacks:\n%s\n' "${missing}" >&2
  exit 1
fi
echo "packages/runtime.txt matches ${programs[*]}."
