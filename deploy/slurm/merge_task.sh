#!/usr/bin/env bash
# Merges the shards of a batch when all of them are settled; submit_batch.sh submits it.
#SBATCH --job-name=duet-merge
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

duet batch merge "$1"
duet batch verify "$1"
