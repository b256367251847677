#!/bin/sh
# A fleet on Slurm: every task of the array runs its part of the plan, on as many threads as it has cores.
#
#   boresight fleet plan /data/drives/* --out jobs.jsonl
#   sbatch --array=0-31 slurm.sh
#   boresight fleet merge records --plan jobs.jsonl --out results
#
# A task that was ended, or that the queue begins again, goes on from its records. The plan, the logs and the folder of records are on a
# file system that all nodes share.
#SBATCH --job-name=boresight-fleet
#SBATCH --array=0-31
#SBATCH --cpus-per-task=4
#SBATCH --mem-per-cpu=2G
#SBATCH --time=02:00:00
#SBATCH --requeue
set -eu

exec boresight fleet run "${PLAN:-jobs.jsonl}" --out "${RECORDS:-records}" --part auto --threads "${SLURM_CPUS_PER_TASK:-1}"
