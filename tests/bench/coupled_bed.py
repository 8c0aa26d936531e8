# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The small bed, packed, with gas beside plain `liggghts` without."""

import re
import shutil
import statistics
import sys
import tempfile
from pathlib import Path

from measure import GRANFLUX, ROOT, loop_seconds, seconds_by_part, spread, start

PLAIN = """
include in.particles
read_restart settled.restart
variable restitution equal 0.98
include in.contacts
fix gravity all gravity 9.81 vector 0 0 -1
fix integration all nve/sphere
thermo 100000
timestep 5e-6
run {steps}
"""
COUPLED = PLAIN.replace("thermo 100000", "fix gas all granflux/couple case bed.toml couple_every 10\n"
                        "thermo 100000")


def coupled_bed(quick):
    particles, cells, couple_every = 9240, 768, 10
    # The inlet's ramp does not lift the bed within these steps, so both programs see the same contacts.
    steps, rounds = (1000, 3) if quick else (4000, 7)
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for file in (ROOT / "examples/fluidized_bed").glob("*.toml"):
            text = re.sub(r"\n\[output\].*", "\n", file.read_text(), flags=re.S)
            (folder / file.name).write_text(text)
        for file in (ROOT / "examples/fluidized_bed").glob("in.*"):
            shutil.copy(file, folder)
        shutil.copy(folder / "bed_U0.9.toml", folder / "bed.toml")
        header = "variable skin index 3e-4\n"
        (folder / "in.plain").write_text(header + PLAIN.format(steps=steps))
        (folder / "in.coupled").write_text(header + COUPLED.format(steps=steps))
        print("packing the bed ...", file=sys.stderr)
        start(folder, GRANFLUX, "-in", "in.settle")
        plain, coupled, parts = [], [], []
        for i in range(rounds):  # alternating, so that a busy machine hits both
            plain.append(loop_seconds(start(folder, "liggghts", "-in", "in.plain")))
            output = start(folder, GRANFLUX, "-in", "in.coupled")
            coupled.append(loop_seconds(output))
            parts.append(seconds_by_part(output, "time of the run"))
            print(f"round {i + 1}/{rounds}: liggghts {plain[-1]:.2f} s, granflux {coupled[-1]:.2f} s",
                  file=sys.stderr)
    per_particle = 1e9 / (particles * steps)
    ratio = [c / p for c, p in zip(coupled, plain)]
    share = [100 * p["exchange"] / c for p, c in zip(parts, coupled)]
    force = [100 * p["fluid force"] / c for p, c in zip(parts, coupled)]
    gas = [1e9 * p["gas"] / (cells * steps / couple_every) for p in parts]
    return {
        "case": f"small bed, packed, {particles} particles, {cells} cells, U 0.9 m/s, {steps} steps, "
                f"couple_every {couple_every}, 1 rank, 1 thread",
        "rounds": rounds,
        "liggghts_ns_per_particle_step": spread([s * per_particle for s in plain]),
        "granflux_ns_per_particle_step": spread([s * per_particle for s in coupled]),
        "granflux_over_liggghts": spread(ratio),
        "gas_ns_per_cell_step": spread(gas),
        "exchange_percent_of_run": spread(share),
        "fluid_force_percent_of_run": spread(force),
        "granflux_parts_ns_per_particle_step": {
            name: statistics.median([p[name] for p in parts]) * per_particle for name in parts[0]},
    }
