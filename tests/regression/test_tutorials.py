# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Shortening a tutorial changes its run commands and nothing else."""

import unittest

from tutorials import Tutorial, shortened

SCRIPT = """variable	growts equal 50000
variable	Rgrowrate equal (${growts}/2)
fix run all nve/sphere
run		1
run		8000 upto
run		${growts}   # grows
thermo		1000
"""


class Shortened(unittest.TestCase):
    def test_only_run_commands_and_the_end(self):
        lines = shortened(SCRIPT, Tutorial("t", "in.t", 0.01, ("f_Temp[0]",))).splitlines()
        expected = SCRIPT.splitlines()
        expected[4:6] = ["run		80 upto", "run		500   # grows"]
        self.assertEqual(lines[:7], expected)
        self.assertRegex("\n".join(lines[7:]).strip(), r"^write_dump all custom end\.dump id type x .* f_Temp\[0\] modify")

    def test_formats_match_columns(self):
        words = shortened("run 1\n", Tutorial("t", "in.t", 1.0, ("a", "b"))).split()
        columns = words[words.index("end.dump") + 1 : words.index("modify")]
        self.assertEqual(len(columns), sum("%" in word for word in words))


if __name__ == "__main__":
    unittest.main()
