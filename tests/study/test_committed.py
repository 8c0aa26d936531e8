# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The committed studies, examples/studies: all are right as they are written, and some of their knobs in short runs.

CTest sets GRANFLUX_STUDY, the program, which has granflux beside it.
"""

import csv
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["GRANFLUX_STUDY"]
STUDIES = Path(__file__).resolve().parents[2] / "examples/studies"


class Committed(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def short(self, name, knobs, *changes):
        """Runs some knobs of a study with (file, old, new) changes; {setting: row of study.csv}."""
        case = self.folder / name
        shutil.copytree(STUDIES / name, case, ignore=shutil.ignore_patterns("results"))
        for file, old, new in (*changes, ("study.toml", "repeats = 2", "repeats = 1")):
            text = (case / file).read_text()
            self.assertTrue(old in text or old == "repeats = 2", old)
            (case / file).write_text(text.replace(old, new))
        head, *tables = (case / "study.toml").read_text().split("[[")
        kept = [t for t in tables if not t.startswith("knob") or t.split('"')[1] in knobs]
        self.assertEqual(sum(t.startswith("knob") for t in kept), len(knobs))
        (case / "study.toml").write_text("[[".join([head, *kept]))
        done = subprocess.run([PROGRAM, case], capture_output=True, text=True, check=False, timeout=200)
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(case / "results/study.csv") as file:
            return {row["setting"]: row for row in csv.DictReader(file)}

    def test_all_are_right(self):
        cases = sorted(path.parent for path in STUDIES.glob("*/study.toml"))
        self.assertGreaterEqual(len(cases), 4)
        for case in cases:
            done = subprocess.run([PROGRAM, case, "--check", "--out", self.folder / "out"], capture_output=True, text=True,
                                  check=False, timeout=60)
            self.assertEqual(done.returncode, 0, f"{case}: {done.stderr}")

    def test_parcels_and_steps_by_courant_number(self):
        rows = self.short("packed_bed", ["gas step", "coarse graining"], ("in.packed_bed", "time index 0.5 ", "time index 0.02 "))
        self.assertEqual({row["failure"] for row in rows.values()}, {""})
        errors = {name: float(row["error"]) for name, row in rows.items()}
        self.assertLess(errors["coarse graining 3"], 0.12)
        self.assertGreater(errors["coarse graining 2, not told"], 0.5)
        self.assertAlmostEqual(errors["gas step Courant 0.1"], errors["gas step 0.5 ms"], delta=0.01)

    def test_treatments_of_drag(self):
        rows = self.short("single_particle", ["gas grid", "drag treatment"], ("study.toml", 'base = "2"', 'base = "1/2"'),
                          ("study.toml", '  { label = "4", keys = { "sphere.toml:grid.cells" = [8, 8, 160] } },\n', ""),
                          ("study.toml", '  { label = "2", keys = { "sphere.toml:grid.cells" = [4, 4, 80] } },\n', ""))
        self.assertEqual({row["failure"] for row in rows.values()}, {""})
        speed = {name: float(row["fall speed_m/s"]) for name, row in rows.items()}
        for name in ("explicit", "semi_implicit"):
            self.assertNotEqual(speed[f"drag treatment {name}"], speed["base"])
            self.assertAlmostEqual(speed[f"drag treatment {name}"] / speed["base"], 1, delta=0.01)

    def test_threads_change_no_bit(self):
        rows = self.short("small_bed", ["reproducible"], ("in.start", "run             50000", "run             1000"),
                          ("in.bed", "time index 3 ", "time index 0.06 "), ("study.toml", "from = 0.2", "from = 0"))
        self.assertEqual({row["failure"] for row in rows.values()}, {""})
        for column in ("pressure drop_Pa", "bed height_m"):
            self.assertEqual(rows["reproducible on, 2 threads"][column], rows["base"][column])


if __name__ == "__main__":
    unittest.main()
