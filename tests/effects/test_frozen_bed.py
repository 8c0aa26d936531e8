# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Frozen particles: their contacts with each other are not evaluated, and nothing else notices."""

import unittest

from host import HostTest, bed, dump, last_snapshot

FREEZE = "region low block 0 10e-3 0 6e-3 0 2.2e-3 units box\ngroup low region low\ngroup rest subtract all low\n"


class FrozenBed(HostTest):
    def script(self, name, options=""):
        half = bed().replace("fix             move all nve/sphere", FREEZE + "fix hold low freeze\nfix move rest nve/sphere")
        forces = f'dump f all custom 400 forces.{name} id fx fy fz tqx tqy tqz\ndump_modify f sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g"\n'
        return half + dump(name, 400) + forces + "run 400\n"

    def test_moving_particles_feel_the_same(self):
        # Beside the same loops with all pairs, those of LIGGGHTS: the same contacts, other sums.
        self.run_script(self.script("ours"))
        self.run_script(self.script("stock"), options=("-subset", "off"))
        ours, stock = last_snapshot(self.read("ours")), last_snapshot(self.read("stock"))
        for particle, row in stock.items():
            for a, b in zip(ours[particle][:3], row[:3]):
                self.assertAlmostEqual(a, b, delta=1e-9)  # m: 1e-6 of a diameter
        frozen = {i for i, row in last_snapshot(self.read("forces.stock")).items() if not any(row)}
        self.assertGreater(len(frozen), 50)
        self.assertEqual(frozen, {i for i, row in last_snapshot(self.read("forces.ours")).items() if not any(row)})


if __name__ == "__main__":
    unittest.main()
