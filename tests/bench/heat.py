# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What heat in contacts costs: the large bed with and without temperatures, by granflux and by the
packaged program, in turns."""

import re
import statistics
import sys
import tempfile
from pathlib import Path

from measure import GRANFLUX, ROOT, loop_seconds, measured_start, spread

PROPERTIES = """
fix tk all property/global thermalConductivity peratomtype 1
fix tc all property/global thermalCapacity peratomtype 840
fix yo all property/global youngsModulusOriginal peratomtype 70e9
fix pr all property/global poissonsRatio peratomtype 0.25
"""
OWN = PROPERTIES + "fix heat all granflux/heat initial_temperature 300 conduction hertz friction slider\n"
EVERY_5 = OWN.replace("slider\n", "slider heat_every 5\n")  # a contact lasts 12 steps here
SAMPLED = OWN.replace("slider\n", "slider heat_every 5 work sampled\n")
STOCK = PROPERTIES + "fix heat all heat/gran/conduction initial_temperature 300.\n"


def heat(quick):
    cells = (48, 48, 36) if quick else (96, 96, 36)
    steps, rounds = (60, 5) if quick else (150, 9)
    bed = (ROOT / "tests/bench/dem/in.bed").read_text()
    place = bed.index("fix             move all nve/sphere")
    words = {"nx": cells[0], "ny": cells[1], "nz": cells[2], "steps": steps, "px": 1, "py": 1, "pz": 1}
    variables = [word for name, value in words.items() for word in ("-var", name, str(value))]
    runs = {
        "granflux, 1 thread": ("", GRANFLUX, ["-threads", "1"]),
        "granflux with heat, 1 thread": (OWN, GRANFLUX, ["-threads", "1"]),
        "granflux with heat every 5 steps, 1 thread": (EVERY_5, GRANFLUX, ["-threads", "1"]),
        "granflux with heat every 5 steps, sampled, 1 thread": (SAMPLED, GRANFLUX, ["-threads", "1"]),
        "granflux, 2 threads": ("", GRANFLUX, ["-threads", "2"]),
        "granflux with heat, 2 threads": (OWN, GRANFLUX, ["-threads", "2"]),
        "granflux with heat every 5 steps, 2 threads": (EVERY_5, GRANFLUX, ["-threads", "2"]),
        "granflux with heat every 5 steps, sampled, 2 threads": (SAMPLED, GRANFLUX, ["-threads", "2"]),
        "liggghts": ("", "liggghts", []),
        "liggghts with conduction": (STOCK, "liggghts", []),
    }
    loops, cpu = {name: [] for name in runs}, {name: [] for name in runs}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for i in range(rounds):
            for name, (lines, program, options) in runs.items():
                (folder / "in.test").write_text(bed[:place] + lines + bed[place:])
                run = measured_start(folder, program, *options, "-in", "in.test", *variables)
                loops[name].append(loop_seconds(run.output))
                cpu[name].append(run.cpu)
            print(f"round {i + 1}/{rounds}: " + ", ".join(f"{n} {s[-1]:.2f} s" for n, s in loops.items()),
                  file=sys.stderr)
    particles = int(re.findall(r"Loop time of .* with (\d+) atoms", run.output)[-1])

    def more(seconds, name, plain):
        return spread([100 * (a / b - 1) for a, b in zip(seconds[name], seconds[plain])])

    pairs = {"liggghts with conduction": "liggghts"}
    for threads in ("1 thread", "2 threads"):
        for kind in ("heat", "heat every 5 steps", "heat every 5 steps, sampled"):
            pairs[f"granflux with {kind}, {threads}"] = f"granflux, {threads}"
    return {
        "particles": particles, "steps": steps, "rounds": rounds,
        "ns_per_particle_step": {name: statistics.median(s) * 1e9 / particles / steps for name, s in loops.items()},
        "percent_more_of_the_loop": {name: more(loops, name, plain) for name, plain in pairs.items()},
        "percent_more_cpu_of_the_program": {name: more(cpu, name, plain) for name, plain in pairs.items()},
    }
