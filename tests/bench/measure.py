# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of programs, and what their output says of time."""

import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
GRANFLUX = ROOT / "build/release/bin/granflux"
ENVIRONMENT = dict(os.environ, OMP_NUM_THREADS="1", OMPI_ALLOW_RUN_AS_ROOT="1",
                   OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                   OMPI_MCA_btl_vader_single_copy_mechanism="none")


class Run(NamedTuple):
    output: str
    wall: float  # s
    cpu: float  # s, user and system, of all processes of the run
    memory: int  # bytes, the most that one process of the run has held


def measured_start(folder, program, *words, ranks=1, environment=ENVIRONMENT, wrapper=()):
    mpirun = ["mpirun", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)]
    command = [*wrapper, *(mpirun if ranks > 1 else []), str(program), *words]
    with tempfile.TemporaryFile("w+") as output, tempfile.TemporaryFile("w+") as errors:
        begin = time.monotonic()
        process = subprocess.Popen(command, cwd=folder, env=environment, text=True, stdout=output, stderr=errors)
        _, status, used = os.wait4(process.pid, 0)
        wall = time.monotonic() - begin
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        errors.seek(0)
        text = output.read()
        if process.returncode != 0:
            sys.exit(f"{' '.join(command)} failed:\n{text[-2000:]}{errors.read()[-2000:]}")
    return Run(text, wall, used.ru_utime + used.ru_stime, 1024 * used.ru_maxrss)


def start(*args, **options):
    return measured_start(*args, **options).output


def timed_start(*args, **options):
    """(output, seconds of the whole program)"""
    run = measured_start(*args, **options)
    return run.output, run.wall


def loop_seconds(output):
    return [float(s) for s in re.findall(r"Loop time of ([\d.eE+-]+) on", output)][-1]


def seconds_by_part(output, title):
    """The table of that title that granflux prints at the end of a run: {part: seconds}."""
    table = output[output.rindex("granflux: " + title):].partition("total")[0]
    rows = re.findall(r"^ +([a-z][a-z ,]*?) {2,}(-?[\d.]+) +-?[\d.]+ +-?[\d.]+", table, re.M)
    return {name: float(seconds) for name, seconds in rows}


def spread(values):
    return {"median": statistics.median(values), "min": min(values), "max": max(values)}
