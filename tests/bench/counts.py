# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What effects cost that are on, and those that are off: instructions, allocations, memory and files of small scenes.

Instructions and calls of the allocator are callgrind's, of the loop of steps alone; those of a step are a long loop
less a short one, and do not depend on what else the machine does. Largest heap and blocks of a whole run are DHAT's,
files that a run opens in its folder strace's. Programs must be built for any processor: valgrind does not know all
instructions of the newest.
"""

import re
import shutil
import sys
import tempfile
from pathlib import Path

from measure import ROOT, measured_start

PARTICLES, COUPLE_EVERY, STEPS = 729, 5, (40, 100)
CELLS = {"bed": (6, 6, 8), "gas": (12, 12, 16)}
GAS_STEPS = (4, 12)
LOOP = "granflux::particle_subset::Verlet::run(int)"
GAS_STEP = "granflux::cfd::GasSolver::advance(*"
ALLOCATOR = re.compile(r"(malloc|calloc|realloc|reallocarray|posix_memalign|aligned_alloc|memalign)(@.*)?$")

CASE = """
[grid]
size = [0.036, 0.036, 0.048]
cells = [{}, {}, {}]
[fluid]
density = 12
viscosity = 1.8e-5
{gravity}
{energy}
[[boundary]]
name = "inlet"
side = "z_low"
type = "inlet"
velocity = [0, 0, 0.5]
{inlet}
[[boundary]]
name = "outlet"
side = "z_high"
type = "outlet"
{walls}
[numerics]
time_step = 3e-4
end_time = {end_time}
[output]
fields = "gas"
every = 1000
"""
WALLS = "".join(f'[[boundary]]\nname = "{side}"\nside = "{side}"\ntype = "wall"\n'
                for side in ("x_low", "x_high", "y_low", "y_high"))
ENERGY = "[energy]\nconductivity = 0.026\ninitial_temperature = 300\nexpansion = 3e-3\n"

MOVE, FREEZE = "fix move all nve/sphere\n", "fix hold all freeze\n"
NO_WALLS = "".join(f"unfix {wall}\n" for wall in ("xl", "xh", "yl", "yh", "zl"))
EFFECTS_OF_HEAT = ("conduction", "friction", "damping", "gas_gap", "radiation")
EFFECTS_OF_GAS = ("drag", "pressure_gradient", "two_way")
CREATION = r"(?m)^(region +filled|lattice|create_atoms|set  |displace_atoms).*\n"


def heat(effects, data="gas_gap 0.03 radiation 300"):
    return f"fix heat all granflux/heat initial_temperature 300 {data} effects {effects}\n"


def gas(effects, case="cold.toml"):
    effects = f"effects {effects}" if effects else ""
    return f"fix gas all granflux/couple case {case} couple_every {COUPLE_EVERY} {effects}\n"


def scenes():
    """{name: (what it adds to plain particles, scene that it is compared with)}"""
    cold = "gas drag pressure_gradient two_way"
    all_heat = " ".join(EFFECTS_OF_HEAT)
    return {
        "plain particles": (MOVE, None),
        "dry: heat none": (MOVE + heat("none"), "plain particles"),
        "dry: gas none": (MOVE + gas("none"), "plain particles"),
        "dry: both none": (MOVE + heat("none") + gas("none", "warm.toml"), "plain particles"),
        "heat: all": (MOVE + heat(all_heat), "plain particles"),
        **{f"heat: {name}": (MOVE + heat(name), "plain particles") for name in EFFECTS_OF_HEAT},
        "heat: conduction friction": (MOVE + heat("conduction friction"), "plain particles"),
        "heat: conduction friction, not given the others' data":
            (MOVE + heat("conduction friction", ""), "heat: conduction friction"),
        "gas": (MOVE + gas("gas"), "plain particles"),
        **{f"gas {name}": (MOVE + gas(f"gas {name}"), "gas") for name in EFFECTS_OF_GAS},
        "cold bed": (MOVE + gas(""), "gas"),
        "cold bed by effects": (MOVE + gas(cold), "cold bed"),
        "cold bed, convection and buoyancy off": (MOVE + gas(cold, "warm.toml"), "cold bed by effects"),
        "isothermal, auto": (MOVE + heat("auto", "") + gas("auto", "warm.toml"), "cold bed by effects"),
        "warm bed: convection": (MOVE + heat("none") + gas(cold + " convection", "warm.toml"), "cold bed by effects"),
        "warm bed: convection buoyancy":
            (MOVE + heat("none") + gas(cold + " convection buoyancy", "warm.toml"), "warm bed: convection"),
        "all frozen": (FREEZE, "plain particles"),
        "all frozen, no walls": (FREEZE + NO_WALLS, "all frozen"),
        "all frozen, gas": (gas("") + FREEZE, "all frozen"),
        "all frozen, gas, no walls": (gas("") + FREEZE + NO_WALLS, "all frozen, gas"),
        "all frozen, heat: conduction": (heat("conduction", "") + FREEZE, "all frozen"),
    }


def calls(profile, wanted):
    """How often functions of such names are called from within what was collected."""
    names = dict(re.findall(r"^c?fn=\((\d+)\) (.*)$", profile, re.M))
    return sum(int(count) for number, count in re.findall(r"^cfn=\((\d+)\).*\ncalls=(\d+)", profile, re.M)
               if wanted.match(names[number]))


class Folder:
    def __init__(self, folder, programs):
        self.folder, self.programs = folder, programs

    def write_case(self, name, cells, **words):
        text = CASE.format(*cells, **{"walls": WALLS, "energy": "", "inlet": "", "gravity": "", "end_time": 1, **words})
        (self.folder / name).write_text(text)

    def write_script(self, scene, particles=True):
        script = (ROOT / "tests/bench/dem/in.counts").read_text().replace("SCENE\n", scene)
        (self.folder / "in.scene").write_text(script if particles else re.sub(CREATION, "", script).replace("sort 100", "sort 0"))

    def script_command(self, steps):
        return str(self.programs / "granflux"), "-threads", "1", "-in", "in.scene", "-var", "steps", str(steps)

    def start(self, command, *wrapper):
        for file in self.folder.glob("*.cgns"):
            file.unlink()
        return measured_start(self.folder, *command, wrapper=wrapper)

    def collected(self, command, within):
        """(instructions, calls of the allocator) within a function."""
        out = self.folder / "callgrind.out"
        self.start(command, "valgrind", "-q", "--tool=callgrind", f"--toggle-collect={within}",
                   f"--callgrind-out-file={out}")
        profile = out.read_text()
        return int(re.search(r"^summary: (\d+)", profile, re.M)[1]), calls(profile, ALLOCATOR)

    def heap(self, command):
        """(blocks allocated, most bytes held)"""
        log = self.folder / "dhat.log"
        self.start(command, "valgrind", "--tool=dhat", f"--log-file={log}", "--dhat-out-file=/dev/null")
        text = log.read_text().replace(",", "")
        return int(re.search(r"Total: +\d+ bytes in (\d+) blocks", text)[1]), int(
            re.search(r"At t-gmax: +(\d+) bytes", text)[1])

    def files(self, command):
        log = self.folder / "strace.log"
        self.start(command, "strace", "-f", "-qq", "-e", "trace=openat", "-o", str(log))
        opened = re.findall(r'AT_FDCWD, "([^"]+)", O_\S+.*\) = \d+', log.read_text())
        own = {Path(self.folder, name).resolve() for name in opened}
        return sorted(path.name for path in own if path.parent == self.folder.resolve())


def scene_counts(folder, scene):
    folder.write_script(scene)
    (short, calls_short), (long, calls_long) = (folder.collected(folder.script_command(n), LOOP) for n in STEPS)
    steps = STEPS[1] - STEPS[0]
    blocks, most = folder.heap(folder.script_command(STEPS[0]))
    return {"instructions_a_particle_step": (long - short) / steps / PARTICLES,
            "allocations_a_step": (calls_long - calls_short) / steps,
            "blocks_of_a_run": blocks, "largest_heap_bytes": most,
            "files": folder.files(folder.script_command(STEPS[0]))}


def gas_alone(folder):
    """Instructions a cell and gas step, of the gas itself and of all that the loop does."""
    cells = CELLS["gas"]
    count = cells[0] * cells[1] * cells[2] * (GAS_STEPS[1] - GAS_STEPS[0])
    gravity = "gravity = [0, 0, -9.81]"
    folder.write_script(MOVE + gas("", "alone.toml"), particles=False)
    result = {}
    for name, command in (("granflux_cfd", lambda n: (str(folder.programs / "granflux_cfd"), "alone.toml",
                                                      "--threads", "1")),
                          ("granflux, an empty box", lambda n: folder.script_command(n * COUPLE_EVERY))):
        found = []
        for steps in GAS_STEPS:
            folder.write_case("alone.toml", cells, gravity=gravity, end_time=3e-4 * steps)
            found.append((folder.collected(command(steps), GAS_STEP), folder.collected(command(steps), "main")))
        (gas_short, all_short), (gas_long, all_long) = found
        result[name] = {"gas_instructions_a_cell_step": (gas_long[0] - gas_short[0]) / count,
                        "program_instructions_a_cell_step": (all_long[0] - all_short[0]) / count,
                        "allocations_of_the_gas_a_gas_step": (gas_long[1] - gas_short[1]) / (GAS_STEPS[1] - GAS_STEPS[0])}
    return result


def require(programs):
    for program in ("valgrind", "strace"):
        if not shutil.which(program):
            sys.exit(f"{program} is not there: install Debian's package {program}")
    for program in ("granflux", "granflux_cfd"):
        if not (programs / program).exists():
            sys.exit(f"{programs / program} is not there: build with -DGRANFLUX_NATIVE=OFF, and give its bin as --programs")


def counts(programs, only, done, keep):
    """Takes up `done`; `keep` is called with all that is known after each scene."""
    require(programs)
    version = measured_start(ROOT, programs / "granflux_cfd", "--version").output.strip()
    result = {"programs": version, "particles": PARTICLES, "couple_every": COUPLE_EVERY, "steps": STEPS, "cells": CELLS,
              "scenes": dict(done.get("scenes", {}))}
    if "gas_alone" in done:
        result["gas_alone"] = done["gas_alone"]
    with tempfile.TemporaryDirectory() as name:
        folder = Folder(Path(name), programs)
        folder.write_case("cold.toml", CELLS["bed"])
        folder.write_case("warm.toml", CELLS["bed"], energy=ENERGY, inlet="temperature = 300")
        for scene, (lines, reference) in scenes().items():
            if scene in result["scenes"] or not re.search(only, scene):
                continue
            result["scenes"][scene] = {"beside": reference, **scene_counts(folder, lines)}
            print(f"{scene}: {result['scenes'][scene]}", file=sys.stderr)
            keep(result)
        if "gas_alone" not in result and re.search(only, "gas alone"):
            result["gas_alone"] = gas_alone(folder)
            keep(result)
    return result
