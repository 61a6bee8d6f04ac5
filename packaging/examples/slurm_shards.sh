#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# slurm_shards.sh SHARDS FOLDER COMMAND...: the shards of a command of skein-hil, as an array of
# Slurm's; shard N goes into FOLDER/N (docs/experiments.md, Where one machine is not enough).
#
#   sbatch --array=1-500 slurm_shards.sh 500 runs/f8 simulate scenarios/faults-8.yaml --runs 1000000
#   skein-hil merge runs/f8/* --out runs/f8-whole
#SBATCH --job-name=skein
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=%x-%A-%a.log
set -eu
shards=$1 folder=$2
shift 2
exec "${SKEIN_HIL:-skein-hil}" "$@" --jobs 1 --shard "$SLURM_ARRAY_TASK_ID/$shards" \
  --out "$folder/$SLURM_ARRAY_TASK_ID"
