# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Runs of the programs granflux and liggghts on scripts given as text.

CTest sets GRANFLUX, LIGGGHTS (may be empty) and MPIRUN.
"""

import os
import pathlib
import shlex
import subprocess
import tempfile
import unittest

GRANFLUX = os.environ["GRANFLUX"]
LIGGGHTS = os.environ.get("LIGGGHTS", "")
MPIRUN = shlex.split(os.environ["MPIRUN"])
TIMEOUT = 90  # s; a run that takes longer hangs
# One rank alone needs no mpirun, which takes its time to start, and two seconds more to end a program that
# failed; nor the daemon that Open MPI starts for a program without mpirun.
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1"}

# Contacts and neighbour lists of spheres of 1 mm.
MATERIAL = """fix             kn all property/global kn peratomtypepair 1 500
fix             kt all property/global kt peratomtypepair 1 140
fix             gn all property/global gamman_abs peratomtypepair 1 2e-3
fix             gt all property/global gammat_abs peratomtypepair 1 2e-3
fix             mu all property/global coefficientFriction peratomtypepair 1 0.3
pair_style      gran model hooke/stiffness tangential history absolute_damping on
pair_coeff      * *
neighbor        3e-4 bin
neigh_modify    delay 0
"""

# 180 spheres above the floor of a box of 10 x 6 x 40 mm, with velocities that make them collide. No
# random numbers: those of LIGGGHTS depend on the number of ranks.
BED = (
    """
units           si
atom_style      granular
atom_modify     map array
boundary        {boundary}
newton          off
communicate     single vel yes
processors      * * 1
region          box block 0 10e-3 0 6e-3 0 40e-3 units box
create_box      1 box
lattice         sc 1.1e-3 origin 0.45 0.45 {bottom}
region          filled block 0 9.9e-3 0 5.5e-3 0 4.4e-3 units box
create_atoms    1 region filled
set             group all diameter 1e-3 density 1000
velocity        all ramp vx -0.2 0.2 z 0 4e-3 units box
velocity        all ramp vy -0.1 0.3 x 0 10e-3 sum yes units box
velocity        all ramp vz 0.2 -0.3 y 0 6e-3 sum yes units box
"""
    + MATERIAL
    + """fix             zlow all wall/gran model hooke/stiffness tangential history &
                primitive type 1 zplane 0 absolute_damping on
fix             xlow all wall/gran model hooke/stiffness tangential history &
                primitive type 1 xplane 0 absolute_damping on
fix             xhigh all wall/gran model hooke/stiffness tangential history &
                primitive type 1 xplane 10e-3 absolute_damping on
fix             ylow all wall/gran model hooke/stiffness tangential history &
                primitive type 1 yplane 0 absolute_damping on
fix             yhigh all wall/gran model hooke/stiffness tangential history &
                primitive type 1 yplane 6e-3 absolute_damping on
fix             gravity all gravity 9.81 vector 0 0 -1
fix             move all nve/sphere
timestep        1e-5
thermo_modify   lost error norm no
"""
)

CASE = """
[grid]
size = [10e-3, 6e-3, 40e-3]
cells = [5, 3, 20]
[fluid]
density = 1.2
viscosity = 1.8e-5
[[boundary]]
name = "inlet"
side = "z_low"
type = "inlet"
velocity = [0, 0, 0.5]
[[boundary]]
name = "outlet"
side = "z_high"
type = "outlet"
[[boundary]]
name = "left"
side = "x_low"
type = "wall"
[[boundary]]
name = "right"
side = "x_high"
type = "wall"
[[boundary]]
name = "front"
side = "y_low"
type = "wall"
[[boundary]]
name = "back"
side = "y_high"
type = "wall"
"""

# Thermo output with every digit; residuals of void volume, momentum, gas mass, gas momentum last.
THERMO = """
variable        momentum equal vcm(all,z)*mass(all)
thermo_style    custom step atoms ke v_momentum f_gas[1] f_gas[4] f_gas[8] f_gas[16] f_gas[17] &
                f_gas[10] f_gas[11] f_gas[12] f_gas[13]
