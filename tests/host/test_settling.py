# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Closed-form answers for single particles and for a suspension in a closed box."""

import math
import unittest

from host import HostTest, couple, thermo_rows

# Stokes drag: v = (rho_p - rho) d^2 g / (18 mu).
DIAMETER, DENSITY, GAS, VISCOSITY, GRAVITY = 1e-4, 1000.0, 1.2, 1.8e-5, 9.81
TERMINAL = (DENSITY - GAS) * DIAMETER**2 * GRAVITY / (18 * VISCOSITY)

ONE_SPHERE = f"""
units           si
atom_style      granular
atom_modify     map array
boundary        f f f
newton          off
communicate     single vel yes
region          box block 0 20e-3 0 20e-3 0 100e-3 units box
create_box      1 box
create_atoms    1 single 9.7e-3 10.4e-3 95e-3 units box
set             group all diameter {DIAMETER} density {DENSITY}
fix             kn all property/global kn peratomtypepair 1 1
fix             kt all property/global kt peratomtypepair 1 1
fix             gn all property/global gamman_abs peratomtypepair 1 0
fix             gt all property/global gammat_abs peratomtypepair 1 0
fix             mu all property/global coefficientFriction peratomtypepair 1 0
pair_style      gran model hooke/stiffness tangential history absolute_damping on
pair_coeff      * *
neighbor        1e-3 bin
fix             gravity all gravity {GRAVITY} vector 0 0 -1
fix             move all nve/sphere
timestep        1e-4
"""

STILL_AIR = f"""
[grid]
size = [20e-3, 20e-3, 100e-3]
cells = [4, 4, 20]
[fluid]
density = {GAS}
viscosity = {VISCOSITY}
[coupling]
drag = "stokes"
""" + "".join(
    f'[[boundary]]\nname = "{side}"\nside = "{side}"\ntype = "{kind}"\n'
    for side, kind in [
        ("x_low", "slip"),
        ("x_high", "slip"),
        ("y_low", "slip"),
        ("y_high", "slip"),
        ("z_low", "wall"),
        ("z_high", "outlet"),
    ]
)

# Particles that move through a gas at rest in a periodic box: both end at the mean velocity.
PERIODIC = """
units           si
atom_style      granular
atom_modify     map array
boundary        p p p
newton          off
communicate     single vel yes
region          box block 0 8e-3 0 8e-3 0 8e-3 units box
create_box      1 box
lattice         sc 1e-3 origin 0.5 0.5 0.5
create_atoms    1 box
set             group all diameter 1e-4 density 1000
velocity        all set 0.1 -0.2 0.3 units box
fix             kn all property/global kn peratomtypepair 1 1
fix             kt all property/global kt peratomtypepair 1 1
fix             gn all property/global gamman_abs peratomtypepair 1 0
fix             gt all property/global gammat_abs peratomtypepair 1 0
fix             mu all property/global coefficientFriction peratomtypepair 1 0
pair_style      gran model hooke/stiffness tangential history absolute_damping on
pair_coeff      * *
neighbor        2e-4 bin
fix             move all nve/sphere
timestep        1e-4
"""

PERIODIC_AIR = f"""
[grid]
size = [8e-3, 8e-3, 8e-3]
cells = [4, 4, 4]
periodic = [true, true, true]
[fluid]
density = {GAS}
viscosity = {VISCOSITY}
"""


class Settling(HostTest):
    def test_terminal_velocity_two_way(self):
        self.write("case.toml", STILL_AIR)
        script = (
            ONE_SPHERE
            + couple(5)
            + "variable v equal vcm(all,z)\n"
            + "thermo_style custom step v_v f_gas[4] f_gas[7] f_gas[11]\n"
            + "thermo_modify norm no lost error format float %.17g\nthermo 100\nrun 2500\n"
        )
        _, v, drag, pressure, residual = thermo_rows(self.run_script(script))[-1]
        self.assertAlmostEqual(v / -TERMINAL, 1, delta=0.01)
        weight = (DENSITY - GAS) * math.pi / 6 * DIAMETER**3 * GRAVITY
        self.assertAlmostEqual((drag + pressure) / weight, 1, delta=1e-3)
        self.assertLess(residual, 1e-12)

    def test_momentum_of_gas_and_particles(self):
        self.write("case.toml", PERIODIC_AIR)
        script = (
            PERIODIC
            + couple(5)
            + "variable px equal vcm(all,x)*mass(all)\nvariable py equal vcm(all,y)*mass(all)\n"
            + "variable pz equal vcm(all,z)*mass(all)\nvariable m equal mass(all)\n"
            + "thermo_style custom step v_m v_px v_py v_pz f_gas[22] f_gas[23] f_gas[24] f_gas[11]"
            + " f_gas[13]\n"
            + "thermo_modify norm no lost error format float %.17g\nthermo 100\nrun 8000\n"
        )
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                rows = thermo_rows(self.run_script(script, ranks))
                _, mass, *end = rows[-1]
                for d, start in enumerate((0.1, -0.2, 0.3)):
                    self.assertAlmostEqual((end[d] + end[3 + d]) / (mass * start), 1, delta=1e-12)
                    gas_mass = GAS * ((8e-3) ** 3 - 512 * math.pi / 6 * (1e-4) ** 3)
                    common = mass * start / (mass + gas_mass)
                    self.assertAlmostEqual(end[d] / mass / common, 1, delta=1e-9)
                for row in rows:
                    self.assertLess(row[8], 1e-12)
                    self.assertLess(row[9], 1e-10)

    def test_gas_does_not_move_frozen_particles(self):
        script = (
            ONE_SPHERE.replace("fix             gravity all", "fix held all freeze\nfix gravity all")
            + couple(5)
            + "variable z equal xcm(all,z)\nthermo_style custom step v_z f_gas[4]\n"
            + "thermo_modify format float %.17g\nthermo 50\nrun 200\n"
        )
        wind = STILL_AIR.replace('type = "wall"', 'type = "inlet"\nvelocity = [0, 0, 0.2]')
        self.write("case.toml", wind)
        rows = thermo_rows(self.run_script(script))
        self.assertEqual(rows[0][1], rows[-1][1])
        stokes = 3 * math.pi * VISCOSITY * DIAMETER * 0.2
        self.assertAlmostEqual(rows[-1][2] / stokes, 1, delta=0.01)


if __name__ == "__main__":
    unittest.main()
