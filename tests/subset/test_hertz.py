# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Model hertz with every tangential, rolling and cohesion law, on two threads."""

import unittest

from beside_stock import BesideStock


class Hertz(BesideStock):
    def test_with_every_other_law(self):
        self.compare_all_with("hertz")


if __name__ == "__main__":
    unittest.main()
