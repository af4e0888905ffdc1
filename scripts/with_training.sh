#!/usr/bin/env bash
# Prints whether to build training and evaluation: the value of DUET_TRAINING (ON or OFF) if
# it is set, else OFF if this release lacks a package of packages/build_training.txt, else ON.
#   scripts/with_training.sh            prints ON or OFF
#   scripts/with_training.sh --lists    prints the package lists of the build: build, build_training
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if [[ -n "${DUET_TRAINING:-}" ]]; then
  training="${DUET_TRAINING^^}"
  if [[ "${training}" != ON && "${training}" != OFF ]]; then
    echo "DUET_TRAINING: expected ON or OFF, got ${DUET_TRAINING}" >&2
    exit 2
  fi
elif scripts/install_packages.sh --lacks build_training; then
  training=OFF
else
  training=ON
fi

if [[ "${1:-}" == --lists ]]; then
  [[ "${training}" == OFF ]] && echo build || echo build build_training
else
  echo "${training}"
fi
