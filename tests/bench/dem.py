# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Particles alone: the large bed and the kiln by granflux and by the packaged programs, in turns."""

import re
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from measure import GRANFLUX, ROOT, loop_seconds, measured_start, seconds_by_part, spread, start, timed_start

BEDS = {"quick": (96, 96, 36), "paper": (384, 384, 9), "larger": (768, 768, 9)}  # particles each way
QUICK_STEPS = {"quick": 100, "paper": 50, "larger": 25}
KILNS = {"section": 0.01524, "full": 0.0762}  # length, m
GRIDS = {"x": (2, 1, 1), "y": (1, 2, 1), "z": (1, 1, 2)}
AUTOMATIC = ("*", "*", "*")


def flag(program):
    return "-v" if program == "lmp" else "-var"


class Scene:
    """One input script in a folder, with its variables."""

    def __init__(self, folder, script, **variables):
        self.folder, self.script, self.variables = folder, script, variables
        self.lammps_script = script + ".lmp"

    def words(self, program, grid, **more):
        values = {**self.variables, **dict(zip(("px", "py", "pz"), grid)), **more}
        found = ["-in", self.lammps_script if program == "lmp" else self.script]
        for name, value in values.items():
            found += [flag(program), name, str(value)]
        return found

    def best_grid(self, program, steps):
        """The cut in two that takes least time, by short runs; and the seconds of each."""
        seconds = {}
        for name, grid in GRIDS.items():
            output = start(self.folder, program, *self.words(program, grid, steps=steps), ranks=2)
            seconds[name] = loop_seconds(output)
        return GRIDS[min(seconds, key=seconds.get)], seconds


def particles_and_ghosts(output):
    particles = int(re.findall(r"Loop time of .* with (\d+) atoms", output)[-1])
    ghosts = float(re.findall(r"Nghost: +([\d.]+) ave", output)[-1])
    return particles, ghosts


def compare(scene, steps, rounds, lammps):
    """Alternating rounds of all programs; medians of seconds and of the ratios of each round."""
    best, grid_seconds = scene.best_grid("liggghts", max(steps // 5, 1))
    one = (1, 1, 1)
    runs = {  # name: program, grid, ranks, options
        "liggghts 1 rank": ("liggghts", one, 1, []),
        "granflux 1 thread": (GRANFLUX, one, 1, ["-threads", "1"]),
        "liggghts 2 ranks, best grid": ("liggghts", best, 2, []),
        "granflux 2 threads": (GRANFLUX, one, 1, ["-threads", "2"]),
        "liggghts 2 ranks, automatic grid": ("liggghts", AUTOMATIC, 2, []),
        "granflux 2 ranks, best grid": (GRANFLUX, best, 2, ["-threads", "1"]),
    }
    if lammps:
        lammps_best, _ = scene.best_grid("lmp", max(steps // 5, 1))
        runs["lmp 1 rank"] = ("lmp", one, 1, [])
        runs["lmp 2 ranks, best grid"] = ("lmp", lammps_best, 2, [])
    loops, totals, ghosts, parts = ({name: [] for name in runs} for _ in range(4))
    particles = 0
    for i in range(rounds):
        for name, (program, grid, ranks, options) in runs.items():
            output, total = timed_start(scene.folder, program, *options,
                                        *scene.words(program, grid, steps=steps), ranks=ranks)
            loops[name].append(loop_seconds(output))
            totals[name].append(total)
            particles, count = particles_and_ghosts(output)
            ghosts[name].append(count)
            if program == GRANFLUX:
                parts[name].append(seconds_by_part(output, "particle work"))
        print(f"round {i + 1}/{rounds}: " +
              ", ".join(f"{name} {seconds[-1]:.2f} s" for name, seconds in loops.items()),
              file=sys.stderr)
    per_particle = 1e9 / (particles * steps)

    def ratio(ours, theirs):
        return spread([a / b for a, b in zip(loops[ours], loops[theirs])])

    ratios = {f"{ours} / {theirs}": ratio(ours, theirs) for ours, theirs in (
        ("granflux 1 thread", "liggghts 1 rank"),
        ("granflux 2 threads", "liggghts 2 ranks, best grid"),
        ("granflux 2 threads", "liggghts 2 ranks, automatic grid"),
        ("granflux 2 ranks, best grid", "liggghts 2 ranks, best grid"),
        *((("granflux 1 thread", "lmp 1 rank"),
           ("granflux 2 threads", "lmp 2 ranks, best grid")) if lammps else ()))}
    return {
        "particles": particles, "steps": steps, "rounds": rounds,
        "best_grid_of_liggghts": " ".join(map(str, best)),
        "seconds_by_cut_in_two_of_liggghts": grid_seconds,
        "ns_per_particle_step": {name: spread([s * per_particle for s in seconds])
                                 for name, seconds in loops.items()},
        "whole_program_seconds": {name: spread(seconds) for name, seconds in totals.items()},
        "ratios": ratios,
        "ghosts_a_rank": {name: statistics.median(counts) for name, counts in ghosts.items()},
        "parts_ns_per_particle_step": {
            name: {part: statistics.median([p[part] for p in found]) * per_particle
                   for part in found[0]} for name, found in parts.items() if found},
    }


def memory_per_particle(folder, cells):
    """Bytes by which two beds differ, over the particles by which they do."""
    nx, ny, nz = cells
    fewer, more = (Scene(folder, "in.bed", nx=nx, ny=ny, nz=layers) for layers in (nz // 3, nz))
    found = {}
    for name, program, options in (("liggghts", "liggghts", []), ("lmp", "lmp", []),
                                   ("granflux, 1 thread", GRANFLUX, ["-threads", "1"]),
                                   ("granflux, 2 threads", GRANFLUX, ["-threads", "2"])):
        bytes_ = [measured_start(folder, program, *options, *scene.words(program, (1, 1, 1), steps=20)).memory
                  for scene in (fewer, more)]
        found[name] = round((bytes_[1] - bytes_[0]) / (nx * ny * (nz - nz // 3)))
    return found


def dem(quick, bed, kiln):
    result = {}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for file in (ROOT / "tests/bench/dem").iterdir():
            shutil.copy(file, folder)
        if bed != "none":
            nx, ny, nz = BEDS[bed]
            scene = Scene(folder, "in.bed", nx=nx, ny=ny, nz=nz)
            result["large bed"] = compare(scene, steps=QUICK_STEPS[bed] if quick else 200,
                                          rounds=3 if quick else 5, lammps=True)
            result["memory of a particle, bytes"] = memory_per_particle(folder, BEDS["quick"])
        if kiln != "none":
            scene = Scene(folder, "in.kiln", length=KILNS[kiln])
            print("packing the kiln ...", file=sys.stderr)
            packed = Scene(folder, "in.kiln_packed", length=KILNS[kiln])
            start(folder, GRANFLUX, "-threads", "2",
                  *packed.words(GRANFLUX, (1, 1, 1), settle=10000 if quick else 30000))
            result["kiln, " + kiln] = compare(scene, steps=500 if quick else 2000,
                                              rounds=3 if quick else 5, lammps=False)
    return result
