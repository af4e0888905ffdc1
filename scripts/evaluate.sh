#!/usr/bin/env bash
# Repeats the evaluation of the method: trains the models that are missing, measures them and makes the report.
# Continues after an interruption. Takes hours on two cores.
#   scripts/evaluate.sh BIN DATA RUNS RESULTS REPORT
#     BIN: build/release/bin   DATA: the SBU folder   RUNS, RESULTS, REPORT: folders to write
# The ablation, including its row of the full method, trains for half the epochs.
# FOLDS="s01 s02" restricts the ablation to some folds; the default is every subject.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly bin="$1" data="$2" runs="$3" results="$4" report="$5"
# Names, and the settings of the default that each of them changes.
readonly ablations=(
  "without_discriminator losses.adversarial=0"
  "without_embedding generator.variant=unlabelled graded_labels=0"
  "without_bone losses.bone=0"
  "with_paper_frame standardisation=leader_root_and_yaw"
  "with_continuity losses.continuity=1"
  "without_fc generator.slice_features=0"
)
readonly methods=class_mean,frozen_first_frame,nearest_neighbour,hmm,kzbh12,hk14,hfkb15
readonly quality=velocity_error,bone_length_drift,jitter,skating_ratio,foot_slide_cm
readonly touch=penetration_frequency,penetration_depth_m
readonly judged=accuracy,fid,diversity
readonly placed=afd,afd_squared,afd_m,root_aligned_afd
export OMP_NUM_THREADS=1

readonly ablation_epochs=50

ablate() { # "NAME [SETTING...]" [FOLD...]
  local named settings fold
  read -ra named <<<"$1"
  settings=("${named[@]:1}")
  local command=("${bin}/duet-train" --data "${data}" --out "${runs}/ablation/${named[0]}"
    "--set=epochs=${ablation_epochs}" "${settings[@]/#/--set=}" --protocol loso)
  shift
  (($#)) || "${command[@]}"
  for fold in "$@"; do "${command[@]}" --fold "${fold}"; done
}

train() {
  local config folds seed
  read -ra folds <<<"${FOLDS:-}"
  for config in default flow mshl22; do
    "${bin}/duet-train" --data "${data}" --out "${runs}/${config}" --config "${config}" \
      --protocol loso
  done
  for seed in 1 2; do # in addition to 0: the spread over initial weights
    "${bin}/duet-train" --data "${data}" --out "${runs}/flow-${seed}" --config flow \
      --set "seed=${seed}" --protocol loso
  done
  for config in default "${ablations[@]}"; do ablate "${config}" "${folds[@]}"; done
  "${bin}/duet-train" --data "${data}" --out "${runs}/half" --protocol half --seeds 1,2,3,4,5
}

# Measures the model that samples beside the deterministic one.
sampled() {
  local models=(--runs "flow=${runs}/flow" --runs "ours=${runs}/default")
  "${bin}/duet-eval" samples --data "${data}" --out "${results}" "${models[@]}" \
    --runs "flow, seed 1=${runs}/flow-1" --runs "flow, seed 2=${runs}/flow-2" --id 14_samples
  "${bin}/duet-eval" samples --data "${data}" --out "${results}" "${models[@]}" --as-served \
    --id 15_samples_as_served --title "Many answers to one leader, as a server answers"
  "${bin}/duet-eval" told-apart --data "${data}" --out "${results}" "${models[@]}" --as-served
  "${bin}/duet-eval" sweep --data "${data}" --runs "flow=${runs}/flow" --out "${results}" \
    --id 31_sweep_flow --title "Mix, match and avoid by the model that samples"
  "${bin}/duet-eval" mixes --data "${data}" --runs "flow=${runs}/flow" --as-served \
    --out "${results}"
}

measure() {
  local config named=("full=${runs}/ablation/default")
  "${bin}/duet-eval" folds --data "${data}" --out "${results}" --id 10_methods \
    --title "Methods: leave one subject out" --baselines "${methods}" \
    --runs "ours=${runs}/default" --runs "mshl22=${runs}/mshl22" \
    --metrics "${placed},${quality},${touch},${judged}"
  "${bin}/duet-eval" folds --data "${data}" --out "${results}" --id 12_as_served --as-served \
    --title "The same model as a server answers" --baselines class_mean,frozen_first_frame \
    --runs "ours=${runs}/default" --metrics "afd,afd_squared,${quality},${touch}"
  sampled
  for config in "${ablations[@]%% *}"; do named+=("${config}=${runs}/ablation/${config}"); done
  "${bin}/duet-eval" folds --data "${data}" --out "${results}" --id 20_ablation \
    --title "Ablation (Tables 4 and 5)" --starts none,pose --baselines class_mean \
    ${FOLDS:+--subjects "${FOLDS// /,}"} "${named[@]/#/--runs=}" \
    --metrics "afd,afd_squared,root_aligned_afd,${quality},accuracy,fid"
  "${bin}/duet-eval" sweep --data "${data}" --runs "ours=${runs}/default" --out "${results}"
  "${bin}/duet-eval" augmentation --data "${data}" --runs "${runs}/half" --out "${results}"
  "${bin}/duet-eval" latent --data "${data}" --runs "ours=${runs}/default" \
    --runs "mshl22=${runs}/mshl22" --out "${results}"
}

train
measure
scripts/make_report.py --results "${results}" --out "${report}"
