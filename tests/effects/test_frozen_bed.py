# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Frozen particles: contacts with each other and with walls at rest are not evaluated step by step, and nothing else
notices: beside the same runs with every contact, by LIGGGHTS' own loops."""

import unittest

from host import HostTest, bed, dump, largest_difference, last_snapshot, thermo_rows

LOW = "region low block 0 10e-3 0 6e-3 0 2.2e-3 units box\ngroup low region low\ngroup rest subtract all low\n"
# What fix freeze tells is told often; lists are built anew every 30 steps whether or not anything moves.
TOLD = """thermo_style custom step atoms f_hold[1] f_hold[2] f_hold[3]
thermo_modify lost error norm no format float %.17g
thermo 7
neigh_modify delay 0 every 30 check no
"""
REST = "velocity low set 0 0 0\nset group low omegax 0 omegay 0 omegaz 0\n"
FLOOR = "primitive type 1 zplane 0"
# The floor as two triangles.
STL = """solid floor
facet normal 0 0 1
outer loop
vertex -1e-3 -1e-3 0
vertex 11e-3 -1e-3 0
vertex 11e-3 7e-3 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex -1e-3 -1e-3 0
vertex 11e-3 7e-3 0
vertex -1e-3 7e-3 0
endloop
endfacet
endsolid floor
"""


class FrozenBed(HostTest):
    def setUp(self):
        super().setUp()
        self.write("floor.stl", STL)

    def scene(self, name, floor=FLOOR, rest=REST, more=""):
        """Particles settle, some are frozen and then set free again."""
        self.assertIn(FLOOR, bed())
        mesh = "fix m all mesh/surface file floor.stl type 1\n" if floor.startswith("mesh") else ""
        first = bed(bottom=0.46).replace(FLOOR, floor).replace("fix             zlow", mesh + "fix             zlow")
        told = TOLD + f"dump d all custom 20 {name} id x y z vx vy vz omegax omegay omegaz\n"
        told += 'dump_modify d sort id format "%d' + " %.17g" * 9 + '"\n'
        frozen = LOW + rest + "fix hold low freeze\nunfix move\nfix move rest nve/sphere\n" + more
        free = "thermo_style one\nunfix hold\n" + ("unfix carry\n" if more else "") + "fix low low nve/sphere\n"
        return first + "run 600\n" + frozen + told + "run 100\n" + free + "run 20\n"

    def compare(self, tolerance=1e-7, threads=1, set_free=True, **scene):
        """Both ways; returns what fix freeze told, by ours. `set_free`: and compares what happens afterwards."""
        outputs = [
            self.run_script(self.scene("ours", **scene), options=("-threads", str(threads))),
            self.run_script(self.scene("stock", **scene), options=("-subset", "off")),
        ]
        ours, stock = ([row for row in thermo_rows(o) if len(row) == 5] for o in outputs)
        self.assertEqual(len(ours), len(stock))
        self.assertGreater(len(ours), 15)
        largest = max(abs(f) for row in stock for f in row[2:])
        self.assertGreater(largest, 1e-4)  # N: some weights
        for row, reference in zip(ours, stock):
            self.assertEqual(row[:2], reference[:2])
            for a, b in zip(row[2:], reference[2:]):
                self.assertAlmostEqual(a, b, delta=tolerance * largest)
        if set_free:  # contacts have remembered what they should; friction at its bound goes by the last digit
            after = [last_snapshot(self.read(name)) for name in ("ours", "stock")]
            self.assertLess(largest_difference(*after), 1e-3)
        return ours

    def test_floor(self):
        self.compare()
        self.compare(threads=2)

    def test_floor_of_triangles(self):
        self.compare(floor="mesh n_meshes 1 meshes m")

    def test_floor_that_slides(self):
        told = self.compare(floor=FLOOR + " shear x 0.05", set_free=False)
        self.assertGreater(abs(told[-1][2] - told[1][2]), 1e-6)  # its springs stretch meanwhile

    def test_frozen_in_flight(self):
        # They keep velocities and spins that are not theirs: dashpots act, springs at walls stretch; those between
        # them do not.
        told = self.compare(rest="velocity low set 0.01 -0.02 0\nset group low omegax 3 omegay 5\n", set_free=False)
        self.assertGreater(abs(told[-1][2] - told[1][2]), 1e-6)

    def test_frozen_and_carried_away(self):
        self.compare(more="fix carry low move linear 0 0 -0.05\n", set_free=False)

    def test_frozen_before_the_walls_are_named(self):
        # Forces of the walls are then not among those that fix freeze takes away: dumps show them.
        forces = {}
        for name, options in (("ours", ()), ("stock", ("-subset", "off"))):
            script = bed(bottom=0.4).replace("fix             zlow", LOW + "fix hold low freeze\nfix             zlow")
            script += "unfix move\nfix move rest nve/sphere\n"
            script += f'dump f all custom 40 {name} id fx fy fz tqx tqy tqz\ndump_modify f sort id format "%d'
            self.run_script(script + " %.17g" * 6 + '"\nrun 40\n', options=options)
            forces[name] = last_snapshot(self.read(name))
        self.assertGreater(max(row[2] for row in forces["stock"].values()), 1e-2)
        self.assertLess(largest_difference(forces["ours"], forces["stock"], 6), 1e-9)


if __name__ == "__main__":
    unittest.main()