thermo_modify   lost {lost} norm no format float %.17g
thermo          {every}
"""

DUMP = """
dump            d all custom {every} {name} id x y z vx vy vz omegax omegay omegaz
dump_modify     d sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
"""


def bed(bottom=0.6, boundary="f f f"):
    return BED.format(bottom=bottom, boundary=boundary)


def bed_from(restart_file):
    """The bed without box and particles, which come from a restart file."""
    before, after = [], []
    for line in bed().replace("&\n", "").splitlines():
        command = line.split()[:1]
        if command in (["region"], ["create_box"], ["lattice"], ["create_atoms"], ["set"], ["velocity"]):
            continue
        (after if after or command == ["fix"] else before).append(line)
    return "\n".join([*before, f"read_restart {restart_file}", *after]) + "\n"


def thermo(every=20, lost="error"):
    return THERMO.format(every=every, lost=lost)


def dump(name, every=50):
    return DUMP.format(name=name, every=every)


def couple(every=10, more=""):
    return f"fix gas all granflux/couple case case.toml couple_every {every} {more}\n"


class HostTest(unittest.TestCase):
    """Each test works in a folder of its own."""

    def setUp(self):
        self.folder_ = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder_.cleanup)
        self.folder = pathlib.Path(self.folder_.name)
        self.write("case.toml", CASE)

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def read(self, name):
        return (self.folder / name).read_text()

    def start(self, script, ranks=1, program=GRANFLUX, options=()):
        """Runs a script; returns (exit code, all output)."""
        self.write("in.test", script)
        return self.launch(program, ["-in", "in.test", *options], ranks)

    def launch(self, program, words, ranks=1):
        """Runs a program; returns (exit code, all output)."""
        launch = [*MPIRUN, "--timeout", str(TIMEOUT), "-n", str(ranks)] if ranks > 1 else []
        done = subprocess.run(
            [*launch, program, *words],
            cwd=self.folder,
            env=os.environ if launch else os.environ | ALONE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            timeout=TIMEOUT + 20,
            errors="replace",
            text=True,
        )
        return done.returncode, done.stdout

    def start_limited(self, script, limit, ranks=1):
        """start() under a limit of the shell on each rank, such as "ulimit -f 100;" (KiB a file)."""
        self.write("in.test", script)
        return self.launch("bash", ["-c", f"{limit} exec {GRANFLUX} -in in.test"], ranks)

    def run_script(self, script, ranks=1, program=GRANFLUX, options=()):
        code, output = self.start(script, ranks, program, options)
        self.assertEqual(code, 0, output)
        self.assertNotIn("ERROR", output)
        return output

    def closed_books(self, output, gas_momentum=1e-10):
        """Rows of an output with thermo(); void volume, momentum and gas mass must close in each."""
        rows = thermo_rows(output)
        self.assertGreater(len(rows), 2, output)
        for row in rows:
            void_volume, momentum, gas_mass, of_the_gas = row[-4:]
            self.assertLess(void_volume, 1e-12)
            self.assertLess(momentum, 1e-12)
            self.assertLess(gas_mass, 1e-9)
            self.assertLess(of_the_gas, gas_momentum)
        return rows


def thermo_rows(output):
    """Rows of all thermo tables of an output, as lists of numbers; other lines between are skipped."""
    rows, width = [], 0
    for line in output.splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            width = len(words)
        elif not words:
            width = 0
        elif len(words) == width:
            try:
                rows.append([float(word) for word in words])
            except ValueError:
                pass
    return rows


def last_snapshot(text):
    """{id: [numbers]} of the last time in a dump."""
    atoms = {}
    for line in text.rsplit("ITEM: ATOMS", 1)[1].splitlines()[1:]:
        words = line.split()
        atoms[int(words[0])] = [float(word) for word in words[1:]]
    return atoms


def largest_difference(a, b, columns=9):
    """Largest difference of two snapshots, column by column relative to the column's largest value."""
    assert a.keys() == b.keys()
    largest = 0.0
    for c in range(columns):
        scale = max(abs(row[c]) for row in a.values()) or 1.0
        largest = max(largest, max(abs(a[i][c] - b[i][c]) for i in a) / scale)
    return largest
