# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Coupled runs of LAMMPS: closed books, several runs, unfix, restart, output; same answer on any
number of ranks and with either newton."""

import unittest

from host import couple, largest_difference, last_snapshot, thermo_rows
from two_hosts import COUPLED, DENSITY, DIAMETER, TwoHostTest, dump, lammps_bed, thermo


class Runs(TwoHostTest):
    def check_residuals(self, output):
        rows = self.closed_books(output)
        for row in rows:
            self.assertEqual(row[COUPLED], 180)
        return rows

    def script(self, runs, every=10, more="", **bed):
        return lammps_bed(**bed) + couple(every, more) + thermo() + dump("dump.txt") + runs

    def end_of(self, script, ranks=1):
        rows = self.check_residuals(self.run_lammps(script, ranks))
        return rows, last_snapshot(self.read("dump.txt"))

    def test_ranks_and_newton(self):
        one, particles = self.end_of(self.script("run 200\n"))
        for ranks, newton in ((2, "off"), (1, "on"), (2, "on")):
            with self.subTest(ranks=ranks, newton=newton):
                rows, others = self.end_of(self.script("run 200\n", newton=newton), ranks)
                self.assertLess(largest_difference(particles, others), 1e-9)
                for a, b in zip(one, rows):
                    for column in range(2, 6):
                        self.assertAlmostEqual(a[column], b[column], delta=1e-9 * abs(a[column]))

    def test_output_table_and_progress(self):
        output = self.run_lammps(self.script("run 300\n", more="progress 0.002"), ranks=2)
        self.assertRegex(output, r"granflux: +[0-9.]+ % done, gas time .* steps/s, about .* left")
        for row in ("gas", "exchange", "fluid force", "contacts", "neighbour lists", "total"):
            self.assertRegex(output, rf"\n +{row}( +-?[0-9.]+){{5}}\n")
        self.assertIn("gravity 0 0 -9.81 m/s2", output)
        self.assertIn("% done", self.read("log.lammps"))

    def test_run_without_setup_continues_exactly(self):
        _, whole = self.end_of(self.script("run 200\n"))
        _, split = self.end_of(self.script("run 75\nrun 125 pre no\n"))
        self.assertEqual(whole, split)

    def test_changed_steps(self):
        runs = "run 95\ntimestep 7e-6\nrun 100\nfix_modify gas couple_every 4\nrun 100\n"
        rows = self.check_residuals(self.run_lammps(self.script(runs)))
        self.assertEqual(rows[-1][0], 295)

    def test_unfix_and_new_fix(self):
        runs = "run 100\nthermo_style custom step\nunfix gas\nrun 20\n" + couple(5) + thermo() + "run 100\n"
        output = self.run_lammps(self.script(runs))
        self.assertEqual(thermo_rows(output)[-1][0], 220)
        self.check_residuals(output.rsplit("Setting up Verlet run", 1)[1])

    def test_values_of_each_particle(self):
        columns = " ".join(f"f_gas[{n}]" for n in range(1, 12))
        script = lammps_bed() + couple(5) + f"dump p all custom 10 dump.txt id {columns} vz\n"
        self.run_lammps(script + "run 50\n", ranks=2)
        for row in last_snapshot(self.read("dump.txt")).values():
            drag_coefficient, void_fraction, gas_velocity = row[0], row[1], row[4]
            pressure_force, force = row[7], row[10]
            self.assertGreater(drag_coefficient, 0)
            self.assertTrue(0.3 < void_fraction < 1)
            self.assertGreater(gas_velocity, 0.4)
            self.assertGreater(force, 0)
            self.assertGreater(pressure_force, 0)

    def test_groups(self):
        group = "group low id <= 90\n"
        script = lammps_bed() + group + couple().replace("all", "low") + thermo() + "run 40\n"
        for row in thermo_rows(self.run_lammps(script, 2)):
            self.assertEqual(row[COUPLED], 90)
        held = self.script("run 40\n", more="fixed_group low").replace("fix gas", group + "fix gas")
        self.check_residuals(self.run_lammps(held))

    def test_particles_come_and_go(self):
        runs = (
            "run 40\ncreate_atoms 1 single 5e-3 3e-3 15e-3\n"
            f"set atom 181 diameter {DIAMETER} density {DENSITY}\nrun 40\n"
            "group gone id <= 10\ndelete_atoms group gone\nrun 40\n"
        )
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                output = self.run_lammps(lammps_bed() + couple(5) + thermo() + runs, ranks)
                rows = thermo_rows(output)
                self.assertEqual([row[COUPLED] for row in rows[2::3]], [180, 181, 171])
                for row in rows:
                    self.assertLess(row[-3], 1e-12)  # momentum handed over

    def test_poured_particles(self):
        pour = (
            "region top block 2e-3 8e-3 2e-3 4e-3 20e-3 30e-3\n"
            f"fix pour all pour 8 1 4767 region top vol 0.1 50 diam one {DIAMETER} dens {DENSITY} {DENSITY}\n"
        )
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                script = lammps_bed() + pour + couple(5) + thermo() + "run 200\n"
                rows = thermo_rows(self.run_lammps(script, ranks))
                self.assertEqual(rows[-1][COUPLED], 188)
                for row in rows:
                    self.assertLess(row[-3], 1e-12)

    def test_forces_of_later_fixes_are_told(self):
        gravity = "fix             gravity all gravity 9.81 vector 0 0 -1\n"
        script = lammps_bed().replace(gravity, "") + couple() + gravity + "run 1\n"
        self.assertIn(
            "WARNING: fix gravity (style gravity) comes after fix gas", self.run_lammps(script)
        )

    def test_gas_does_not_move_frozen_particles(self):
        script = lammps_bed() + "fix held all freeze\n" + couple() + thermo() + dump("dump.txt", 20)
        self.run_lammps(script + "run 40\n")
        first = last_snapshot(self.read("dump.txt").split("ITEM: TIMESTEP")[1])
        last = last_snapshot(self.read("dump.txt"))
        # Frozen particles go on with the velocity that they had.
        for i, row in last.items():
            self.assertEqual(row[3:6], first[i][3:6])


class Restart(TwoHostTest):
    START = lammps_bed() + couple(7) + thermo() + dump("dump.txt")
    CONTINUE = (
        lammps_bed(source="read_restart gas.restart") + couple(7) + thermo() + dump("again.txt")
    )

    def test_continues_bit_for_bit(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.run_lammps(self.START + "run 150\nwrite_restart gas.restart\nrun 100\n", ranks)
                output = self.run_lammps(self.CONTINUE + "run 100\n", ranks)
                rows = thermo_rows(output)
                self.assertEqual(rows[-1][0], 250)
                self.assertLess(rows[-1][-3], 1e-12)  # momentum handed over
                split, restarted = self.read("dump.txt"), self.read("again.txt")
                self.assertEqual(last_snapshot(split), last_snapshot(restarted))

    def test_continues_on_another_number_of_ranks(self):
        self.run_lammps(self.START + "run 50\nwrite_restart gas.restart\n", 2)
        self.run_lammps(self.CONTINUE + "run 100\n", 2)
        same = last_snapshot(self.read("again.txt"))
        output = self.run_lammps(self.CONTINUE + "run 100\n", 1)
        self.assertLess(thermo_rows(output)[-1][-3], 1e-12)  # momentum handed over
        self.assertLess(largest_difference(same, last_snapshot(self.read("again.txt"))), 1e-10)


if __name__ == "__main__":
    unittest.main()
