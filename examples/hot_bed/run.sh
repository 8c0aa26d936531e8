#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# A bed of hot particles cooled by cold air; draws pictures into results/.
#   --time SECONDS   simulated time (default 0.5)
#   --ranks N        MPI ranks (default 2, or the cores there are)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

time=0.5 cores=$(nproc) ranks=
while [[ $# -gt 0 ]]; do
  case $1 in
    --time) time=${2:?--time needs seconds} && shift ;;
    --ranks) ranks=${2:?--ranks needs a number} && shift ;;
    -h | --help)
      sed -n '4,6s/^# //p' run.sh
      exit 0
      ;;
    *) echo "run.sh: unknown option $1; see --help" >&2 && exit 1 ;;
  esac
  shift
done
ranks=${ranks:-$((cores < 2 ? 1 : 2))}

rm -rf results
mkdir results
cp in.hot_bed hot_bed.toml results
(
  cd results
  OMP_NUM_THREADS=1 mpirun -np "$ranks" granflux -in in.hot_bed -var time "$time"
)
./plot.py results
