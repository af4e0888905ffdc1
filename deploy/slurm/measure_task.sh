#!/usr/bin/env bash
# Evaluates the folds when all are trained; submit_training.sh submits it.
#   measure_task.sh DATA RUNS FOLDS
#SBATCH --job-name=duet-folds
#SBATCH --requeue
#SBATCH --open-mode=append
set -euo pipefail

read -ra folds <<<"$3"
duet-eval folds --data "$1" --runs "trained=$2" --subjects "${folds[@]}" --out "$2/results"
