# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The module for LAMMPS' own `plugin load`: what it exports, and a run after loading it by a stand-in
of that command, which Debian's LAMMPS does not have."""

import os
import subprocess
import unittest

from host import couple, thermo_rows
from two_hosts import TwoHostTest, dump, lammps_bed, thermo

PLUGIN = os.environ["GRANFLUX_PLUGIN"]
LOADER = os.environ["GRANFLUX_PLUGIN_LOADER"]


class Plugin(TwoHostTest):
    def test_exports_its_first_function_only(self):
        names = subprocess.run(
            ["nm", "-D", "--defined-only", PLUGIN], capture_output=True, text=True, check=True
        ).stdout.split("\n")
        self.assertEqual([name.split()[-1] for name in names if name], ["lammpsplugin_init"])

    def test_does_not_bring_a_lammps_of_its_own(self):
        needed = subprocess.run(
            ["objdump", "-p", PLUGIN], capture_output=True, text=True, check=True
        ).stdout
        self.assertNotIn("liblammps", needed)

    def test_runs_as_the_launcher_does(self):
        script = lammps_bed() + couple() + thermo() + dump("dump.txt") + "run 100\n"
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                rows = thermo_rows(self.run_lammps(script, ranks))
                launched = self.read("dump.txt")
                output = self.run_script(script, ranks, LOADER)
                self.assertIn("loaded fix style granflux/couple", output)
                self.assertEqual(thermo_rows(output), rows)
                self.assertEqual(self.read("dump.txt"), launched)


if __name__ == "__main__":
    unittest.main()
