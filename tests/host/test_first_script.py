# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The script of docs/howto/first_script.md runs as printed, and continues from its restart file."""

import re
import unittest
from pathlib import Path

from host import HostTest, thermo_rows

PAGE = Path(__file__).resolve().parents[2] / "docs/howto/first_script.md"


class FirstScript(HostTest):
    def test_runs_as_printed_and_continues(self):
        case, script = re.findall(r"^```(?:toml)?\n(.*?)^```$", PAGE.read_text(), re.M | re.S)
        self.write("box.toml", case)
        rows = thermo_rows(self.run_script(script, ranks=2))
        self.assertEqual(rows[-1][1], 500)
        self.assertGreater(rows[-1][3], 0)  # pressure drop
        for row in rows[1:]:
            self.assertLess(max(row[5:]), 1e-12)
        lines = script.replace("&\n", "").splitlines(keepends=True)
        inserted = ("fix             beads", "fix             sizes", "region", "fix             insert")
        continued = "".join(line for line in lines if not line.startswith(inserted))
        continued = continued.replace("create_box      1 box", "read_restart half.restart")
        rows = thermo_rows(self.run_script(continued, ranks=2))
        self.assertEqual([rows[0][0], rows[-1][0], rows[-1][1]], [5000, 10000, 500])


if __name__ == "__main__":
    unittest.main()
