# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of programs, and what their output says of time."""

import os
import re
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GRANFLUX = ROOT / "build/release/bin/granflux"
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_btl_vader_single_copy_mechanism="none")


def start(folder, program, *words, ranks=1):
    mpirun = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)]
    command = [*(mpirun if ranks > 1 else []), str(program), *words]
    done = subprocess.run(command, cwd=folder, env=ENVIRONMENT, text=True, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def timed_start(*args, **options):
    """(output, seconds of the whole program)"""
    begin = time.monotonic()
    output = start(*args, **options)
    return output, time.monotonic() - begin


def loop_seconds(output):
    return [float(s) for s in re.findall(r"Loop time of ([\d.eE+-]+) on", output)][-1]


def seconds_by_part(output, title):
    """The table of that title that granflux prints at the end of a run: {part: seconds}."""
    table = output[output.rindex("granflux: " + title):].partition("total")[0]
    rows = re.findall(r"^ +([a-z][a-z ,]*?) {2,}(-?[\d.]+) +-?[\d.]+ +-?[\d.]+", table, re.M)
    return {name: float(seconds) for name, seconds in rows}


def spread(values):
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}
