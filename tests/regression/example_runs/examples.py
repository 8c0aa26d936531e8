# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every example in short, and what it leaves: a dump of some of its particles or gas cells."""

import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "examples/rotary_kiln"))

MOTION = "id x y z vx vy vz omegax omegay omegaz"
WITH_GAS = MOTION + " f_dragforce[1] f_dragforce[2] f_dragforce[3] f_voidfraction"
GAS_FIELDS = ("VelocityX", "VelocityY", "VelocityZ", "Pressure")


@dataclasses.dataclass
class Example:
    """`files`: of the example's folder. `edits`: (file, regular expression, what stands there in the short form); each must be
    found. `script`: what runs, and `before`: what runs first. `columns`: of the dump; empty: a case of the gas alone."""

    files: tuple
    script: str
    before: str = ""
    variables: dict = dataclasses.field(default_factory=dict)
    edits: tuple = ()
    columns: str = WITH_GAS
    program: str = "GRANFLUX"
    every: int = 20  # one particle or cell in so many is kept


# A few dozen steps: rounding has not grown yet, and any change of a law or a scheme shows.
EXAMPLES = {
    "fluidized_bed": Example(
        files=("in.*", "bed_U0.9.toml"), script="in.bed", variables={"time": 5e-4},
        edits=(("in.settle", r"run +16000", "run 100"),)),
    "fluidized_bed_lammps": Example(
        files=("lammps/in.*", "bed_U0.9.toml"), script="in.bed", variables={"time": 5e-4}, columns="id x y z vx vy vz",
        edits=(("in.settle", r"run +16000", "run 100"),), program="GRANFLUX_LAMMPS"),
    "hot_bed": Example(
        files=("in.hot_bed", "hot_bed.toml"), script="in.hot_bed", variables={"time": 1e-3}, columns=WITH_GAS + " f_Temp",
        edits=(("in.hot_bed", r"run +12500", "run 100"),), every=4),
    "rotary_kiln": Example(
        files=("in.*", "end.stl", "kiln.toml"), before="in.settle", script="in.kiln", columns=WITH_GAS + " f_Temp",
        variables={"settling": 2e-3, "time": 2e-3, "every": 1e-3, "report": 1e-3}, every=40),
    "large_bed": Example(
        files=("in.large_bed", "gas_small.toml"), script="in.large_bed", every=600,
        variables={"floor": 192, "case": "gas_small", "mixing": 8 * 6e-5, "timed": 8, "every": 8}),
    "lid_driven_cavity": Example(
        files=("cavity.toml",), script="cavity.toml", columns="",
        edits=(("cavity.toml", "end_time = .*", "end_time = 0.06"), ("cavity.toml", "every = .*", "every = 0.06"))),
    "cylinder_flow": Example(
        files=("cylinder.toml",), script="cylinder.toml", columns="",
        edits=(("cylinder.toml", "end_time = .*", "end_time = 0.1"), ("cylinder.toml", "every = .*", "every = 0.1"))),
}


def folder_of(name):
    return ROOT / "examples" / name.removesuffix("_lammps")


def run_example(name, folder):
    """Runs the short form in `folder`; returns the text of its dump. GRANFLUX and others: the programs."""
    example = EXAMPLES[name]
    for pattern in example.files:
        for path in folder_of(name).glob(pattern):
            shutil.copy(path, folder)
    for file, old, new in example.edits:
        text, found = re.subn(old, new, (folder / file).read_text())
        if not found:
            raise RuntimeError(f"{name}: {file} has no {old}")
        (folder / file).write_text(text)
    if not example.columns:
        start([os.environ["GRANFLUX_CFD"], example.script], folder)
        return gas_dump(sorted(folder.glob("gas_*.cgns"))[-1], example.every)
    with open(folder / example.script, "a") as script:
        line = "line " if example.program == "GRANFLUX_LAMMPS" else ""
        numbers = len(example.columns.split()) - 1
        script.write(f"\ndump reference all custom 1 reference.dump {example.columns}\n"
                     f'dump_modify reference sort id format {line}"%d{" %.17g" * numbers}"\nrun 0\n')
    variables = [word for key, value in example.variables.items() for word in ("-var", key, str(value))]
    for script in filter(None, (example.before, example.script)):
        start([os.environ[example.program], "-in", script, *variables], folder)
    return thinned((folder / "reference.dump").read_text(), example.every)


def start(command, folder):
    alone = {"OMP_NUM_THREADS": "1", "OMPI_MCA_ess_singleton_isolated": "1"}
    done = subprocess.run(command, cwd=folder, env=os.environ | alone, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace")
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout[-3000:]}")


def rounded(words):
    return " ".join([words[0], *(f"{float(word):.12g}" for word in words[1:])])


def thinned(dump, every):
    """The last snapshot of a dump with one line in `every`, and 12 digits."""
    head, atoms = dump[dump.rindex("ITEM: TIMESTEP"):].split("ITEM: ATOMS")
    columns, *lines = atoms.strip().splitlines()
    return snapshot(head, columns, [rounded(line.split()) for line in lines[::every]])


def snapshot(head, columns, rows):
    head = re.sub(r"(ITEM: NUMBER OF ATOMS\n)\d+", rf"\g<1>{len(rows)}", head)
    return head + f"ITEM: ATOMS {columns.strip()}\n" + "\n".join(rows) + "\n"


def gas_dump(path, every):
    """Cells of a CGNS file as lines of a dump."""
    import kiln

    gas = kiln.gas(path)
    columns = ("x", "y", "z", *(name for name in GAS_FIELDS if name in gas))
    rows = [" ".join([str(cell + 1), *(f"{gas[name][cell]:.12g}" for name in columns)])
            for cell in range(0, len(gas["x"]), every)]
    head = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS ff ff ff\n" + "0 1\n" * 3
    return snapshot(head, "id " + " ".join(columns), rows)
