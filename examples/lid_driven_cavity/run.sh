#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# Gas in a square cavity whose lid moves: runs it until it is steady, compares the velocity on the two
# middle lines with an independent solution, draws both into results/.
#   --reynolds N   100, 400 or 1000 (default)
#   --ranks N      MPI ranks (default 1); the grid is cut into as many blocks
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

reynolds=1000 ranks=1
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
declare -A end_time=([100]=15 [400]=30 [1000]=45) # s: until nothing changes any more
if [[ -z ${end_time[$reynolds]:-} ]]; then
  echo "run.sh: --reynolds $reynolds: reference.csv has 100, 400 and 1000" >&2
  exit 1
fi

results=results/Re$reynolds
rm -rf "$results"
mkdir -p "$results"
sed -e "s/^viscosity = .*/viscosity = $(awk "BEGIN { print 1 / $reynolds }")/" \
  -e "s/^end_time = .*/end_time = ${end_time[$reynolds]}.0/" cavity.toml >"$results/cavity.toml"
(
  cd "$results"
  OMP_NUM_THREADS=1 mpirun -np "$ranks" granflux_cfd cavity.toml
)
./plot.py "$results" "$reynolds"
