# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs one case with one program, in a folder of its own."""

import gzip
import math
import os
import pathlib
import random
import subprocess

from container import container_of
from particles import data_file, dilute_positions, radii_of
from script import script_of
from walls import mesh_files

REFERENCES = pathlib.Path(__file__).parent / "references"
TIMEOUT = 120  # s
# Waiting ranks give way, or two of them on a busy machine take minutes; CTest sets the same.
ENVIRONMENT = {"OMPI_MCA_mpi_yield_when_idle": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}


def packing_name(case):
    shape = "planes" if case.container == "mesh" else case.container
    return f"packing_{shape}_{case.sizes}.txt.gz"


def read_packing(case):
    text = gzip.decompress((REFERENCES / packing_name(case)).read_bytes()).decode()
    return [tuple(float(word) for word in line.split()) for line in text.splitlines()]


def nudged(positions, seed):
    """Every coordinate a last digit up or down."""
    numbers = random.Random(seed)
    return [tuple(math.nextafter(x, numbers.choice((-math.inf, math.inf))) for x in point) for point in positions]


def write_inputs(case, folder, steps, grid="* * *", skin=5e-4, nudge=None):
    container = container_of(case)
    dense = case.density == "dense"
    positions = read_packing(case) if dense else dilute_positions(container, radii_of(case))
    if nudge is not None:
        positions = nudged(positions, nudge)
    (folder / "particles.data").write_text(data_file(case, container, positions))
    (folder / "in.case").write_text(script_of(case, container, steps, grid, skin))
    if case.container == "mesh":
        for name, text in mesh_files(container).items():
            (folder / name).write_text(text)


def run_case(case, program, mpirun, folder, steps, ranks=1, threads=1, grid="* * *", skin=5e-4, nudge=None):
    """Writes the inputs and runs them; returns what the program printed, raises if it failed. nudge: seed
    of a change of every position by its last digit, or None."""
    write_inputs(case, folder, steps, grid, skin, nudge)
    command = [*mpirun, "-n", str(ranks), program, "-in", "in.case", "-log", "none"]
    done = subprocess.run(
        command,
        cwd=folder,
        env={**ENVIRONMENT, **os.environ, "OMP_NUM_THREADS": str(threads)},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        timeout=TIMEOUT,
        errors="replace",
        text=True,
        check=False,
    )
    if done.returncode != 0 or "ERROR" in done.stdout:
        raise RuntimeError(f"{case.name}: {' '.join(command)}: exit code {done.returncode}\n{done.stdout[-3000:]}")
    return done.stdout
