#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# The installed tree alone suffices: its programs run its examples, coupled under both hosts, its pages
# lead to each other, and it serves a project of somebody else. The Debian package's programs run from a
# scratch root. Usage: install_test.sh BUILD SOURCE VERSION
set -euo pipefail
build=$1 source=$2 version=$3
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export OMPI_MCA_ess_singleton_isolated=1

# says TEXT COMMAND...: the command's output must have the text.
says() {
  local text=$1 output
  shift
  output=$("$@" 2>&1) || { printf '%s\nfailed:\n%s\n' "$*" "$output"; exit 1; }
  [[ $output == *"$text"* ]] || { printf '%s\nexpected: %s\n%s\n' "$*" "$text" "$output"; exit 1; }
}

# runs PREFIX: every program that was built is there and works.
programs_run() {
  local prefix=$1 program
  for program in granflux granflux_lammps; do
    [[ ! -e $build/bin/$program ]] || says "$program $version" "$prefix/bin/$program" -version
  done
  says "4 steps of 0.00025 s to t = 0.001 s" "$prefix/bin/granflux_cfd" \
    "$prefix/share/doc/granflux/examples/consumer/box.toml"
  says "usage: granflux-regress" "$prefix/bin/granflux-regress" --help
  says "usage: granflux_study" "$prefix/bin/granflux_study" --help
  [[ ! -e $build/lib/granfluxplugin.so || -n $(find "$prefix/lib" -name granfluxplugin.so) ]]
  [[ -e $prefix/share/doc/granflux/docs/reference/case_file.md ]]
  [[ -e $prefix/share/doc/granflux/docs/results/validation.md ]]
  [[ -e $prefix/share/doc/granflux/examples/fluidized_bed/in.bed ]]
}

# runs_examples PREFIX: as docs/howto/install.md says, a copy of the examples, with PREFIX/bin on the
# path, which no folder of the build is; the bed settles for a tenth of its time.
runs_examples() {
  local prefix=$1 host program
  cp -r "$prefix/share/doc/granflux/examples" "$scratch/examples"
  sed -i 's/^\(run  *\)16000$/\11600/' "$scratch"/examples/fluidized_bed/{.,lammps}/in.settle
  for host in liggghts lammps; do
    program=granflux
    [[ $host == liggghts ]] || program=granflux_lammps
    [[ -e $build/bin/$program ]] || continue
    PATH=$prefix/bin:/usr/bin:/bin OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 \
      says "residual of gas mass" "$scratch/examples/fluidized_bed/run.sh" --host $host --time 0.001 --ranks 1
  done
  for picture in "$scratch"/examples/fluidized_bed/results/U0.9*/picture.png; do
    [[ -s $picture ]] || { echo "no $picture"; exit 1; }
  done
}

# leads PREFIX: links of the installed pages go to installed files; those of the box of contents to the
# sources are all that do not.
leads() {
  local faults
  faults=$(python3 -B "$source/tests/meta/links.py" "$1/share/doc/granflux" |
    grep -vE '^README.md: (cfd_lib|coupling|liggghts_plugin|study|tests): |^[0-9]+ faults|^no faults' || true)
  [[ -z $faults ]] || { echo "$faults"; exit 1; }
}

# serves PREFIX: the consumer builds and runs on the tree alone.
serves() {
  local consumer=$1/share/doc/granflux/examples/consumer
  cmake -S "$consumer" -B "$scratch/consumer" -DCMAKE_PREFIX_PATH="$1" \
    -DCMAKE_BUILD_TYPE=Debug >"$scratch/log" 2>&1 && cmake --build "$scratch/consumer" >>"$scratch/log" 2>&1 ||
    { cat "$scratch/log"; exit 1; }
  # 0.5 m/s through 1 cm2
  says "flux out of top: 5.000000e-05 m3/s" "$scratch/consumer/consumer" "$consumer/box.toml"
  says "wen_yu F(Re 0, eps 1): 1.000000" "$scratch/consumer/consumer" "$consumer/box.toml"
}

cmake --install "$build" --prefix "$scratch/tree" >/dev/null
programs_run "$scratch/tree"
runs_examples "$scratch/tree"
leads "$scratch/tree"
serves "$scratch/tree"
if grep -rF "$source" "$scratch/tree" --include='*.cmake'; then
  echo "the installed package knows the source tree"
  exit 1
fi

(cd "$scratch" && cpack --config "$build/CPackConfig.cmake" -B "$scratch" >"$scratch/log" 2>&1) || {
  cat "$scratch/log"
  exit 1
}
package=$(echo "$scratch"/granflux_*.deb)
says "$version" dpkg-deb --field "$package" Version
for library in libc6 libopenmpi3 libgomp1 libcgns openmpi-bin; do
  says "$library" dpkg-deb --field "$package" Depends
done
[[ ! -e $build/bin/granflux ]] || says libliggghts dpkg-deb --field "$package" Depends
[[ ! -e $build/bin/granflux_lammps ]] || says liblammps dpkg-deb --field "$package" Depends
dpkg-deb -x "$package" "$scratch/root"
programs_run "$scratch/root/usr"
echo "all as expected"
