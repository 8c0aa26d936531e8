# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Options of the launcher, the command clear, exit codes."""

import subprocess
import unittest

from host import couple, thermo_rows
from two_hosts import GRANFLUX_LAMMPS, TwoHostTest, lammps_bed, thermo


class Launcher(TwoHostTest):
    def test_version(self):
        text = subprocess.run([GRANFLUX_LAMMPS, "-version"], capture_output=True, text=True, check=True)
        self.assertRegex(
            text.stdout,
            r"granflux_lammps [0-9.]+, revision \S+\ncompiler: .+\nflags: .+\nhost: LAMMPS 20[0-9]{6}\n",
        )

    def test_options_of_the_stock_program(self):
        options = ["-var", "word", "hello", "-log", "other.log", "-screen", "none", "-echo", "log"]
        output = self.run_lammps('print "said ${word}"\n', ranks=2, options=options)
        self.assertNotIn("said", output)
        log = self.read("other.log")
        self.assertIn("said hello", log)
        self.assertFalse((self.folder / "log.lammps").exists())

    def test_threads(self):
        output = self.run_lammps('print "here"\n', options=["-threads", "2"])
        self.assertIn("using 2 OpenMP thread(s) per MPI task", output)
        code, output = self.start_lammps('print "here"\n', options=["-threads", "none"])
        self.assertNotEqual(code, 0)
        self.assertIn("-threads is 'none': allowed is a whole number", output)

    def test_styles_survive_clear(self):
        bed = lammps_bed() + couple() + thermo(10)
        output = self.run_lammps(bed + "run 10\nclear\n" + bed + "run 10\n")
        self.assertEqual(thermo_rows(output)[-1][0], 10)

    def test_unknown_command_stops(self):
        code, output = self.start_lammps("nonsense 1 2 3\n", ranks=2)
        self.assertNotEqual(code, 0)
        self.assertIn("Unknown command: nonsense", output)


if __name__ == "__main__":
    unittest.main()
