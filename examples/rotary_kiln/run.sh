#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# The paper's rotary kiln, a section of it: fills the drum, turns and heats it, draws pictures into results/.
#   --time SECONDS   simulated time (default 1; a revolution takes 3, the paper shows 12)
#   --full           the whole kiln: 100 000 particles, 4500 gas cells in 25 blocks
#   --ends WHICH     turning with the drum (default), resting, or periodic: there are none
#   --radius LAW     contact radius of conduction: hertz (default), geometric, overlap, stock
#   --ranks N        MPI ranks (default 1)
#   --threads N      OpenMP threads of each (default 2, or the cores there are)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

time=1 part=section ends=turning radius=hertz ranks=1 cores=$(nproc) threads=
while [[ $# -gt 0 ]]; do
  case $1 in
    --time) time=${2:?--time needs seconds} && shift ;;
    --full) part=full ;;
    --ends) ends=${2:?--ends needs turning, resting or periodic} && shift ;;
    --radius) radius=${2:?--radius needs a law} && shift ;;
    --ranks) ranks=${2:?--ranks needs a number} && shift ;;
    --threads) threads=${2:?--threads needs a number} && shift ;;
    -h | --help)
      sed -n '4,10s/^# //p' run.sh
      exit 0
      ;;
    *) echo "run.sh: unknown option $1; see --help" >&2 && exit 1 ;;
  esac
  shift
done

edits=() variables=() filling=$part
case $ends in
  turning) ;;
  resting)
    variables+=(-var ends_turn 0)
    edits+=(-e '/^name = "\(low\|high\)"/,/^$/{/^angular_velocity/d}')
    ;;
  periodic)
    variables+=(-var ends 0)
    filling=$part-periodic
    edits+=(-e 's/^axial_blocks.*/&\nperiodic_axis = true/')
    edits+=(-e '/^\[\[boundary\]\]$/{N;/"\(low\|high\)"/{:more;N;/\n$/!bmore;d}}')
    ;;
  *) echo "run.sh: --ends $ends: must be turning, resting or periodic" >&2 && exit 1 ;;
esac
if [[ $part == full ]]; then
  variables+=(-var length 76.2e-3 -var particles 100000)
  edits+=(-e 's/^length = .*/length = 76.2e-3/' -e 's/^cells = .*/cells = [5, 10, 15]/')
  edits+=(-e 's/^axial_blocks = .*/axial_blocks = 5/')
fi
threads=${threads:-$((cores < 2 ? 1 : 2))}

# in FOLDER SCRIPT [VARIABLES ...]: a run of the kiln
granflux_in() {
  local folder=$1 script=$2
  shift 2
  (cd "$folder" && OMP_NUM_THREADS=$threads OMP_WAIT_POLICY=passive mpirun --bind-to none -np "$ranks" \
    granflux -in "$script" "${variables[@]}" "$@")
}

# The settled bed stays for further runs.
settled=results/settled-$filling
if [[ ! -f $settled/settled.restart || -n $(find in.* end.stl -newer "$settled/settled.restart") ]]; then
  rm -rf "$settled"
  mkdir -p "$settled"
  cp in.* end.stl "$settled"
  granflux_in "$settled" in.settle $([[ $part == full ]] && echo -var fill 19e-3)
fi

results=results/$part
[[ $ends == turning ]] || results+=-$ends
[[ $radius == hertz ]] || results+=-$radius
rm -rf "$results"
mkdir -p "$results"
cp in.* end.stl "$settled/settled.restart" "$results"
# Eight frames or more, at times that thermo output has too.
every=$(awk -v t="$time" 'BEGIN { e = int(t / 0.08) / 100; print (e < 0.01 ? 0.01 : e > 0.25 ? 0.25 : e) }')
edits+=(-e "s/^every = .*/every = $every/")
sed "${edits[@]}" kiln.toml >"$results/kiln.toml"
granflux_in "$results" in.kiln -var time "$time" -var every "$every" -var radius_of_contact "$radius"
./plot.py "$results"
./owners.py "$results" "${variables[@]}"
