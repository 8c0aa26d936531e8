#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# The paper's small bed: packs it, blows air through it, draws pictures into results/.
#   --full           28.4 s of simulated time, as in the paper (hours), instead of 0.2 s
#   --time SECONDS   any other simulated time
#   --velocity U     0.6 or 0.9 m/s (default 0.9)
#   --ranks N        MPI ranks (default 2, or the cores there are)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

time=0.2 velocity=0.9 cores=$(nproc) ranks=
while [[ $# -gt 0 ]]; do
  case $1 in
    --full) time=28.4 ;;
    --time) time=$2 && shift ;;
    --velocity) velocity=$2 && shift ;;
    --ranks) ranks=$2 && shift ;;
    -h | --help) sed -n '4,8s/^# //p' "${BASH_SOURCE[0]}" && exit 0 ;;
    *) echo "run.sh: unknown option $1; see --help" >&2 && exit 1 ;;
  esac
  shift
done
ranks=${ranks:-$((cores < 2 ? 1 : 2))}
if [[ ! -f bed_U$velocity.toml ]]; then
  echo "run.sh: --velocity $velocity: there is no bed_U$velocity.toml; there are:" bed_U*.toml >&2
  exit 1
fi

results=results/U$velocity
rm -rf "$results"
mkdir -p "$results"
cp in.* "bed_U$velocity.toml" "$results"
(
  cd "$results"
  OMP_NUM_THREADS=1 mpirun -np "$ranks" granflux -in in.bed -var U "$velocity" -var time "$time"
)
python3 plot.py "$results"
