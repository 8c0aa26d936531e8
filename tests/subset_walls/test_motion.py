# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Integration and gravity: what the stock program computes, to the last bit."""

import re
import unittest

from host import LIGGGHTS, thermo_rows
from beside_stock import SPHERES, STIFFNESS, BesideStock, run_and_dump

# They do not meet in these steps. Unsorted: sorted they would be in another order than LIGGGHTS' own, and sums
# over them would round differently.
FREE = SPHERES.format(spacing=2.2e-3).replace("sort 20 0.0", "sort 0 0.0") + STIFFNESS
THERMO = """
thermo_style    custom step atoms ke f_gravity
thermo_modify   lost ignore norm no format float %.17g
thermo          7
"""
GRAVITY = "fix gravity all gravity 9.81 vector 0.3 0 -1\n"


def list_builds(output):
    return re.findall(r"Neighbor list builds = (\d+)", output)


class Motion(BesideStock):
    def check_bits(self, script):
        for stock, found in self.check(script, first=0, later=0).values():
            self.assertEqual(thermo_rows(stock), thermo_rows(found))
            self.assertGreater(len(thermo_rows(found)), 5)
            self.assertEqual(list_builds(stock), list_builds(found))
            self.assertGreater(int(list_builds(found)[-1]), 2)

    def test_free_flight(self):
        self.check_bits(FREE + GRAVITY + "fix move all nve/sphere\n" + THERMO + run_and_dump())

    def test_seen_every_step(self):
        self.check_bits(FREE + GRAVITY + "fix move all nve/sphere\n" + THERMO +
                        run_and_dump(every=1))

    def test_groups_of_particles(self):
        """Some move by one fix, some by another, some not at all; weight for some."""
        groups = """
group           left subtract all right
region          still block INF INF INF INF 5e-3 INF units box
group           still region still
group           go subtract left still
fix             gravity right gravity 9.81 vector 0 0 -1
fix             one go nve/sphere
fix             two right nve/sphere
"""
        self.check_bits(FREE + groups + THERMO + run_and_dump())

    def test_other_fixes_look_at_velocities(self):
        """A fix that is called at the end of each step must find velocities complete."""
        script = FREE + GRAVITY + """
fix             move all nve/sphere
variable        energy equal ke
fix             mean all ave/time 1 5 5 v_energy file energy.txt
""" + THERMO + run_and_dump()
        self.check_bits(script)
        found = self.read("energy.txt")
        self.run_script(script, program=LIGGGHTS)
        self.assertEqual(self.read("energy.txt"), found)

    def test_other_integrators(self):
        """Particles that another fix moves: lists age by what they do, too."""
        script = FREE + GRAVITY + """
fix             one all nve/sphere
group           some id <= 20
fix             two some move linear 0.9 0 0
""" + THERMO + run_and_dump()
        script = script.replace("fix             one all", "group rest id > 20\nfix one rest")
        for stock, found in self.check(script).values():  # some meet: not the same bits
            self.assertEqual(list_builds(stock), list_builds(found))

    def test_particles_moved_between_runs(self):
        script = (FREE + GRAVITY + "fix move all nve/sphere\n" + THERMO + "run 10\n" +
                  "displace_atoms all move 2e-4 0 0 units box\nrun 3 pre no\nrun 10\n" +
                  run_and_dump())
        self.check_bits(script)

    def test_gravity_from_a_variable(self):
        script = (FREE + "variable g equal 9.81*(1+0.01*step)\n" +
                  "fix gravity all gravity v_g vector 0 0 -1\nfix move all nve/sphere\n" + THERMO +
                  run_and_dump())
        self.check_bits(script)
        self.assertIn("granflux: fix gravity with variables", self.run_mix(script, 1, 1))


if __name__ == "__main__":
    unittest.main()
