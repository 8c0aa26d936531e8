# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The keywords of pair_style gran."""

import unittest

from beside_stock import BesideStock, dense, words
from packed_box import script


class Options(BesideStock):
    def test_every_option(self):
        for normal, options in [
            ("hooke", "ktToKnUser on"),
            ("hooke", "tangential_damping off limitForce on"),
            ("hooke/stiffness", "absolute_damping on"),
            ("hooke/stiffness", "absolute_damping on tangential_damping off limitForce on"),
            ("hertz", "tangential_damping off limitForce on torsionTorque on"),
            ("hertz", "tangential_reduce on"),
            ("hertz", "heating_normal_hertz on heating_tangential_history on"),
            ("hertz/stiffness", "limitForce on torsionTorque on tangential_reduce on"),
        ]:
            with self.subTest(normal=normal, options=options):
                # LIGGGHTS refuses a keyword that none of the laws in use knows.
                model = words(normal, "tangential history", "cohesion sjkr", "rolling_friction epsd2", options)
                self.compare(script("NAME", model), [(1, 1)], dense(cells=4))


if __name__ == "__main__":
    unittest.main()
