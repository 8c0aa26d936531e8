# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""granflux gives the particles of the packaged liggghts, for every contact model, dense and dilute.

CTest sets GRANFLUX, MPIRUN, RANKS, THREADS and RUNS: 'short' runs the short cases, 'long' all.
"""

import io
import json
import os
import pathlib
import shlex
import statistics
import tempfile
import unittest

from granflux_regress.command_line import EQUAL, main
from granflux_regress.compare import Comparison
from granflux_regress.dump import read_dump

from case_table import read_cases
from particles import DENSITY
from run_case import REFERENCES, run_case
from script import HUNDRED, LATE, THOUSAND, history_columns

RANKS, THREADS = int(os.environ["RANKS"]), int(os.environ["THREADS"])
LONG = os.environ["RUNS"] == "long"
# Four threads that take turns on two cores need minutes for the late steps.
STEPS = LATE if LONG or RANKS * THREADS <= 2 else HUNDRED
CASES = [case for case in read_cases() if LONG or case.runs == "short"]
SPREAD = json.loads((REFERENCES / "manifest.json").read_text())["spread"]

FIRST_TOLERANCE = 1e-12  # relative, after step 1
HUNDRED_TOLERANCE = 1e-10  # after step 100, and never less later
# Later, a run may lie this much further from the reference than the furthest of six stock runs that
# differ from it by rounding only: the furthest of six is small by chance at times. That it is chance
# is seen from the median over all cases, which may not exceed that spread.
CHANCE = 10.0
LATE_ROUNDING = 1e-4  # relative: the references of step 10000 are stored with 6 digits
STATISTICS = {  # name: absolute difference that is always allowed
    "kinetic_energy": 0.0,
    "rotational_energy": 0.0,
    "centre_of_mass": 0.0,
    "mean_height": 0.0,
    "height_95": 0.0,
    "coordination_number": 0.05,  # contacts; ten of two hundred particles have one more or less
}


def regress(reference, dump, *options):
    """(whether equal, what granflux-regress prints)."""
    out = io.StringIO()
    code = main([str(reference), str(dump), *options], out)
    return code == EQUAL, out.getvalue()


class References(unittest.TestCase):
    """One run of each case; what is asked of it depends on the step."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def expect_equal(self, case, name, *options, dump="atoms.dump"):
        with self.subTest(f"{case.name} {name}"):
            equal, text = regress(REFERENCES / f"{case.name}.{name}.dump.gz",
                                  self.folder / case.name / dump, *options)
            self.assertTrue(equal, f"\n{text}")

    def test_particles(self):
        ratios = []
        for case in CASES:
            (self.folder / case.name).mkdir()
            output = run_case(case, os.environ["GRANFLUX"], shlex.split(os.environ["MPIRUN"]),
                              self.folder / case.name, STEPS, RANKS, THREADS)
            self.expect_path_of_threads(case, output)
            self.expect_equal(case, "first", "--step", "1", "--default", str(FIRST_TOLERANCE))
            self.expect_equal(case, "hundred", "--step", str(HUNDRED), "--default", str(HUNDRED_TOLERANCE))
            if case.history_size:
                self.expect_equal_contacts(case)
            if STEPS == LATE:
                self.expect_no_further_than_rounding(case, ratios)
                self.expect_equal_statistics(case)
        if LONG:
            self.assertLessEqual(statistics.median(ratios), 1.0, sorted(ratios))

    def expect_path_of_threads(self, case, output):
        """That what is compared was computed by particle subset, not by LIGGGHTS' own loops."""
        with self.subTest(f"{case.name} path"):
            self.assertIn("granflux: contact forces by particle subset", output)
            self.assertNotIn("LIGGGHTS' own", output)
            self.assertRegex(output, rf"granflux: particle work of {RANKS} ranks? x {THREADS} threads?,")

    def expect_equal_contacts(self, case):
        columns = history_columns(case)
        vectors = [f"history{k}={','.join(columns[k:k + 3])}" for k in range(0, len(columns), 3)]
        self.expect_equal(
            case, "contacts", "--step", str(HUNDRED), "--default", str(HUNDRED_TOLERANCE),
            "--key", "c_pair[1],c_pair[2]", "--odd", ",".join(columns),
            *(word for vector in vectors for word in ("--vector", vector)), dump="contacts.dump")

    def expect_no_further_than_rounding(self, case, ratios):
        reference = REFERENCES / f"{case.name}.thousand.dump.gz"
        comparison = Comparison()
        dump = self.folder / case.name / "atoms.dump"
        ours = next(read_dump(dump, ignored=("fx", "fy", "fz", "tqx", "tqy", "tqz"), steps={THOUSAND}))
        comparison.add(next(read_dump(reference)), ours)
        self.assertEqual(comparison.messages, [])
        for found in comparison.differences:
            if found.quantity in ("type", "radius"):
                continue
            spread = SPREAD[case.name][str(THOUSAND)][found.quantity]
            ratios.append(found.relative / max(spread, HUNDRED_TOLERANCE))
            with self.subTest(f"{case.name} {found.quantity} at step {THOUSAND}"):
                self.assertLessEqual(found.relative, max(CHANCE * spread, HUNDRED_TOLERANCE))

    def expect_equal_statistics(self, case):
        spread = SPREAD[case.name][str(LATE)]
        tolerances = []
        for name, absolute in STATISTICS.items():
            relative = CHANCE * spread.get(name, 0.0) + LATE_ROUNDING
            tolerances += ["--tolerance", f"{name}={relative},{absolute}"]
        self.expect_equal(case, "late", "--step", str(LATE), "--statistics", "--density", str(DENSITY),
                          "--tolerance", f"mass={LATE_ROUNDING}", *tolerances)



if __name__ == "__main__":
    unittest.main()
