# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Ranks and cells with nothing to do; particles that all leave, come back, and are put upon others."""

import unittest

from host import HostTest, bed, bed_from, couple, dump, largest_difference, last_snapshot, thermo


class Divisions(HostTest):
    def test_all_particles_on_one_rank_of_several(self):
        """Cut across the height, all but the lowest rank are without particles."""
        self.run_script(bed() + "write_restart start.restart\n")
        script = bed_from("start.restart") + couple() + thermo() + dump("dump.txt") + "run 100\n"
        ends = []
        for ranks, cut in ((1, "1 1 1"), (2, "1 1 2"), (4, "1 1 4")):
            output = self.run_script(script.replace("processors      * * 1", f"processors {cut}"), ranks)
            self.assertEqual(self.closed_books(output, 1e-9)[-1][7], 180)
            ends.append(last_snapshot(self.read("dump.txt")))
        for end in ends[1:]:
            self.assertLess(largest_difference(ends[0], end, columns=6), 1e-9)

    def test_a_rank_without_gas_cells_is_refused(self):
        case = self.read("case.toml")
        for ranks, text, message in (
            (2, case.replace("cells", "blocks = [1, 1, 1]\ncells"), "every rank needs at least one block"),
            (4, case.replace("[5, 3, 20]", "[1, 1, 4]"), "use fewer ranks or more cells"),
        ):
            self.write("case.toml", text)
            code, output = self.start(bed() + couple() + thermo() + "run 20\n", ranks)
            self.assertNotIn(code, (0, 124))
            self.assertIn(message, output)
            self.assertNotIn("\n       0 ", output)

    def test_one_cell_across(self):
        self.write("case.toml", self.read("case.toml").replace("[5, 3, 20]", "[1, 1, 4]"))
        for ranks in (1, 2):
            self.closed_books(self.run_script(bed() + couple() + thermo() + "run 40\n", ranks), 1e-9)

    def test_all_leave_and_others_come(self):
        """Through the top of an open box; the run goes on without any, then with new ones, which lie on
        faces of cells, in walls, and on an edge of the box, where LIGGGHTS makes none."""
        new = "".join(
            f"create_atoms 1 single {x} {y} {z} units box\n"
            for x, y, z in ((2e-3, 2e-3, 2e-3), (0.3e-3, 2e-3, 20e-3), (5e-3, 0.3e-3, 10e-3), (10e-3, 6e-3, 36e-3))
        )
        script = (
            bed()
            + "velocity all set 0 0 30 units box\n"
            + couple(5)
            + thermo(lost="ignore")
            + "run 260\n"
            + new
            + "set group all diameter 1e-3 density 1000\nrun 100\n"
        )
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                rows = self.closed_books(self.run_script(script, ranks), 1e-9)
                coupled = [row[7] for row in rows]
                self.assertEqual(coupled[0], 180)
                self.assertEqual(min(coupled), 0)
                self.assertEqual(coupled[-1], 3)

    def test_inserted_upon_others(self):
        """A sphere put into the middle of a bed at rest, where others are: it is pressed out, the books
        stay closed."""
        script = bed() + "velocity all set 0 0 0\n" + couple(5) + thermo() + "run 40\n"
        script += "create_atoms 1 single 4.6e-3 2.9e-3 2.0e-3 units box\n"
        script += "group new id 181\nset group new diameter 1e-3 density 1000\nvelocity new set 0 0 0\nrun 100\n"
        for ranks in (1, 2):
            rows = self.closed_books(self.run_script(script, ranks), 1e-9)
            self.assertEqual(rows[-1][7], 181)


if __name__ == "__main__":
    unittest.main()
