# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A half-full drum that turns about its axis, its gas on a grid of five blocks fitted to it."""

import unittest

from host import MATERIAL, HostTest, couple, dump, largest_difference, last_snapshot, thermo

RADIUS, LENGTH = 10e-3, 8e-3

DRUM = f"""
units           si
atom_style      granular
atom_modify     map array
boundary        f f p
newton          off
communicate     single vel yes
processors      1 * *
region          box block -{RADIUS} {RADIUS} -{RADIUS} {RADIUS} 0 {LENGTH} units box
create_box      1 box
lattice         sc 1.1e-3 origin 0.5 0.45 0.45
region          bed block -6e-3 6e-3 -6e-3 0 0 7.9e-3 units box
create_atoms    1 region bed
set             group all diameter 1e-3 density 1000
velocity        all ramp vx -0.2 0.2 z 0 8e-3 units box
{MATERIAL}fix             shell all wall/gran model hooke/stiffness tangential history &
                primitive type 1 zcylinder {RADIUS} 0 0 absolute_damping on
fix             gravity all gravity 9.81 vector 0 -1 0
fix             move all nve/sphere
timestep        1e-5
"""

CASE = f"""
[grid]
kind = "cylinder"
radius = {RADIUS}
length = {LENGTH}
cells = [2, 4, 3]
periodic_axis = true
[fluid]
density = 1.2
viscosity = 1.8e-5
[[boundary]]
name = "wall"
type = "wall"
angular_velocity = [0, 0, 30]
[coupling]
void_fraction = "divided"
"""


class Drum(HostTest):
    def setUp(self):
        super().setUp()
        self.write("case.toml", CASE)

    def end_of(self, ranks, options=()):
        script = DRUM + couple(10) + thermo() + dump("dump.txt") + "run 300\n"
        output = self.run_script(script, ranks, options=options)
        self.closed_books(output, 1e-9)
        self.assertIn("144 cells in 5 blocks", output)
        return last_snapshot(self.read("dump.txt"))

    def test_budgets_close_and_ranks_and_threads_agree(self):
        alone = self.end_of(1)
        # Positions and velocities: after so few steps rounding has not grown far.
        self.assertLess(largest_difference(alone, self.end_of(1, ("-threads", "2")), columns=6), 1e-6)
        self.assertLess(largest_difference(alone, self.end_of(2), columns=6), 1e-6)

    def test_the_period_must_be_that_of_the_box(self):
        self.write("case.toml", CASE.replace(f"length = {LENGTH}", "length = 7e-3"))
        code, output = self.start(DRUM + couple(10) + "run 10\n")
        self.assertNotEqual(code, 0)
        self.assertIn("high side in z: the gas grid is at 0.007 m, the simulation box at 0.008 m", output)


if __name__ == "__main__":
    unittest.main()
