# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Particles that come and go during a run."""

import unittest

from host import HostTest, bed, couple, thermo, thermo_rows

INSERT = """
region          top block 0.5e-3 9.5e-3 0.5e-3 5.5e-3 20e-3 30e-3 units box
fix             kind all particletemplate/sphere 15485863 atom_type 1 density constant 1000 &
                radius constant 0.4e-3
fix             kinds all particledistribution/discrete 15485867 1 kind 1
fix             rain all insert/rate/region seed 32452843 distributiontemplate kinds nparticles 60 &
                particlerate 30000 insert_every 20 overlapcheck yes vel constant 0 0 -0.5 region top
"""


class ComingAndGoing(HostTest):
    def check(self, script, ranks):
        rows = thermo_rows(self.run_script(script, ranks))
        for row in rows:
            self.assertLess(row[-4], 1e-12, "void volume")
            self.assertLess(row[-3], 1e-12, "momentum")
            self.assertLess(row[-2], 1e-9, "gas mass")
            self.assertLess(row[-1], 1e-10, "gas momentum")
        return rows

    def test_insertion(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                rows = self.check(bed() + INSERT + couple() + thermo() + "run 300\n", ranks)
                coupled = [row[7] for row in rows]
                self.assertEqual(coupled[0], 180)
                self.assertEqual(coupled[-1], 240)

    def test_particles_leave_by_the_outlet(self):
        # All fly up and through the top, where LIGGGHTS deletes them.
        throw = "velocity all set 0 0 30 units box\n"
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                script = bed() + throw + couple(5) + thermo(lost="ignore") + "run 200\n"
                rows = self.check(script, ranks)
                self.assertEqual(rows[0][7], 180)
                self.assertEqual(rows[-1][7], 0)

    def test_particles_outside_the_grid_are_counted(self):
        # The gas grid ends below the top of the box: particles that cross it are not coupled.
        case = self.read("case.toml").replace("40e-3", "20e-3").replace("20]", "10]")
        self.write("case.toml", case)
        throw = "velocity all set 0 0 10 units box\n"
        rows = self.check(bed() + throw + couple(5, "box any") + thermo() + "run 220\n", 2)
        self.assertEqual([rows[0][8], rows[-1][8]], [0, 180])

    def test_groups(self):
        script = bed() + "region half block 0 5e-3 0 6e-3 0 40e-3 units box\ngroup left region half\n"
        script += couple().replace("gas all", "gas left") + thermo() + "run 40\n"
        self.assertEqual(self.check(script, 2)[-1][7], 100)

    def test_no_particles_on_a_rank(self):
        script = bed().replace("processors      * * 1", "processors 1 1 2")
        rows = self.check(script + couple() + thermo() + "run 40\n", 2)
        self.assertEqual(rows[-1][7], 180)


if __name__ == "__main__":
    unittest.main()
