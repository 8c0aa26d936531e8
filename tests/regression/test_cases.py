# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The cases of reference_runs/cases.txt cover what they claim, and have their references."""

import itertools
import json
import unittest

from case_table import OPTIONS, read_cases
from run_case import REFERENCES, packing_name

MODEL = [column for column in OPTIONS if column not in ("density", "runs")]
LARGEST = 3.2e6  # bytes of all references
SHORT_SHARE = 0.85  # of all pairs of options, that the short cases hold


def pairs_of(cases, columns):
    return {
        (a, getattr(case, a), b, getattr(case, b))
        for case in cases
        for a, b in itertools.combinations(columns, 2)
    }


def all_pairs(columns):
    return {
        (a, x, b, y)
        for a, b in itertools.combinations(columns, 2)
        for x in OPTIONS[a]
        for y in OPTIONS[b]
    }


class Cases(unittest.TestCase):
    def test_every_pair_of_options_meets_dense_and_dilute(self):
        for density in OPTIONS["density"]:
            cases = [case for case in read_cases() if case.density == density]
            self.assertEqual(all_pairs(MODEL) - pairs_of(cases, MODEL), set(), density)

    def test_short_cases_hold_every_option_and_most_pairs(self):
        columns = ["density", *MODEL]
        short = [case for case in read_cases() if case.runs == "short"]
        for column in columns:
            self.assertEqual({getattr(case, column) for case in short}, set(OPTIONS[column]))
        pairs = pairs_of(short, columns)
        self.assertGreaterEqual(len(pairs), SHORT_SHARE * len(all_pairs(columns)))

    def test_names_are_unique(self):
        names = [case.name for case in read_cases()]
        self.assertEqual(len(names), len(set(names)))


class References(unittest.TestCase):
    def test_every_case_has_its_dumps_and_nothing_else_is_there(self):
        expected = {"manifest.json"}
        for case in read_cases():
            expected |= {f"{case.name}.{part}.dump.gz" for part in ("first", "hundred", "thousand", "late")}
            expected |= {f"{case.name}.contacts.dump.gz"} if case.history_size else set()
            expected |= {packing_name(case)} if case.density == "dense" else set()
        self.assertEqual({path.name for path in REFERENCES.iterdir()}, expected)
        spread = json.loads((REFERENCES / "manifest.json").read_text())["spread"]
        self.assertEqual(set(spread), {case.name for case in read_cases()})

    def test_they_stay_small(self):
        self.assertLess(sum(path.stat().st_size for path in REFERENCES.iterdir()), LARGEST)


if __name__ == "__main__":
    unittest.main()
