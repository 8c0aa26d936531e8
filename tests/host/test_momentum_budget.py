# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Momentum of gas, particles and walls, by the impulses that the integrator applies: velocity Verlet
kicks with half of a force before and half after the positions move, so from step n to n+1 momentum
grows by dt (F_n + F_n+1)/2. The gas's own budget and the hand-over are in the fix's residuals."""

import unittest

from host import HostTest, bed, couple, thermo_rows

WALLS = ("zlow", "xlow", "xhigh", "ylow", "yhigh")
TIME_STEP, GRAVITY = 1e-5, -9.81


class MomentumBudget(HostTest):
    def rows(self, ranks):
        script = bed().replace("&\n                primitive", "&\n                store_force yes primitive")
        script += couple(5)
        columns = []
        for d, axis in enumerate("xyz", start=1):
            script += f"variable p{axis} equal vcm(all,{axis})*mass(all)\n"
            script += f"compute f{axis} all reduce sum f{axis}\n"
            script += f"compute d{axis} all reduce sum f_dragforce[{d}]\n"
            script += "".join(f"compute {w}{axis} all reduce sum f_force_{w}[{d}]\n" for w in WALLS)
            columns += [f"v_p{axis}", f"c_f{axis}", f"c_d{axis}", *(f"c_{w}{axis}" for w in WALLS)]
        script += "variable m equal mass(all)\n"
        script += f"thermo_style custom step v_m f_gas[10] f_gas[11] f_gas[13] {' '.join(columns)}\n"
        script += "thermo_modify norm no lost error format float %.17g\nthermo 1\nrun 300\n"
        return thermo_rows(self.run_script(script, ranks))

    def test_closes_each_step(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                rows = self.rows(ranks)
                self.assertEqual(len(rows), 301)
                mass = rows[0][1]
                hit = 0.0
                for d in range(3):
                    at = 5 + d * (3 + len(WALLS))
                    momentum = rows[0][at]
                    scale = max(abs(row[at]) for row in rows)
                    for before, now in zip(rows, rows[1:]):
                        total, gas, *walls = now[at + 1 : at + 3 + len(WALLS)]
                        outer = gas + sum(walls) + (mass * GRAVITY if d == 2 else 0)
                        # Contacts between particles cancel: what is left acts from outside.
                        size = abs(gas) + sum(map(abs, walls)) + mass * abs(GRAVITY)
                        self.assertLess(abs(total - outer), 1e-10 * size)
                        momentum += 0.5 * TIME_STEP * (before[at + 1] + total)
                        self.assertLess(abs(now[at] - momentum), 1e-10 * scale)
                        hit += sum(map(abs, walls))
                self.assertGreater(hit, 0)
                for row in rows:
                    self.assertLess(row[2], 1e-12)  # void volume
                    self.assertLess(row[3], 1e-12)  # from the gas, to the particles
                    self.assertLess(row[4], 1e-10)  # gas and its boundaries


if __name__ == "__main__":
    unittest.main()
