#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
# What accuracy costs: runs the study of a case over its ladders of settings; a page with figures goes to CASE/results.
#   CASE             packed_bed (default), single_particle, heat_up, small_bed
#   --error SHARE    wanted error, such as 0.05; any other option of granflux_study
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

name=packed_bed
if [[ $# -gt 0 && $1 != -* ]]; then
  name=$1
  shift
fi
case ${1:-} in
  -h | --help)
    sed -n '4,6s/^# //p' run.sh
    exit 0
    ;;
esac
if [[ ! -f $name/study.toml ]]; then
  echo "run.sh: there is no study \"$name\"; there are:" */ >&2
  exit 1
fi
granflux_study "$name" "$@"
