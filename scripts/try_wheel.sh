#!/usr/bin/env bash
# Installs the wheel of the Python package into a fresh environment, without network access, and reads every
# sample there: without programs of Duet, from another folder.
#   scripts/try_wheel.sh [folder of the wheel]       (build/python)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

fail() {
  printf 'try_wheel: %s\n' "$*" >&2
  exit 1
}

shopt -s nullglob
wheels=("${1:-build/python}"/duet_motion-*.whl)
[[ ${#wheels[@]} -eq 1 ]] || fail "expected one wheel in ${1:-build/python}, got ${#wheels[@]}"
wheel="$(realpath "${wheels[0]}")"
samples="$(realpath samples)"

environment="$(mktemp -d)"
trap 'rm -rf "${environment}"' EXIT
# NumPy, gRPC and protobuf are the system's.
/usr/bin/python3 -m venv --without-pip --system-site-packages "${environment}"
/usr/bin/python3 -m pip --python "${environment}/bin/python" install --quiet --no-deps --no-index "${wheel}"

cd "${environment}"
env -i PATH="${environment}/bin" HOME="${environment}" python - "${samples}" <<'END' ||
import pathlib
import sys

import duet_motion
from duet_motion import _motion_files  # the module in C++

assert pathlib.Path(duet_motion.__file__).is_relative_to(sys.prefix), duet_motion.__file__
assert pathlib.Path(_motion_files.__file__).is_relative_to(sys.prefix), _motion_files.__file__
files = sorted(pathlib.Path(sys.argv[1]).glob("*.bvh"))
assert files, sys.argv[1]
for file in files:
    motion = duet_motion.read_motion(file)
    assert motion.positions.shape == (motion.frame_count, 15, 3), (file, motion)
    duet_motion.write_motion("copy.glb", motion)
    assert abs(duet_motion.read_motion("copy.glb").positions - motion.positions).max() < 1e-4, file
print(f"Python {sys.version.split()[0]}: read {len(files)} files")
END
  fail "${wheel##*/}: expected a wheel that reads the samples, got an error"
echo "${wheel##*/}: works in a fresh environment"
