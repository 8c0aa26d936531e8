# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Forces by particle subset compared with those of the stock program."""

import itertools
import unittest

from host import GRANFLUX, LIGGGHTS, HostTest
from packed_box import data_file, difference, script, snapshots

TANGENTIAL = ["", "tangential history", "tangential no_history"]
ROLLING = ["", "rolling_friction cdt", "rolling_friction epsd2"]
COHESION = ["", "cohesion sjkr"]

FIRST_STEP = 1e-12  # rounding: each program adds the contacts of a particle in its own order
AFTER_100 = 1e-10  # the same, grown with the steps


def words(normal, tangential="", cohesion="", rolling="", options=""):
    return " ".join(filter(None, ["model", normal, tangential, cohesion, rolling, options]))


def dense(cells=7, types=2, **options):
    return data_file(3 * (cells,), 0.98, 0.1, 50.0, 0.02, types=types, **options)


@unittest.skipUnless(LIGGGHTS, "the stock program liggghts is not installed")
class BesideStock(HostTest):
    def compare(self, text, ways, data=None, by_subset=True):
        """text: script with NAME for the name of its dump. ways: (ranks, threads)."""
        self.write("data.box", data or dense())
        self.run_script(text.replace("NAME", "stock.txt"), 1, LIGGGHTS)
        stock = snapshots(self.read("stock.txt"))
        for ranks, threads in ways:
            options = ("-threads", str(threads))
            output = self.run_script(text.replace("NAME", "subset.txt"), ranks, GRANFLUX, options)
            self.assertEqual("contact forces by particle subset" in output, by_subset, output)
            ours = snapshots(self.read("subset.txt"))
            self.assertEqual(stock.keys(), ours.keys())
            for step, rows in stock.items():
                limit = FIRST_STEP if step <= 1 else AFTER_100
                for name, value in difference(rows, ours[step]).items():
                    where = f"{name} at step {step}, {ranks} ranks x {threads} threads"
                    self.assertLess(value, limit, where)

    def compare_all_with(self, normal):
        for tangential, cohesion, rolling in itertools.product(TANGENTIAL, COHESION, ROLLING):
            model = words(normal, tangential, cohesion, rolling)
            with self.subTest(model=model):
                self.compare(script("NAME", model), [(1, 2)], dense(cells=4))
