#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# Flow around a cylinder on a body-fitted ring of cells: runs it, compares drag, wake and frequency of
# shedding with published numbers, draws flow and forces into results/.
#   --reynolds N   20, 40 (a steady wake) or 100 (default: vortices are shed)
#   --ranks N      MPI ranks (default 1)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

reynolds=100 ranks=1
while [[ $# -gt 0 ]]; do
  case $1 in
    --reynolds) reynolds=${2:?--reynolds needs a number} && shift ;;
    --ranks) ranks=${2:?--ranks needs a number} && shift ;;
    -h | --help)
      sed -n '4,7s/^# //p' run.sh
      exit 0
      ;;
    *) echo "run.sh: unknown option $1; see --help" >&2 && exit 1 ;;
  esac
  shift
done
declare -A end_time=([20]=60 [40]=80 [100]=100) # s
if [[ -z ${end_time[$reynolds]:-} ]]; then
  echo "run.sh: --reynolds $reynolds: there are published numbers for 20, 40 and 100" >&2
  exit 1
fi

results=results/Re$reynolds
rm -rf "$results"
mkdir -p "$results"
sed -e "s/^viscosity = .*/viscosity = $(awk "BEGIN { print 1 / $reynolds }")/" \
  -e "s/^end_time = .*/end_time = ${end_time[$reynolds]}.0/" cylinder.toml >"$results/cylinder.toml"
(
  cd "$results"
  OMP_NUM_THREADS=1 mpirun -np "$ranks" granflux_cfd cylinder.toml --forces forces.csv
)
./plot.py "$results" "$reynolds"
