# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A law that is wrong by 5 % does not pass the comparison with the references.

CTest sets GRANFLUX and MPIRUN.
"""

import os
import pathlib
import shlex
import tempfile
import unittest
from unittest.mock import patch

import script
from granflux_regress.command_line import DIFFERS, EQUAL, main
from run_case import REFERENCES, run_case

from case_table import read_cases

DENSE = "dense01"  # hooke, history, epsd2, sjkr: knows every property
WRONG = 1.05


class CanFail(unittest.TestCase):
    def compare(self, step):
        case = next(case for case in read_cases() if case.name == DENSE)
        with tempfile.TemporaryDirectory() as folder:
            run_case(case, os.environ["GRANFLUX"], shlex.split(os.environ["MPIRUN"]), pathlib.Path(folder), step)
            name = {1: "first", 100: "hundred"}[step]
            with open(os.devnull, "w") as nowhere:
                return main([str(REFERENCES / f"{DENSE}.{name}.dump.gz"), f"{folder}/atoms.dump",
                             "--step", str(step), "--default", "1e-10"], nowhere)

    def test_right_laws_pass(self):
        self.assertEqual(self.compare(100), EQUAL)

    def test_properties_of_pairs(self):
        for name, value in script.PAIR_PROPERTIES.items():
            with self.subTest(name), patch.dict(script.PAIR_PROPERTIES, {name: WRONG * value}):
                self.assertEqual(self.compare(100), DIFFERS)

    def test_stiffness(self):
        with patch.object(script, "YOUNG", [WRONG * value for value in script.YOUNG]):
            self.assertEqual(self.compare(1), DIFFERS)


if __name__ == "__main__":
    unittest.main()
