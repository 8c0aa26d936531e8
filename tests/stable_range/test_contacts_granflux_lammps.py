# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Contacts of LAMMPS last as long as the stable range says."""

import math
import unittest

from collision import DIAMETER, MASS, SPEED, check, told
from host import HostTest

REDUCED_MASS, REDUCED_RADIUS = MASS / 2, DIAMETER / 4


class Contacts(HostTest):
    def as_told(self, style, expected):
        contacts = f"pair_style gran/{style}\npair_coeff * *"
        output, lasted, step = check(self, self.run_script, contacts, expected, lammps=True)
        self.assertLess(abs(told(output, step) / lasted - 1), 6e-3)  # three digits

    def test_linear_spring(self):
        time = math.pi * math.sqrt(REDUCED_MASS / 500)
        self.as_told("hooke 500 0 0 0 0 0", time)
        self.as_told("hooke/history 500 100 0 0 0.1 1", time)

    def test_hertz(self):
        young = 3e6
        time = 2.868 * (REDUCED_MASS**2 / (REDUCED_RADIUS * young**2 * SPEED)) ** 0.2
        self.as_told(f"hertz/history {4 / 3 * young} 0 0 0 0 0", time)


if __name__ == "__main__":
    unittest.main()
