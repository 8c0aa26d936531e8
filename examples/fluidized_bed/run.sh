#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# The paper's small bed: packs it, blows air through it, draws pictures into results/.
#   --full           28.4 s of simulated time, as in the paper (hours), instead of 0.2 s
#   --time SECONDS   any other simulated time
#   --velocity U     0.6 or 0.9 m/s (default 0.9)
#   --ranks N        MPI ranks (default 2, or the cores there are)
#   --host NAME      what moves the particles: liggghts (default) or lammps
#   --validate       10 s at 0.6 m/s against the measured void fraction (an hour): springs of 500 N/m
#                    and steps of 1e-5 s, which are as many steps a contact as 2000 N/m and 5e-6 s
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

time=0.2 velocity=0.9 cores=$(nproc) ranks= validate= host=liggghts
while [[ $# -gt 0 ]]; do
  case $1 in
    --full) time=28.4 ;;
    --time) time=${2:?--time needs seconds} && shift ;;
    --velocity) velocity=${2:?--velocity needs m/s} && shift ;;
    --ranks) ranks=${2:?--ranks needs a number} && shift ;;
    --host) host=${2:?--host needs liggghts or lammps} && shift ;;
    --validate) validate=yes time=10 velocity=0.6 ;;
    -h | --help)
      sed -n '4,11s/^# //p' run.sh
      exit 0
      ;;
    *) echo "run.sh: unknown option $1; see --help" >&2 && exit 1 ;;
  esac
  shift
done
ranks=${ranks:-$((cores < 2 ? 1 : 2))}
if [[ ! -f bed_U$velocity.toml ]]; then
  echo "run.sh: --velocity $velocity: there is no bed_U$velocity.toml; there are:" bed_U*.toml >&2
  exit 1
fi
case $host in
  liggghts) program=granflux scripts=. suffix= ;;
  lammps) program=granflux_lammps scripts=lammps suffix=_lammps ;;
  *) echo "run.sh: --host $host: must be liggghts or lammps" >&2 && exit 1 ;;
esac

results=results/U$velocity$suffix
variables=(-var U "$velocity" -var time "$time")
if [[ -n $validate ]]; then
  results=results/validation$suffix
  variables+=(-var stiffness 500 -var dt 1e-5 -var profile 1000 -var every 100000)
fi
rm -rf "$results"
mkdir -p "$results"
cp "$scripts"/in.* "bed_U$velocity.toml" "$results"
(
  cd "$results"
  OMP_NUM_THREADS=1 mpirun -np "$ranks" "$program" -in in.bed "${variables[@]}"
)
./plot.py "$results"
if [[ -n $validate ]]; then
  ./void_profile.py "$results" --timestep 1e-5
fi
