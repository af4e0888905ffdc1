#!/usr/bin/env bash
# Runs clang-tidy 14 (.clang-tidy) on the C++ files that differ from the main branch; with "all", on
# every C++ file.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly build_dir=build/lint

changed_files() {
  if [[ "${1:-}" == all ]]; then
    find model server client tests benchmarks contrib -name '*.cc'
  else
    { git diff --name-only --diff-filter=d main -- && git ls-files --others --exclude-standard; } |
      grep '\.cc$' || true
  fi
}

# clang-tidy needs the generated protocol headers, reads no precompiled ones, and looks at single files.
mapfile -t tools < <(scripts/contrib_options.sh ON)
scripts/configure.sh release -B "${build_dir}" -DDUET_BATCHES=OFF -DDUET_PRECOMPILE=OFF -DDUET_BUILD_TESTS=ON \
  -DDUET_BUILD_BENCHMARKS=ON "${tools[@]}" >/dev/null
cmake --build "${build_dir}" --parallel "${JOBS:-1}" --target duet_generated

mapfile -t files < <(changed_files "$@" | sort -u)
if [[ ${#files[@]} -eq 0 ]]; then
  echo "No C++ file differs from main; LINT=all lints everything."
  exit 0
fi
run-clang-tidy-14 -quiet -p "${build_dir}" -j "${JOBS:-1}" "${files[@]/#/^$(pwd)/}"
