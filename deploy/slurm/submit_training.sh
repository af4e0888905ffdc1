#!/usr/bin/env bash
# Submits leave-one-subject-out training as a job array with one fold in each task, and the job that evaluates
# the folds when all are trained.
#   deploy/slurm/submit_training.sh DATA RUNS "SUBJECT..." [arguments of sbatch...] -- [arguments of duet-train...]
#   deploy/slurm/submit_training.sh sbu runs "s01 s02 s03" --cpus-per-task=4 -- --config flow
# DATA and RUNS must be on storage that all nodes see, and duet-train and duet-eval in their PATH.
set -euo pipefail

folder="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly folder

if (($# < 4)); then
  sed -n 's/^# \{0,1\}//; 2,6p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
readonly data="$1" runs="$2" subjects="$3"
shift 3
sbatch_words=()
while (($#)) && [[ "$1" != -- ]]; do
  sbatch_words+=("$1")
  shift
done
[[ "${1:-}" == -- ]] || { echo "submit_training.sh: expected -- before the arguments of duet-train" >&2 && exit 2; }
shift

count="$(wc -w <<<"${subjects}")"
mkdir -p "${runs}/logs"
array="$(sbatch --parsable --array="0-$((count - 1))" --output="${runs}/logs/fold-%a.log" \
  "${sbatch_words[@]}" "${folder}/train_task.sh" "${subjects}" --data "${data}" --out "${runs}" "$@")"
measure="$(sbatch --parsable --dependency="afterok:${array}" --kill-on-invalid-dep=yes \
  --output="${runs}/logs/measure.log" "${folder}/measure_task.sh" "${data}" "${runs}" "${subjects}")"
echo "folds ${array}, measure ${measure}"
