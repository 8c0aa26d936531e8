# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Strong scaling of the large bed beyond the cores at hand, from the work of each rank and thread.

More ranks than cores run one after the other, but the processor time of each can be measured (rank_work.cpp).
The slowest of them bounds the step: that is what a machine with as many cores would take at best."""

import re
import shutil
import sys
import tempfile
from pathlib import Path

from dem import AUTOMATIC, BEDS, Scene
from measure import ENVIRONMENT, GRANFLUX, ROOT, start

RANK_WORK = GRANFLUX.parents[1] / "tests/bench/libbench_rank_work.so"
COUNTS = (1, 2, 4, 8, 16, 32, 64)
# Those who wait give way to those who work.
GIVE_WAY = {"OMPI_MCA_mpi_yield_when_idle": "1", "OMP_WAIT_POLICY": "passive"}


def in_plane(count):
    """Cuts across the floor only, as square as can be: every rank has as many particles."""
    x = max(x for x in range(1, count + 1) if count % x == 0 and x * x <= count)
    return (x, count // x, 1)


def work_of(scene, program, threads, grid, ranks, steps, options=()):
    """({rank: seconds of its first thread and of the others, most first}, output) of a run. The MPI library has
    threads too, which hardly work."""
    file = scene.folder / "work.txt"
    file.unlink(missing_ok=True)
    environment = {**ENVIRONMENT, **GIVE_WAY, "GRANFLUX_RANK_WORK": str(file)}
    words = scene.words(program, grid, steps=steps)
    # mpirun itself must not be counted: the ranks alone are told.
    preload = ["env", f"LD_PRELOAD={RANK_WORK}"]
    options = ["-threads", str(threads), *options] if program == GRANFLUX else []
    output = start(scene.folder, *preload, str(program), *options, *words, ranks=ranks, environment=environment)
    lines = [line.split() for line in file.read_text().splitlines()]
    return {int(rank): [float(first)] + sorted(map(float, others), reverse=True)[:threads - 1]
            for rank, first, *others in lines}, output


def load_of(output):
    """The most particles and ghosts of a rank."""
    def most(name):
        return int(float(re.findall(rf"{name}: +\S+ ave (\S+) max", output)[-1]))
    return {"most_particles": most("Nlocal"), "most_ghosts": most("Nghost")}


def seconds_a_step(scene, program, threads, grid, ranks, steps, runs, options=()):
    """Of every rank and thread, where the script makes so many runs of `steps`; the start of the program falls out
    as what a short run takes."""
    short, _ = work_of(scene, program, threads, grid, ranks, steps[0], options)
    long, output = work_of(scene, program, threads, grid, ranks, steps[1], options)
    between = runs * (steps[1] - steps[0])
    found = [(b - a) / between for rank in long for a, b in zip(short[rank], long[rank])]
    return {"grid": " ".join(map(str, grid)), "slowest": max(found), "mean": sum(found) / len(found), **load_of(output)}


def scaling(quick, bed):
    if not RANK_WORK.exists():
        sys.exit(f"{RANK_WORK} is not there: build first")
    steps = (20, 60) if quick else (20, 120)
    nx, ny, nz = (64, 64, 36) if quick else BEDS[bed]
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        shutil.copy(ROOT / "tests/bench/dem/in.bed", folder)
        scene = Scene(folder, "in.bed", nx=nx, ny=ny, nz=nz)
        table = {}
        for count in COUNTS:
            grid = in_plane(count)
            ways = {
                "liggghts, automatic grid": ("liggghts", 1, AUTOMATIC, count),
                "liggghts, cut across the floor": ("liggghts", 1, grid, count),
                "granflux ranks, cut across the floor": (GRANFLUX, 1, grid, count),
                "granflux threads": (GRANFLUX, count, (1, 1, 1), 1),
            }
            table[count] = {name: seconds_a_step(scene, program, threads, cut, ranks, steps, runs=2)
                            for name, (program, threads, cut, ranks) in ways.items()}
            print(count, {name: f"{found['slowest']:.4f} s" for name, found in table[count].items()}, file=sys.stderr)
    one = table[1]["liggghts, cut across the floor"]["slowest"]
    for ways in table.values():
        for found in ways.values():
            found["speed_up_over_one_rank_of_liggghts"] = one / found["slowest"]
    return {"particles": nx * ny * nz, "steps": list(steps), "seconds_of_processor_a_step": table}
