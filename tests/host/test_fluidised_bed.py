# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/fluidized_bed in short: packed for a tenth of its time, blown for 4 ms; its books close, its
pictures are drawn."""

import pathlib
import subprocess
import unittest

from host import HostTest, thermo_rows

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples/fluidized_bed"


class FluidisedBed(HostTest):
    def test_in_short(self):
        for path in (*EXAMPLE.glob("in.*"), EXAMPLE / "bed_U0.9.toml"):
            self.write(path.name, path.read_text())
        settle = self.read("in.settle")
        self.assertIn("\nrun             16000\n", settle)
        self.write("in.settle", settle.replace("run             16000", "run             1600"))
        script = self.read("in.bed")
        output = self.run_script(script, options=("-var", "time", "0.004", "-var", "every", "400"))
        self.assertIn("9240 particles", output)
        rows = [row for row in thermo_rows(output) if len(row) == 10]  # of the run with gas
        self.assertEqual(rows[-1][0], 800)
        self.assertAlmostEqual(rows[-1][1], 0.004, delta=1e-12)
        self.assertGreater(rows[-1][3], rows[0][3])  # pressure drop: the inlet grows
        for row in rows:
            self.assertLess(max(row[5:8]), 1e-12)  # void volume, momentum, gas mass
            self.assertEqual(row[8], 9240)
        self.assertTrue((self.folder / "bed.restart").exists())
        drawn = subprocess.run(
            [EXAMPLE / "plot.py", self.folder], capture_output=True, text=True, check=False
        )
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        for picture in ("picture.png", "plot.png"):
            self.assertGreater((self.folder / picture).stat().st_size, 10000)


if __name__ == "__main__":
    unittest.main()
