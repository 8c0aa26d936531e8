# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What the machine or the files around a run refuse ends it on all ranks within seconds, with the cause. (Checkpoints,
killed ranks: test_checkpoint.py; particles that are not numbers: tests/stable_range; lost: tests/stability.)"""

import re
import unittest

from host import CASE, HostTest, bed, couple, thermo

RUN = thermo() + "run 40\n"


class FailingWell(HostTest):
    def fails(self, script, *messages, limit="", ranks=(1, 2)):
        for count in ranks:
            with self.subTest(ranks=count):
                code, output = self.start_limited(script, limit, count)
                self.assertNotIn(code, (0, 124), output)
                for message in messages:
                    self.assertIn(message, output)

    def test_no_room_for_gas_fields(self):
        (self.folder / "post").mkdir()
        self.write("case.toml", CASE + '[output]\nfields = "post/gas"\nevery = 1e-9\n')
        self.fails(bed() + couple() + RUN, "ERROR", "post/gas", "cannot be written", limit="ulimit -f 20;")

    def test_unreadable_mesh(self):
        case = CASE.replace("size = [10e-3, 6e-3, 40e-3]\ncells = [5, 3, 20]", 'kind = "cgns"\nfile = "mesh.cgns"')
        self.assertNotEqual(case, CASE)
        self.write("case.toml", re.sub("side = .*\n", "", case))
        self.fails(bed() + couple() + RUN, "ERROR", "mesh.cgns")
        self.write("mesh.cgns", "no mesh at all\n")
        self.fails(bed() + couple() + RUN, "ERROR", "mesh.cgns")

    def test_out_of_memory(self):
        self.write("case.toml", CASE.replace("cells = [5, 3, 20]", "cells = [300, 300, 900]"))
        self.fails(bed() + couple() + RUN, "ERROR", "out of memory: this rank", limit="ulimit -v 2000000;")


if __name__ == "__main__":
    unittest.main()
