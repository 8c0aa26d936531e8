# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/fluidized_bed under LAMMPS in short: packed for a tenth of its time, blown for 4 ms; its books
close."""

import pathlib
import unittest

from host import thermo_rows
from two_hosts import TwoHostTest

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples/fluidized_bed"


class FluidisedBed(TwoHostTest):
    def test_in_short(self):
        for path in (*EXAMPLE.glob("lammps/in.*"), EXAMPLE / "bed_U0.9.toml"):
            self.write(path.name, path.read_text())
        settle = self.read("in.settle")
        self.assertIn("\nrun             16000\n", settle)
        self.write("in.settle", settle.replace("run             16000", "run             1600"))
        options = ("-var", "time", "0.004", "-var", "every", "400")
        output = self.run_lammps(self.read("in.bed"), options=options)
        rows = [row for row in thermo_rows(output) if len(row) == 10]  # of the run with gas
        self.assertEqual(rows[-1][0], 800)
        self.assertGreater(rows[-1][3], rows[0][3])  # pressure drop: the inlet grows
        for row in rows:
            self.assertLess(max(row[5:8]), 1e-12)  # void volume, momentum, gas mass
            self.assertEqual(row[8], 9240)


if __name__ == "__main__":
    unittest.main()
