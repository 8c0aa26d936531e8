# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/hot_bed in short: it runs, its books close, its pictures are drawn."""

import pathlib
import re
import subprocess
import unittest

from host import HostTest

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples/hot_bed"


class HotBed(HostTest):
    def test_in_short(self):
        for name in ("in.hot_bed", "hot_bed.toml"):
            self.write(name, (EXAMPLE / name).read_text())
        self.run_script(self.read("in.hot_bed"), options=("-var", "time", "0.02"))
        drawn = subprocess.run(
            [EXAMPLE / "plot.py", self.folder], capture_output=True, text=True, check=False
        )
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        number = r"([\d.]+(?:e[-+]\d+)?)"
        found = re.search(
            f"{number} K at first, {number} K after .* handed over {number}, of the gas's heat {number}; "
            f"heat not accounted for {number} of all",
            drawn.stdout,
        )
        self.assertTrue(found, drawn.stdout)
        first, last, handed_over, of_gas, not_accounted_for = map(float, found.groups())
        self.assertAlmostEqual(first, 400, delta=0.01)
        self.assertTrue(390 < last < 396, last)
        for residual in (handed_over, of_gas, not_accounted_for):
            self.assertLess(residual, 1e-10)
        for picture in ("picture.png", "plot.png"):
            self.assertGreater((self.folder / picture).stat().st_size, 10000)


if __name__ == "__main__":
    unittest.main()
