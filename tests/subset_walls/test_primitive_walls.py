# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Planes and cylinders, standing and turning, by every contact law: as in the stock program."""

import unittest

from beside_stock import (SPHERES, STIFFNESS, STIFFNESS_WALL, YOUNG, YOUNG_WALL, BesideStock,
                          run_and_dump)

BOX = {"xl": "xplane -9.4e-3", "xh": "xplane 9.4e-3", "yl": "yplane -9.4e-3", "yh": "yplane 9.4e-3",
       "zl": "zplane -9.4e-3", "zh": "zplane 9.4e-3"}
MOTION = """
fix             gravity all gravity 9.81 vector 0.3 0 -1
fix             move all nve/sphere
"""


def stiffness_walls(walls, more=""):
    return "".join(STIFFNESS_WALL.format(id=name, wall=f"primitive type {1 + k % 2} {wall} {more}")
                   for k, (name, wall) in enumerate(walls.items()))


class PrimitiveWalls(BesideStock):
    def check_touching(self, script, **more):
        outputs = self.check(script, **more)
        self.assertGreater(self.wall_contacts(), 30)
        return outputs

    def test_planes(self):
        self.check_touching(SPHERES.format(spacing=2.2e-3) + STIFFNESS + stiffness_walls(BOX) +
                            MOTION + run_and_dump())

    def test_planes_of_a_dense_packing(self):
        self.check_touching(SPHERES.format(spacing=1.25e-3) + STIFFNESS + stiffness_walls(BOX) +
                            MOTION + run_and_dump())

    def test_sliding_plane(self):
        walls = dict(BOX, zl=BOX["zl"] + " shear x 0.8", yh=BOX["yh"] + " shear y 0.3")
        self.check_touching(SPHERES.format(spacing=2.2e-3) + STIFFNESS + stiffness_walls(walls) +
                            MOTION + run_and_dump())

    def test_cylinders(self):
        for axis in "xyz":
            with self.subTest(axis):
                walls = {"drum": f"{axis}cylinder 11.65e-3 0 0", "core": f"{axis}cylinder 1.55e-3 0 0"}
                clear = f"""
region          core cylinder {axis} 0 0 1e-3 INF INF units box
delete_atoms    region core
region          drum cylinder {axis} 0 0 11.05e-3 INF INF side out units box
delete_atoms    region drum
"""
                mixes = [(1, 2), (2, 2)] if axis != "z" else None
                self.check_touching(SPHERES.format(spacing=2.2e-3) + clear + STIFFNESS +
                                    stiffness_walls(walls) + MOTION + run_and_dump(),
                                    **({"mixes": mixes} if mixes else {}))

    def test_turning_drum(self):
        # `shear` across the axis is an angular velocity in rad/s, whatever the manual says.
        walls = {"drum": "zcylinder 11.65e-3 0 0 shear x 30"}
        clear = """
region          drum cylinder z 0 0 11.05e-3 INF INF side out units box
delete_atoms    region drum
"""
        self.check_touching(SPHERES.format(spacing=2.2e-3) + clear + STIFFNESS +
                            stiffness_walls(walls) + MOTION + run_and_dump())

    def test_contact_laws(self):
        friction = [f"tangential history cohesion {cohesion} rolling_friction {rolling}"
                    for cohesion in ("off", "sjkr") for rolling in ("off", "cdt", "epsd2")]
        friction += ["tangential no_history", "tangential off"]
        for model in (f"{normal} {laws}" for normal in ("hooke", "hertz") for laws in friction):
            with self.subTest(model):
                walls = "".join(YOUNG_WALL.format(id=name, model=model,
                                                  wall=f"primitive type {1 + k % 2} {wall}")
                                for k, (name, wall) in enumerate(BOX.items()))
                self.check(SPHERES.format(spacing=2.2e-3) + YOUNG.format(model=model) + walls +
                           MOTION + run_and_dump(every=99), mixes=[(1, 2)])

    def test_wall_for_some_particles(self):
        script = (SPHERES.format(spacing=2.2e-3) + STIFFNESS +
                  stiffness_walls(BOX).replace("fix zl all", "fix zl right") + MOTION +
                  run_and_dump())
        self.check_touching(script, mixes=[(1, 2), (2, 1)])

    def test_force_stored(self):
        script = (SPHERES.format(spacing=2.2e-3) + STIFFNESS +
                  stiffness_walls(BOX, "store_force yes") + MOTION +
                  "compute sum all reduce sum f_force_zl[3] f_force_xh[1]\n"
                  "thermo_style custom step atoms c_sum[1] c_sum[2]\n"
                  "thermo_modify lost ignore norm no format float %.17g\nthermo 20\n" +
                  run_and_dump())
        outputs = self.check_touching(script, mixes=[(1, 2)])
        stock, found = outputs[1, 2]
        rows = [[line for line in text.splitlines() if line.split()[:1] in (["80"], ["100"])]
                for text in (stock, found)]
        self.assertEqual(len(rows[0]), 2)
        for expected, value in zip(*rows):
            for a, b in zip(expected.split(), value.split()):
                self.assertAlmostEqual(float(a), float(b), delta=1e-10 * abs(float(a)))
            self.assertNotEqual(float(expected.split()[2]), 0)

    def test_what_is_left_to_the_stock_program_is_said(self):
        script = (SPHERES.format(spacing=2.2e-3) + STIFFNESS +
                  stiffness_walls(BOX, "store_force_contact yes") + MOTION + run_and_dump())
        for _, output in self.check_touching(script, mixes=[(1, 2)]).values():
            self.assertEqual(output.count("granflux: fix wall/gran is LIGGGHTS' own for forces "
                                          "stored for each contact"), 1)


if __name__ == "__main__":
    unittest.main()
