#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# The paper's large bed: a lattice falls and is fluidised, then 50 steps are timed; draws pictures.
#   --size NAME       small (331 776 spheres, default), paper (1.3 million), deep (5.3 million)
#   --mixing SECONDS  simulated time before the timed steps (default 0.1)
#   --threads N       of each rank (default: the cores there are, over the ranks)
#   --ranks N         MPI ranks (default 1)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

size=small mixing=0.1 ranks=1 threads=
while [[ $# -gt 0 ]]; do
  case $1 in
    --size) size=${2:?--size needs a name} && shift ;;
    --mixing) mixing=${2:?--mixing needs seconds} && shift ;;
    --threads) threads=${2:?--threads needs a number} && shift ;;
    --ranks) ranks=${2:?--ranks needs a number} && shift ;;
    -h | --help)
      sed -n '4,8s/^# //p' run.sh
      exit 0
      ;;
    *) echo "run.sh: unknown option $1; see --help" >&2 && exit 1 ;;
  esac
  shift
done
cores=$(nproc)
threads=${threads:-$((cores < ranks ? 1 : cores / ranks))}
case $size in
  small) variables=(-var floor 192 -var case gas_small) ;;
  paper) variables=() ;;
  deep) variables=(-var layers 36) ;;
  *) echo "run.sh: --size $size: there are small, paper and deep" >&2 && exit 1 ;;
esac

results=results/$size
rm -rf "$results"
mkdir -p "$results"
cp in.large_bed gas_*.toml "$results"
(
  cd "$results"
  mpirun --bind-to none -np "$ranks" granflux -threads "$threads" -in in.large_bed -var mixing "$mixing" "${variables[@]}"
)
./plot.py "$results"
rm "$results/particles.txt" # hundreds of megabytes
