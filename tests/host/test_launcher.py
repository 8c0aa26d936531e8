# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Options of the launcher, the command clear, exit codes."""

import re
import subprocess
import unittest

from host import GRANFLUX, HostTest, bed, couple, thermo, thermo_rows


class Launcher(HostTest):
    def test_version(self):
        text = subprocess.run([GRANFLUX, "-version"], capture_output=True, text=True, check=True)
        self.assertRegex(
            text.stdout,
            r"granflux [0-9.]+, revision \S+\ncompiler: .+\nflags: .+\nhost: LIGGGHTS-PUBLIC 3\.8",
        )

    def test_options_of_the_stock_program(self):
        options = ["-var", "word", "hello", "-log", "other.log", "-screen", "none", "-echo", "log"]
        output = self.run_script('print "said ${word}"\n', ranks=2, options=options)
        self.assertNotIn("said", output)
        log = self.read("other.log")
        self.assertIn("said hello", log)
        self.assertIn('print "said ${word}"', log)  # the echo of the command
        self.assertFalse((self.folder / "log.liggghts").exists())

    def test_styles_survive_clear(self):
        script = bed() + couple() + "run 10\nclear\n" + bed() + couple() + thermo(10) + "run 10\n"
        self.assertEqual(thermo_rows(self.run_script(script))[-1][0], 10)

    def test_unknown_command_stops(self):
        code, output = self.start("nonsense 1 2 3\n", ranks=2)
        self.assertNotEqual(code, 0)
        self.assertIn("Unknown command: nonsense", output)

    def test_help_of_the_stock_program(self):
        text = subprocess.run([GRANFLUX, "-help"], capture_output=True, text=True, check=False)
        self.assertTrue(re.search(r"Command line options", text.stdout), text.stdout)


if __name__ == "__main__":
    unittest.main()
