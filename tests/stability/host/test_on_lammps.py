# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Some of the hard cases on the other host."""

import os
import unittest

import test_stiff as stiff
from host import couple
from scenes import AIR, GRAVITY, HardCase, box, lattice, thermo, volume

HEAD = """
units           si
atom_style      sphere
atom_modify     map array
boundary        {boundary}
newton          off
comm_modify     vel yes
read_data       data.spheres
pair_style      gran/hooke {kn} 0 {gn} 0 0 0
pair_coeff      * *
neighbor        {skin} bin
neigh_modify    delay 0
timestep        {dt}
fix             move all nve/sphere
"""
GRAVITY_FIX = f"fix gravity all gravity {GRAVITY} vector 0 0 -1\n"


def head(dt, boundary="p p p", kn=1, gn=0, skin=1e-4):
    return HEAD.format(dt=dt, boundary=boundary, kn=kn, gn=gn, skin=skin)


class OnLammps(HardCase):
    PROGRAM = dict(program=os.environ["GRANFLUX_LAMMPS"])

    def test_stiff_drag(self):
        """As in test_stiff: dust and gas meet at their common velocity, from either side."""
        number = stiff.NUMBER**3
        gas_mass = AIR["density"] * (stiff.SIDE**3 - number * volume(stiff.DIAMETER))
        mass = number * stiff.MASS
        for every, interval in ((1, 1000), (100, 10)):
            script = head(interval * stiff.RELAXATION / every) + couple(every) + thermo(every) + f"run {20 * every}\n"
            rows, _ = self.run_scene(script, stiff.dust(), stiff.LOW, stiff.HIGH, stiff.CASE, **self.PROGRAM)
            for d, speed in enumerate(stiff.SPEED):
                common = mass * speed / (mass + gas_mass)
                distances = [abs(row.velocity[d] - common) for row in rows]
                for one, other in zip(distances, distances[1:]):
                    self.assertLessEqual(other, one + 1e-9 * abs(speed))
                self.assertAlmostEqual(rows[-1].velocity[d] / common, 1, delta=1e-6)

    def test_sudden_inlet_under_a_bed(self):
        diameter, number, height = 1e-3, 6, 30e-3
        side = number * diameter
        sides = {"z_low": 'type = "inlet"\nvelocity = [0, 0, 0.6]', "z_high": 'type = "outlet"'}
        case = box((side, side, height), (3, 3, 15), AIR, sides)
        spheres = lattice((number,) * 3, diameter, diameter, 1000.0)
        script = (
            head(1e-5, boundary="p p f", kn=500, gn=5000, skin=3e-4)
            + "fix floor all wall/gran hooke 500 0 5000 0 0 0 zplane 0 NULL\n"
            + GRAVITY_FIX
            + couple(10)
            + thermo(50)
        )
        rows, _ = self.run_scene(script + "run 2500\n", spheres, (0, 0, 0), (side, side, height), case, **self.PROGRAM)
        weight = len(spheres) * volume(diameter) * (1000.0 - AIR["density"]) * GRAVITY / side**2
        for row in rows:
            self.assertTrue(0.9 < row.gas[1] / weight < 1.5)
        self.assertAlmostEqual(rows[-1].gas[1] / weight, 1, delta=0.02)

    def test_no_room_for_gas(self):
        spheres = lattice((4, 4, 4), 1e-3, 1e-3, 1000.0)
        case = box((4e-3,) * 3, (8, 8, 8), AIR, more='[coupling]\nvoid_fraction = "centre"\n')
        script = head(1e-5, kn=500, skin=3e-4) + couple(10) + thermo(10) + "run 10\n"
        code, output = self.start_scene(script, spheres, (0, 0, 0), (4e-3,) * 3, case, **self.PROGRAM)
        self.assertNotIn(code, (0, 124))
        self.assertIn("is below void_fraction_floor = 0.05", output)

    def test_all_leave(self):
        sides = {side: 'type = "slip"' for side in ("x_low", "x_high", "y_low", "y_high")}
        sides |= {"z_low": 'type = "inlet"\nvelocity = [0, 0, 0.5]', "z_high": 'type = "outlet"'}
        spheres = lattice((4, 4, 4), 1e-3, 1e-3, 1000.0, (0, 0, 20.0))
        script = head(1e-5, boundary="f f f", kn=500, skin=3e-4) + GRAVITY_FIX + couple(5)
        for ranks in (1, 2):
            rows, _ = self.run_scene(
                script + thermo(10, lost="ignore") + "run 200\n",
                spheres,
                (0, 0, 0),
                (4e-3, 4e-3, 8e-3),
                box((4e-3, 4e-3, 8e-3), (2, 2, 4), AIR, sides),
                ranks=ranks,
                **self.PROGRAM,
            )
            self.assertEqual([rows[0].gas[16], rows[-1].gas[16]], [64, 0])


if __name__ == "__main__":
    unittest.main()
