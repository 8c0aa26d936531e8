# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The same forces on any mix of ranks and threads: dense and dilute, frozen, excluded, walled."""

import re
import unittest

from beside_stock import BesideStock, dense, words
from packed_box import data_file, script


class RanksAndThreads(BesideStock):
    MODEL = words("hertz", "tangential history", "", "rolling_friction epsd2")
    WAYS = [(1, 1), (1, 2), (1, 3), (2, 1), (2, 2)]

    def test_dense_periodic(self):
        self.compare(script("NAME", self.MODEL), self.WAYS)

    def test_dilute(self):
        # Fast and far apart: pairs meet and part, lists are built often.
        data = data_file((7, 7, 7), 1.2, 2.0, 500.0, 0.0)
        self.compare(script("NAME", self.MODEL, step=1e-5, sort="sort 3 0.0"), self.WAYS, data)

    def test_frozen_group(self):
        more = "fix hold fixed freeze"
        self.compare(script("NAME", self.MODEL, more=more, fixed="1:60"), self.WAYS)

    def test_excluded_pairs(self):
        more = "neigh_modify exclude group fixed fixed exclude type 1 2"
        self.compare(script("NAME", self.MODEL, more=more, fixed="1:200"), [(1, 2), (2, 1)])

    def test_walls(self):
        wall = "fix w{0} all wall/gran {1} primitive type 1 {0}plane {2}"
        more = "\n".join(
            wall.format(d, words("hertz", "tangential history", "", "rolling_friction epsd2"), place)
            for d, place in (("z", 0.0), ("x", 0.0), ("y", 0.0))
        )
        self.compare(script("NAME", self.MODEL, boundary="f f f", more=more), self.WAYS)

    def test_one_type(self):
        text = script("NAME", words("hooke/stiffness", "tangential history"))
        text = re.sub(r"peratomtypepair 2 (\S+) .*", r"peratomtypepair 1 \1", text)
        text = re.sub(r"peratomtype (\S+) .*", r"peratomtype \1", text)
        self.compare(text, self.WAYS, dense(types=1))


if __name__ == "__main__":
    unittest.main()
