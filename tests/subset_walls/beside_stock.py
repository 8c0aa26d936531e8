# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The same script by `liggghts` and by `granflux` on any mix of ranks and threads, dump by dump."""

import unittest

from host import LIGGGHTS, HostTest

MIXES = [(1, 1), (1, 2), (2, 1), (2, 2)]  # ranks, threads
FIRST, LATER = 1e-12, 1e-10  # after one step and after 100: relative to a column's largest value

# Spheres of two sizes and two types on a lattice, flying apart in all directions; no random numbers:
# those of LIGGGHTS depend on the number of ranks.
SPHERES = """
units           si
atom_style      granular
atom_modify     map array sort 20 0.0
boundary        f f f
newton          off
communicate     single vel yes
processors      * * *
region          box block -12e-3 12e-3 -12e-3 12e-3 -12e-3 12e-3 units box
create_box      2 box
lattice         sc {spacing}
region          filled block -9e-3 9e-3 -9e-3 9e-3 -9e-3 9e-3 units box
create_atoms    1 region filled
region          right block 0 12e-3 INF INF INF INF units box
group           right region right
set             group all diameter 1e-3 density 1000
set             group right type 2 diameter 1.2e-3 density 2500
velocity        all ramp vx -1.7 1.6 z -9e-3 9e-3 units box
velocity        all ramp vy -1.5 1.8 x -9e-3 9e-3 sum yes units box
velocity        all ramp vz 1.6 -1.9 y -9e-3 9e-3 sum yes units box
neighbor        3e-4 bin
neigh_modify    delay 0
timestep        1e-5
"""

STIFFNESS = """
fix             kn all property/global kn peratomtypepair 2 500 600 600 800
fix             kt all property/global kt peratomtypepair 2 140 150 150 170
fix             gn all property/global gamman_abs peratomtypepair 2 2e-3 3e-3 3e-3 4e-3
fix             gt all property/global gammat_abs peratomtypepair 2 2e-3 1e-3 1e-3 2e-3
fix             mu all property/global coefficientFriction peratomtypepair 2 0.3 0.4 0.4 0.2
pair_style      gran model hooke/stiffness tangential history absolute_damping on
pair_coeff      * *
"""
STIFFNESS_WALL = ("fix {id} all wall/gran model hooke/stiffness tangential history {wall} "
                  "absolute_damping on\n")

YOUNG = """
fix             Y all property/global youngsModulus peratomtype 5e6 6e6
fix             nu all property/global poissonsRatio peratomtype 0.45 0.3
fix             e all property/global coefficientRestitution peratomtypepair 2 0.7 0.6 0.6 0.5
fix             mu all property/global coefficientFriction peratomtypepair 2 0.3 0.4 0.4 0.2
fix             roll all property/global coefficientRollingFriction peratomtypepair 2 0.1 0.2 0.2 0.1
fix             pull all property/global cohesionEnergyDensity peratomtypepair 2 1e4 2e4 2e4 1e4
fix             vel all property/global characteristicVelocity scalar 2.
pair_style      gran model {model}
pair_coeff      * *
"""
YOUNG_WALL = "fix {id} all wall/gran model {model} {wall}\n"

DUMP = """
dump            first all custom 1 {first} {columns}
dump_modify     first sort id format "{numbers}"
run             1
undump          first
dump            later all custom {every} {later} {columns}
dump_modify     later sort id format "{numbers}" first yes
run             {steps}
"""
COLUMNS = "id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz".split()


def run_and_dump(steps=99, every=33):
    return DUMP.format(first="first.txt", later="later.txt", columns=" ".join(COLUMNS), steps=steps,
                       every=every, numbers="%d" + " %.17g" * (len(COLUMNS) - 1))


def snapshots(text):
    """[{id: [numbers]}] of each time in a dump."""
    found = []
    for part in text.split("ITEM: ATOMS")[1:]:
        lines = part.split("ITEM: TIMESTEP")[0].splitlines()[1:]
        rows = (line.split() for line in lines)
        found.append({int(words[0]): [float(w) for w in words[1:]] for words in rows})
    return found


def vector_differences(a, b):
    """Largest difference of each vector x, v, omega, f, torque over its largest component."""
    assert a.keys() == b.keys()
    found = []
    for first in range(0, len(COLUMNS) - 1, 3):
        columns = range(first, first + 3)
        scale = max(abs(row[c]) for row in a.values() for c in columns) or 1.0
        found.append(max(abs(a[i][c] - b[i][c]) for i in a for c in columns) / scale)
    return found


@unittest.skipUnless(LIGGGHTS, "the stock program liggghts is not installed")
class BesideStock(HostTest):
    def run_mix(self, script, ranks, threads, options=()):
        return self.run_script(script, ranks, options=["-threads", str(threads), *options])

    def check(self, script, mixes=MIXES, first=FIRST, later=LATER):
        """Runs `script`, which ends with run_and_dump(), by both programs. Returns their output."""
        outputs, stock = {}, {}
        for ranks, threads in mixes:
            if ranks not in stock:
                stock_output = self.run_script(script, ranks, LIGGGHTS)
                stock[ranks] = (stock_output, self.read("first.txt"), self.read("later.txt"))
            output = self.run_mix(script, ranks, threads)
            outputs[ranks, threads] = (stock[ranks][0], output)
            for name, reference, tolerance in zip(("first.txt", "later.txt"), stock[ranks][1:],
                                                  (first, later)):
                self.assertIn("ITEM: ATOMS", reference)
                text = self.read(name)
                if text == reference:
                    continue
                pairs = zip(snapshots(reference), snapshots(text), strict=True)
                for expected, found in pairs:
                    differences = vector_differences(expected, found)
                    self.assertLessEqual(max(differences), tolerance,
                                         f"{name}, {ranks} ranks, {threads} threads: {differences}")
        return outputs

    def wall_contacts(self):
        """Particles that turn in the last snapshot: friction with a wall or a particle acted."""
        return sum(any(row[6:9]) for row in snapshots(self.read("later.txt"))[-1].values())
