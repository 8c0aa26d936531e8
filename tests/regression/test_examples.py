# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every example, in short, gives the particles or the gas that it gave when its reference was written."""

import io
import os
import pathlib
import tempfile
import unittest

from granflux_regress.command_line import EQUAL, main

from examples import EXAMPLES, ROOT, folder_of, run_example

REFERENCES = pathlib.Path(__file__).parent / "example_runs/references"
# Of the largest of a column: other compilers and vector units round otherwise, and contacts let it grow.
TOLERANCE = 1e-7


class Examples(unittest.TestCase):
    def test_all_are_here(self):
        there = {path.parent.name for path in (ROOT / "examples").glob("*/run.sh")} - {"studies"}
        self.assertEqual({folder_of(name).name for name in EXAMPLES}, there)

    def test_references(self):
        for name, example in EXAMPLES.items():
            if example.program not in os.environ:
                continue  # built without that host
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                dump = pathlib.Path(folder) / "ours.dump"
                dump.write_text(run_example(name, pathlib.Path(folder)))
                out = io.StringIO()
                code = main([str(REFERENCES / f"{name}.dump.gz"), str(dump), "--default", str(TOLERANCE)], out)
                self.assertEqual(code, EQUAL, f"\n{out.getvalue()}")


if __name__ == "__main__":
    unittest.main()
