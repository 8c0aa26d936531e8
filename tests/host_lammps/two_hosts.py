# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The bed of the host tests as scripts for LAMMPS and for LIGGGHTS, with the same particles from one
data file, so that neither host numbers or places them by its own rules.

CTest sets GRANFLUX_LAMMPS, and GRANFLUX (may be empty) as host.py wants it.
"""

import math
import os

from host import HostTest

GRANFLUX_LAMMPS = os.environ["GRANFLUX_LAMMPS"]

DIAMETER, DENSITY = 1e-3, 1000.0
MASS = DENSITY * math.pi / 6 * DIAMETER**3
STIFFNESS, TANGENTIAL_STIFFNESS, FRICTION = 500.0, 140.0, 0.3
# Of two spheres as of a sphere and a wall; times half a mass or a whole one [1/s].
DAMPING, TANGENTIAL_DAMPING = 3000.0, 3000.0
TIME_STEP = 1e-5


def ramp(low, high, x, x_low, x_high):
    return low + (high - low) * min(1.0, max(0.0, (x - x_low) / (x_high - x_low)))


def spheres():
    """180 rows of position and velocity: a lattice above the floor of a box of 10 x 6 x 40 mm, with
    velocities that make them collide."""
    rows = []
    for k in range(4):
        for j in range(5):
            for i in range(9):
                x, y, z = 1.1e-3 * (i + 0.45), 1.1e-3 * (j + 0.45), 1.1e-3 * (k + 0.6)
                v = (
                    ramp(-0.2, 0.2, z, 0, 4e-3),
                    ramp(-0.1, 0.3, x, 0, 10e-3),
                    ramp(0.2, -0.3, y, 0, 6e-3),
                )
                rows.append(((x, y, z), v))
    return rows


def data_file(rows):
    text = f"spheres\n\n{len(rows)} atoms\n1 atom types\n\n"
    text += "0 10e-3 xlo xhi\n0 6e-3 ylo yhi\n0 40e-3 zlo zhi\n\nAtoms\n\n"
    for i, (x, _) in enumerate(rows, 1):
        text += f"{i} 1 {DIAMETER} {DENSITY} {x[0]!r} {x[1]!r} {x[2]!r}\n"
    text += "\nVelocities\n\n"
    for i, (_, v) in enumerate(rows, 1):
        text += f"{i} {v[0]!r} {v[1]!r} {v[2]!r} 0 0 0\n"
    return text


def lammps_bed(history=True, source="read_data spheres.data", newton="off"):
    """A script of LAMMPS up to the gas; `history`: friction with tangential springs, else none."""
    style = "hooke/history" if history else "hooke"
    kt, gt, mu, flag = (
        (TANGENTIAL_STIFFNESS, TANGENTIAL_DAMPING, FRICTION, 1) if history else (0, 0, 0, 0)
    )
    law = f"{style} {STIFFNESS} {kt} {DAMPING} {gt} {mu} {flag}"
    return f"""
units           si
atom_style      sphere
atom_modify     map array
boundary        f f f
newton          {newton}
comm_modify     vel yes
processors      * * 1
{source}
pair_style      gran/{law}
pair_coeff      * *
neighbor        3e-4 bin
neigh_modify    delay 0
fix             floor all wall/gran {law} zplane 0 NULL
fix             xwalls all wall/gran {law} xplane 0 10e-3
fix             ywalls all wall/gran {law} yplane 0 6e-3
fix             gravity all gravity 9.81 vector 0 0 -1
fix             move all nve/sphere
timestep        {TIME_STEP}
compute         kinetic all ke
"""


def liggghts_bed(history=True):
    """The same for LIGGGHTS."""
    tangential = "tangential history" if history else ""
    walls = ""
    for name, plane in [
        ("zlow", "zplane 0"),
        ("xlow", "xplane 0"),
        ("xhigh", "xplane 10e-3"),
        ("ylow", "yplane 0"),
        ("yhigh", "yplane 6e-3"),
    ]:
        walls += f"fix {name} all wall/gran model hooke/stiffness {tangential} primitive type 1 {plane}\n"
    return f"""
units           si
atom_style      granular
atom_modify     map array
boundary        f f f
newton          off
communicate     single vel yes
processors      * * 1
read_data       spheres.data
fix             kn all property/global kn peratomtypepair 1 {STIFFNESS}
fix             kt all property/global kt peratomtypepair 1 {TANGENTIAL_STIFFNESS}
fix             gn all property/global gamman peratomtypepair 1 {DAMPING}
fix             gt all property/global gammat peratomtypepair 1 {TANGENTIAL_DAMPING}
fix             mu all property/global coefficientFriction peratomtypepair 1 {FRICTION}
pair_style      gran model hooke/stiffness {tangential}
pair_coeff      * *
neighbor        3e-4 bin
neigh_modify    delay 0
{walls}fix      gravity all gravity 9.81 vector 0 0 -1
fix             move all nve/sphere
timestep        {TIME_STEP}
compute         kinetic all ke
"""


# Every digit; residuals of void volume, momentum, gas mass, gas momentum last.
THERMO = """
thermo_style    custom step atoms c_kinetic f_gas[1] f_gas[4] f_gas[8] f_gas[16] f_gas[17] &
                f_gas[10] f_gas[11] f_gas[12] f_gas[13]
thermo_modify   lost {lost} norm no format float %.17g
thermo          {every}
"""
KINETIC, PRESSURE_DROP, DRAG, VOID_FRACTION, COUPLED = 2, 3, 4, 5, 6


def thermo(every=20, lost="error"):
    return THERMO.format(every=every, lost=lost)


DUMP = """
dump            d all custom {every} {name} id x y z vx vy vz omegax omegay omegaz
dump_modify     d sort id format {of_line}"%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
"""


def dump(name, every=50, lammps=True):
    return DUMP.format(name=name, every=every, of_line="line " if lammps else "")


class TwoHostTest(HostTest):
    """Each test works in a folder of its own, with the particles in spheres.data."""

    def setUp(self):
        super().setUp()
        self.write("spheres.data", data_file(spheres()))

    def run_lammps(self, script, ranks=1, options=()):
        return self.run_script(script, ranks, GRANFLUX_LAMMPS, options)

    def start_lammps(self, script, ranks=1, options=()):
        return self.start(script, ranks, GRANFLUX_LAMMPS, options)
