# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The files of docs/tutorials/own_gas_mesh.md run as printed, and print what the page shows."""

import re
import unittest
from pathlib import Path

from host import GRANFLUX, HostTest, thermo_rows

PAGE = Path(__file__).resolve().parents[2] / "docs/tutorials/own_gas_mesh.md"
GRANFLUX_CFD = str(Path(GRANFLUX).with_name("granflux_cfd"))


class OwnGasMesh(HostTest):
    def cfd(self, case, *options):
        code, output = self.launch(GRANFLUX_CFD, [case, *options])
        self.assertEqual(code, 0, output)
        return output

    def test_as_printed(self):
        blocks = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE.read_text(), re.M | re.S)
        mesh, tube = (block for language, block in blocks if language == "toml")
        shown = [block for language, block in blocks if not language]
        script = next(block for block in shown if block.startswith("atom_style"))
        self.write("mesh.toml", mesh)
        self.write("tube.toml", tube)
        self.assertIn(shown[0].split("mesh:")[1], self.cfd("mesh.toml"))
        fluxes = self.cfd("tube.toml", "--forces", "forces.csv")
        for name in ("high", "low", "wall"):
            told = re.search(rf"^{name} +(\S+) +(\S+)$", shown[1], re.M).groups()
            found = re.search(rf"^{name} +(\S+) +(\S+)$", fluxes, re.M).groups()
            for a, b in zip(told, found):
                self.assertAlmostEqual(float(a), float(b), delta=1e-5 * abs(float(a)))
        self.write("bad.toml", tube.replace('name = "wall"', 'name = "walls"'))
        code, output = self.launch(GRANFLUX_CFD, ["bad.toml"])
        self.assertNotEqual(code, 0)
        self.assertEqual(output.strip(), shown[2].strip())
        self.assertIn("run             1000\n", script)
        output = self.run_script(script.replace("run             1000\n", "run             200\n"))
        row = re.search(r"^ +0 +3735 .*$", shown[4], re.M).group().split()
        found = thermo_rows(output)[0]
        for a, b in zip(row[:5], found):
            self.assertAlmostEqual(float(a), b, delta=1e-6 * abs(float(a)))
        self.assertRegex(output, r"particles outside the gas grid +0\n")


if __name__ == "__main__":
    unittest.main()
