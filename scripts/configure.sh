#!/usr/bin/env bash
# Configures a build folder, with training only where the release has LibTorch (scripts/with_training.sh).
#   scripts/configure.sh PRESET [FLAG...]     PRESET: one of CMakePresets.json; FLAGs of cmake
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

training="$(scripts/with_training.sh)"
exec cmake --preset "$1" -DDUET_TRAINING="${training}" "${@:2}"
