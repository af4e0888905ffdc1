#!/usr/bin/env bash
# Configures a build folder, with training only where the release has LibTorch (scripts/with_training.sh), and with the
# tools of contrib only where a FLAG turns them on.
#   scripts/configure.sh PRESET [FLAG...]     PRESET: one of CMakePresets.json; FLAGs of cmake
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

training="$(scripts/with_training.sh)"
mapfile -t tools < <(scripts/contrib_options.sh OFF)
exec cmake --preset "$1" -DDUET_TRAINING="${training}" "${tools[@]}" "${@:2}"
