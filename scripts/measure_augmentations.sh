#!/usr/bin/env bash
# Measures the effect of each augmentation: trains with the default configuration, without one of its
# augmentations at a time, and with each that it does not use. Compares on validation subjects: a run leaves
# out one subject completely and validates on another.
#   scripts/measure_augmentations.sh BIN DATA OUT     BIN: build/release/bin; DATA: the SBU folder
# Trains without the discriminator and for fewer epochs, which is five times as fast: compare the results only
# with one another. A killed run continues with the same command.
set -euo pipefail

readonly bin_dir="$1" data="$2" out="$3"
readonly pairs=("s01 s04" "s02 s05") # left out, validated on

train() { # NAME [SETTING...]
  local name="$1" pair left_out validated
  shift
  local settings=()
  for setting in "$@"; do settings+=(--set "${setting}"); done
  for pair in "${pairs[@]}"; do
    read -r left_out validated <<<"${pair}"
    "${bin_dir}/duet-train" --data "${data}" --out "${out}/${name}" --config without_discriminator \
      --protocol loso --fold "${left_out}" --set epochs=40 \
      --set "validation.subjects=[\"${validated}\"]" "${settings[@]}" >/dev/null
  done
  echo "${name}: trained"
}

train default
for part in mirror swap_roles body_scale leader_yaw noise body_noise crop; do
  train "without_${part}" "augmentation.${part}=0"
done
train with_time_warp augmentation.time_warp=0.1
train with_root_distance augmentation.root_distance=0.05
train with_yaw augmentation.yaw=0.15
train without_graded_labels graded_labels=0
train without_any augmentation.{mirror,swap_roles,body_scale,leader_yaw,noise,body_noise,crop}=0
train with_right_handed_mirrored augmentation.mirror_handed=0.5
train with_weight_average optimiser.average_decay=0.99
train with_rmsprop optimiser.name=rmsprop optimiser.learning_rate=0.001
train with_second_seed seed=1
