# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Without particle subsets a script that uses nothing of GranFlux gives the dump of the stock program,
byte for byte; tests/subset says how near it comes with them."""

import unittest

from host import LIGGGHTS, GRANFLUX, HostTest, bed, dump


@unittest.skipUnless(LIGGGHTS, "the stock program liggghts is not installed")
class StockIdentity(HostTest):
    def compare(self, ranks):
        dumps = {}
        script = bed(bottom=0.97) + dump("dump.txt", 100) + "run 800\n"
        for program, options in ((LIGGGHTS, ()), (GRANFLUX, ("-subset", "off"))):
            self.run_script(script, ranks, program, options)
            dumps[program] = self.read("dump.txt")
        self.assertEqual(dumps[LIGGGHTS].count("ITEM: TIMESTEP"), 9)
        self.assertEqual(dumps[LIGGGHTS], dumps[GRANFLUX])

    def test_one_rank(self):
        self.compare(1)

    def test_two_ranks(self):
        self.compare(2)


if __name__ == "__main__":
    unittest.main()
