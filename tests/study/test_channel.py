# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A study from end to end, with granflux_cfd: errors are those of the closed form, and nothing is run twice.

CTest sets GRANFLUX_STUDY, the program, which has granflux_cfd beside it.
"""

import csv
import os
import re
import shutil
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

PROGRAM = os.environ["GRANFLUX_STUDY"]
HERE = Path(__file__).resolve().parent


class Channel(unittest.TestCase):
    def setUp(self):
        self.case = Path(tempfile.mkdtemp()) / "channel"
        shutil.copytree(HERE / "channel", self.case)

    def tearDown(self):
        shutil.rmtree(self.case.parent)

    def study(self, *words):
        return subprocess.run([PROGRAM, self.case, *words], capture_output=True, text=True, check=False, timeout=100)

    def rows(self):
        with open(self.case / "results/study.csv") as file:
            return {row["setting"]: row for row in csv.DictReader(file)}

    def runs(self):
        return {path: path.stat().st_mtime_ns for path in (self.case / "results/runs").glob("*/*/run.json")}

    def test_from_end_to_end(self):
        done = self.study("--error", "0.05", "--jobs", "2")
        self.assertEqual(done.returncode, 0, done.stderr)
        # Which combinations are tried hangs on the costs; upwind2 with the long step may end at its Courant limit.
        rows = {name: row for name, row in self.rows().items() if "," not in name or not row["failure"]}
        errors = {name: float(row["error"]) for name, row in rows.items()}
        # Second order in the cells across; beyond, the gas step is what is left.
        self.assertAlmostEqual(errors["cells across 8"] / errors["cells across 16"], 4.0, delta=0.3)
        self.assertLess(errors["base"], 0.003)
        self.assertTrue(all(float(row["processor_s_per_s"]) > 0 for row in rows.values()))
        sentence = re.search(r"^error 5 %: (.*)$", done.stdout, re.MULTILINE).group(1)
        self.assertIn("cells across 8", sentence)
        self.assertRegex(sentence, r"error 3(\.\d+)? % \(pressure drop\)")

        before = self.runs()
        again = self.study("--error", "0.05")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual(self.runs(), before, "a second start runs nothing")
        self.assertIn(sentence, again.stdout)

        shutil.rmtree(next(iter(before)).parent.parent)
        self.assertEqual(self.study("--error", "0.05").returncode, 0)
        # A run done again has another cost, by which another combination may be tried.
        now = self.runs()
        self.assertEqual([now.get(path) == time for path, time in before.items()].count(False), 1, "what is missing")
        self.assertLessEqual(set(before), set(now))

        page = (self.case / "results/report.html").read_text()
        self.assertEqual(page.count("<svg"), 2)
        self.assertEqual(re.findall(r'(?:src|href)="(?!#)[^"]*"', page), [], "nothing outside the page")
        self.assertTrue((self.case / "results/figures/front.png").stat().st_size > 1000)

    def test_a_study_that_is_stopped_goes_on(self):
        with subprocess.Popen([PROGRAM, self.case, "--jobs", "1"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              text=True) as process:
            while not process.stdout.readline().startswith("[1/"):
                pass
            process.send_signal(signal.SIGTERM)
            _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 1)
        self.assertIn("the runs that are complete are kept", errors)
        before = self.runs()
        self.assertGreaterEqual(len(before), 1)
        self.assertEqual(self.study().returncode, 0)
        self.assertEqual({path: time for path, time in self.runs().items() if path in before}, before)
        self.assertEqual(list((self.case / "results/runs").glob("*/*.part")), [])

    def test_a_level_that_fails_is_told_and_left_out(self):
        file = self.case / "study.toml"
        file.write_text(file.read_text().replace("[0.02, 0.01]", "[-1.0, 0.01]"))
        done = self.study()
        self.assertEqual(done.returncode, 0, done.stderr)
        row = self.rows()["gas step -1 s"]
        self.assertIn("time_step = -1", row["failure"])
        self.assertEqual(row["error"], "")

    def test_a_base_that_fails_stops_the_study(self):
        file = self.case / "study.toml"
        file.write_text(file.read_text().replace("[0.02, 0.01]", "[0.01, -1.0]"))
        done = self.study()
        self.assertEqual(done.returncode, 2)
        self.assertIn("time_step = -1", done.stderr)
        self.assertEqual(len(self.runs()), 1)


if __name__ == "__main__":
    unittest.main()
