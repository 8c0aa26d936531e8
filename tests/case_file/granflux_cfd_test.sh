#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# The program granflux_cfd as a user meets it. Usage: granflux_cfd_test.sh PROGRAM [MPIRUN...]
# Without mpirun one rank, and without the daemon that Open MPI starts for it.
set -euo pipefail

program=$1
shift
(($#)) || export OMPI_MCA_ess_singleton_isolated=1
# An error is out before the first rank ends: mpirun need not wait two seconds for the others.
export OMPI_MCA_odls_base_sigkill_timeout=0
launch=("$@")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
failures=0

# expect CODE TEXT ARGUMENTS...: the exit code, and a text that the output must have.
expect() {
  local code=$1 text=$2 found=0 output
  shift 2
  output=$("${launch[@]}" "$program" "$@" 2>&1) || found=$?
  if [[ $found -ne $code || $output != *"$text"* ]]; then
    failures=$((failures + 1))
    printf 'granflux_cfd %s\n  exit code %s, expected %s\n  expected text: %s\n%s\n\n' "$*" "$found" "$code" \
      "$text" "$output"
  fi
  # An error is told once, not by every rank.
  if [[ $code -ne 0 && $(grep -c "error:" <<<"$output") -gt 1 ]]; then
    failures=$((failures + 1))
    printf 'granflux_cfd %s: told its error more than once\n%s\n' "$*" "$output"
  fi
}

cat >good.toml <<'TOML'
[grid]
size = [0.01, 0.01, 0.02]
cells = [4, 4, 8]
periodic = [true, true, false]
[fluid]
density = 1.2
viscosity = 1.8e-5
[[boundary]]
name = "bottom"
side = "z_low"
type = "inlet"
velocity = [0.0, 0.0, 0.5]
[[boundary]]
name = "top"
side = "z_high"
type = "outlet"
[numerics]
time_step = 3e-4
end_time = 1e-3
[output]
fields = "gas"
every = 5e-4
[coupling]
drag = "read by others"
TOML

expect 0 "4 steps of 0.00025 s to t = 0.001 s" good.toml
expect 0 "3 files, the last gas_000002.cgns" good.toml --threads 2
# The stable range: 0.5 m/s by steps of 0.25 ms over cells of 2.5 mm.
expect 0 "gas Courant number                               0.05        0.5  OK      [numerics] time_step 0.00025" good.toml
sed 's/0.0, 0.0, 0.5/0.0, 0.0, 9/' good.toml >quick.toml
expect 0 "warning: t = 0 s: gas Courant number is 0.9, its limit 0.5: [numerics] time_step 0.000139 or less, or courant = 0.4" quick.toml
sed 's/0.0, 0.0, 0.5/0.0, 0.0, 900/' good.toml >absurd.toml
expect 1 "gas: step 1, time 0 s: Courant number 90 in cell (" absurd.toml
expect 1 "likely cause: gas Courant number is 90, its limit 0.5: [numerics] time_step 1.39e-06 or less, or courant = 0.4; no state was kept: [output] checkpoint names a file for it" absurd.toml
# Speed that grows until the scheme fails: the checkpoint is of before.
sed 's/0.0, 0.0, 0.5\]/0.0, 0.0, 1e4]\nramp_time = 1/; s/^end_time.*/end_time = 0.1/; s/^every.*/every = 1\ncheckpoint = "state"\ncheckpoint_every = 5e-4/' \
  good.toml >ramp.toml
expect 1 "last good state: checkpoint state of t = " ramp.toml
# Taken up with the step that the message asks for.
sed 's/1e4/0/; s/^end_time.*/end_time = 0.003/; s/^time_step.*/time_step = 4e-5/' ramp.toml >slow.toml
expect 0 "continues at t = 0.00" slow.toml --restart state
# 0.5 m/s through 1 cm2
expect 0 "bottom                    -5.000000e-05" good.toml
expect 0 "top                        5.000000e-05" good.toml
[[ $(ls gas_*.cgns | wc -l) -eq 3 ]] || {
  failures=$((failures + 1))
  ls
}
# A drum of five blocks, then the same from the file that it left.
cat >drum.toml <<'TOML'
[grid]
kind = "cylinder"
radius = 0.01
length = 0.02
cells = [2, 4, 6]
[fluid]
density = 1.2
viscosity = 1.8e-5
[[boundary]]
name = "wall"
type = "wall"
[[boundary]]
name = "low"
type = "inlet"
velocity = [0.0, 0.0, 0.5]
[[boundary]]
name = "high"
type = "outlet"
[numerics]
time_step = 3e-4
end_time = 6e-4
[output]
fields = "drum"
every = 1
TOML
mkdir cases
sed 's/^kind.*/kind = "cgns"\nfile = "..\/drum_000000.cgns"/; /^radius/d; /^length/d; /^cells/d; s/"drum"/"again"/' \
  drum.toml >cases/again.toml
expect 0 "mesh: 288 cells of" drum.toml
drum=$("${launch[@]}" "$program" drum.toml | grep -E "^(wall|low|high|sum of fluxes|pressure) " | sort)
again=$("${launch[@]}" "$program" cases/again.toml | grep -E "^(wall|low|high|sum of fluxes|pressure) " | sort)
[[ $drum == "$again" ]] || {
  failures=$((failures + 1))
  printf 'the drum and its copy differ\n%s\n%s\n' "$drum" "$again"
}
sed 's/"high"/"top"/' cases/again.toml >cases/names.toml
expect 1 'error: cases/names.toml: [[boundary]] "top": the grid has no boundary of that name; the grid'"'"'s boundaries are: high, low, wall' \
  cases/names.toml
sed 's/drum_0/none_0/' cases/again.toml >cases/none.toml
expect 1 'error: cases/none.toml: [grid] file = "cases/../none_000000.cgns": cannot be read: No such file or directory' \
  cases/none.toml

sed 's/true, true/false, true/' good.toml >walls.toml
cat >>walls.toml <<'TOML'
[[boundary]]
name = "left, cold"
side = "x_low"
type = "wall"
[[boundary]]
name = "right"
side = "x_high"
type = "wall"
TOML
expect 0 "4 steps" walls.toml --forces forces.csv
[[ $(wc -l <forces.csv) -eq 5 && $(head -1 forces.csv) == 'time,"left, cold x","left, cold y","left, cold z","right x","right y","right z"' ]] || {
  failures=$((failures + 1))
  cat forces.csv
}
# both walls are dragged along alike, and pressed apart
awk -F, 'END { exit !($4 > 0 && $7 > 0 && ($4 / $7 - 1) ^ 2 < 1e-12 && $2 * $5 < 0) }' forces.csv || {
  failures=$((failures + 1))
  cat forces.csv
}
expect 1 "error: --forces forces.csv: the case has no wall" good.toml --forces forces.csv
expect 1 "error: --forces none/forces.csv: cannot be written" walls.toml --forces none/forces.csv
expect 0 "granflux_cfd 0." --version
expect 0 "case file (TOML)" --help

expect 1 "case is required"
expect 1 "--threads" good.toml --threads 0
expect 1 'error: case file "none.toml" cannot be read: No such file or directory' none.toml
sed 's/1.2/-1.2/' good.toml >density.toml
expect 1 "error: density.toml: [fluid] density = -1.2: must be a number > 0 (kg/m3)" density.toml
sed 's/^time_step.*//' good.toml >no_step.toml
expect 1 "error: no_step.toml: [numerics] time_step is missing" no_step.toml
sed 's/fields = "gas"/fields = "none\/gas"/' good.toml >no_folder.toml
expect 1 'error: no_folder.toml: [output] fields = "none/gas": the folder "none" does not exist' no_folder.toml
sed 's/"z_high"/"z_low"/' good.toml >overlap.toml
expect 1 'error: overlap.toml: boundaries "bottom" and "top" overlap' overlap.toml
sed 's/cells = .*/cells = [1, 1, 1]\nblocks = [1, 2, 1]/' good.toml >blocks.toml
expect 1 'error: blocks.toml: [grid] blocks: ' blocks.toml
sed 's/cells = .*/cells = [400, 400, 400]/' good.toml >large.toml
if ((${#launch[@]} == 0)); then # of several ranks each may tell
  (ulimit -v 1500000 && expect 1 "error: out of memory: this rank " large.toml && exit "$failures") || failures=$((failures + 1))
fi

if ((failures)); then
  echo "$failures failures"
  exit 1
fi
echo "all as expected"
