#!/usr/bin/env bash
# Submits a `duet batch` as a job array with one shard in each task, and the job that gathers the shards when
# all of them are done.
#   deploy/slurm/submit_batch.sh SHARDS OUT [arguments of sbatch...] -- [arguments of duet batch...]
#   deploy/slurm/submit_batch.sh 100 set --cpus-per-task=8 --time=4:00:00 -- leaders --recipe mixes.textproto
# OUT and the leaders must be on storage that all nodes see, and duet and duet-server in their PATH.
# Prints the numbers of the two jobs. The same command again continues a batch that stopped.
set -euo pipefail

folder="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly folder

if (($# < 3)); then
  sed -n 's/^# \{0,1\}//; 2,6p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
readonly shards="$1" out="$2"
shift 2
sbatch_words=()
while (($#)) && [[ "$1" != -- ]]; do
  sbatch_words+=("$1")
  shift
done
[[ "${1:-}" == -- ]] || { echo "submit_batch.sh: expected -- before the arguments of duet batch" >&2 && exit 2; }
shift

mkdir -p "${out}/logs"
array="$(sbatch --parsable --array="0-$((shards - 1))" --output="${out}/logs/shard-%a.log" \
  "${sbatch_words[@]}" "${folder}/batch_task.sh" "$@" --out "${out}")"
# Runs when every shard is settled, and not at all if one failed permanently.
gather="$(sbatch --parsable --dependency="afterok:${array}" --kill-on-invalid-dep=yes \
  --output="${out}/logs/gather.log" "${sbatch_words[@]}" "${folder}/batch_task.sh" "$@" --out "${out}" --verify)"
echo "shards ${array}, gather ${gather}"
