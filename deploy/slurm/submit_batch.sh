#!/usr/bin/env bash
# Submits a `duet batch` as a job array, a shard each, and the job that merges the shards when all of
# them are done.
#   deploy/slurm/submit_batch.sh SHARDS OUT [words of sbatch...] -- [words of duet batch...]
#   deploy/slurm/submit_batch.sh 100 set --cpus-per-task=8 --time=4:00:00 -- leaders --recipe mixes.textproto
# OUT and the leaders lie on storage that all nodes see; duet and duet-server are in the PATH there.
# Prints the numbers of the two jobs. The same words again go on where a batch stopped.
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
[[ "${1:-}" == -- ]] || { echo "submit_batch.sh: wanted -- before the words of duet batch" >&2 && exit 2; }
shift

mkdir -p "${out}/logs"
array="$(sbatch --parsable --array="0-$((shards - 1))" --output="${out}/logs/shard-%a.log" \
  "${sbatch_words[@]}" "${folder}/batch_task.sh" "$@" --out "${out}")"
# Once every shard is settled; not at all where one failed for good.
merge="$(sbatch --parsable --dependency="afterok:${array}" --kill-on-invalid-dep=yes \
  --output="${out}/logs/merge.log" "${folder}/merge_task.sh" "${out}")"
echo "shards ${array}, merge ${merge}"
