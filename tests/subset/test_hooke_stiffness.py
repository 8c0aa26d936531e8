# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Model hooke/stiffness with every tangential, rolling and cohesion law, on two threads."""

import unittest

from beside_stock import BesideStock


class HookeStiffness(BesideStock):
    def test_with_every_other_law(self):
        self.compare_all_with("hooke/stiffness")


if __name__ == "__main__":
    unittest.main()
