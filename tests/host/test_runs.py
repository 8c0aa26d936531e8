# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Several runs, unfix, new fixes, changed time steps, restart; same answer on any number of ranks."""

import unittest

from host import (
    HostTest,
    bed,
    bed_from,
    couple,
    dump,
    largest_difference,
    last_snapshot,
    thermo,
    thermo_rows,
)


class Runs(HostTest):
    def end_of(self, script, ranks=1):
        output = self.run_script(script, ranks)
        self.closed_books(output)
        return last_snapshot(self.read("dump.txt"))

    def script(self, runs, every=10, more=""):
        return bed() + couple(every, more) + thermo() + dump("dump.txt") + runs

    def test_output_table_and_progress(self):
        output = self.run_script(self.script("run 300\n", more="progress 0.002"), ranks=2)
        self.assertRegex(output, r"granflux: +[0-9.]+ % done, gas time .* steps/s, about .* left")
        for row in ("gas", "exchange", "fluid force", "contacts", "neighbour lists", "total"):
            self.assertRegex(output, rf"\n +{row}( +-?[0-9.]+){{5}}\n")
        self.assertIn("residual of momentum handed over", output)
        self.assertIn("% done", self.read("log.liggghts"))
        self.assertNotIn("Modfy time", output)  # as without the fix

    def test_split_run(self):
        whole = self.end_of(self.script("run 200\n"))
        # LIGGGHTS computes forces anew, with velocities of another half step, where a run starts.
        # Positions and velocities only: spins follow from few contacts, which feel it most. Split
        # once: plain LIGGGHTS, too, comes out 7e-5 apart when split at each 50th step, and one
        # bounce in between multiplies that.
        for runs in ("run 100\nrun 0\nrun 100\n", "run 200 every 100 NULL\n"):
            with self.subTest(runs=runs):
                split = self.end_of(self.script(runs))
                self.assertLess(largest_difference(whole, split, columns=3), 1e-4)
                self.assertLess(largest_difference(whole, split, columns=6), 2e-2)

    def test_run_without_setup_continues_exactly(self):
        whole = self.end_of(self.script("run 200\n"))
        split = self.end_of(self.script("run 75\nrun 125 pre no\n"))
        self.assertEqual(whole, split)

    def test_changed_steps(self):
        runs = "run 95\ntimestep 7e-6\nrun 100\nfix_modify gas couple_every 4\nrun 100\n"
        rows = self.closed_books(self.run_script(self.script(runs)))
        self.assertEqual(rows[-1][0], 295)

    def test_unfix_and_new_fix(self):
        runs = "run 100\nunfix gas\nthermo_style custom step ke\nrun 20\n"
        runs += couple(5) + thermo() + "run 100\n"
        output = self.run_script(self.script(runs))
        self.assertEqual(thermo_rows(output)[-1][0], 220)
        self.closed_books(output.rsplit("Setting up run", 1)[1])

    def test_outputs_of_each_particle(self):
        script = bed() + couple(5) + "dump p all custom 10 dump.txt id f_dragforce[1] "
        script += "f_dragforce[2] f_dragforce[3] f_voidfraction f_uf[1] f_uf[2] f_uf[3]\n"
        self.run_script(script + "run 50\n")
        atoms = last_snapshot(self.read("dump.txt"))
        self.assertTrue(all(0.3 < row[3] < 1 for row in atoms.values()))
        self.assertTrue(all(row[6] > 0.4 for row in atoms.values()))
        self.assertTrue(all(row[2] > 0 for row in atoms.values()))

    def test_outputs_for_those_who_look_between_outputs(self):
        run = bed() + couple(5) + "compute drag all reduce sum f_dragforce[3]\n"
        self.run_script(run + "fix look all ave/time 5 1 5 c_drag file looked.txt\nthermo 40\nrun 40\n")
        looked = [float(line.split()[1]) for line in self.read("looked.txt").splitlines()
                  if not line.startswith("#")]
        shown = self.run_script(run + "thermo_style custom step c_drag\nthermo 5\nrun 40\n")
        self.assertEqual(len(looked), 9)
        for (_, drag), other in zip(thermo_rows(shown)[1:], looked[1:], strict=True):
            self.assertAlmostEqual(drag / other, 1, delta=5e-6)  # six digits in a file
        self.assertGreater(len(set(looked)), 8)

    def test_rank_independence(self):
        # The particles from a file: create_atoms numbers them differently on every number of ranks.
        self.run_script(bed() + "write_restart start.restart\n")
        script = bed_from("start.restart") + couple() + thermo() + dump("dump.txt") + "run 200\n"
        one = self.end_of(script)
        for ranks in (2, 4):
            with self.subTest(ranks=ranks):
                self.assertLess(largest_difference(one, self.end_of(script, ranks)), 1e-9)


class Restart(HostTest):
    START = bed() + couple(7) + thermo() + dump("dump.txt")
    CONTINUE = bed_from("gas.restart") + couple(7) + thermo() + dump("again.txt")

    def test_continues_bit_for_bit(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                self.run_script(self.START + "run 150\nwrite_restart gas.restart\nrun 100\n", ranks)
                output = self.run_script(self.CONTINUE + "run 100\n", ranks)
                self.assertEqual(thermo_rows(output)[-1][0], 250)
                split, restarted = self.read("dump.txt"), self.read("again.txt")
                self.assertEqual(last_snapshot(split), last_snapshot(restarted))

    def test_restart_file_of_a_running_step(self):
        self.run_script(self.START + "restart 80 gas.restart other.restart\nrun 100\n")
        output = self.run_script(self.CONTINUE + "run 100\n")
        for row in thermo_rows(output):
            self.assertLess(row[-3], 1e-12)

    def test_continues_on_another_number_of_ranks(self):
        self.run_script(self.START + "run 50\nwrite_restart gas.restart\n", 2)
        self.run_script(self.CONTINUE + "run 100\n", 2)
        same = last_snapshot(self.read("again.txt"))
        output = self.run_script(self.CONTINUE + "run 100\n", 1)
        self.assertLess(thermo_rows(output)[-1][-3], 1e-12)  # momentum handed over
        self.assertLess(largest_difference(same, last_snapshot(self.read("again.txt"))), 1e-10)


if __name__ == "__main__":
    unittest.main()
