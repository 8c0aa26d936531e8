# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""[coupling] coarse_graining in a bed that moves and is cooled: parcels do what the particles do that they stand for.

A bed of hot particles is fluidised by air at a given coefficient of heat transfer h. Particles are mixed, and air passes
through them as through a row of plates, so that with NTU = h S/(rho c u A), S the surface of all particles,

    M c_p dT/dt = -rho c u A (1 - exp(-NTU)) (T - T_in).

The bed's weight is borne by the pressure drop. How far it expands has no closed form: parcels are compared with particles.
"""

import math
import unittest

from host import HostTest, thermo_rows

SIDE, DIAMETER, DENSITY, COUNT = 6e-3, 6e-4, 1000.0, 640
SPEED, GAS_DENSITY, GAS_CAPACITY, COEFFICIENT = 0.35, 1.2, 1000.0, 20.0
SOLID_CAPACITY, HOT, INLET = 500.0, 400.0, 300.0
STEP, STEPS = 2.7e-5, 11000

CASE = f"""
[grid]
size = [{SIDE}, {SIDE}, 24e-3]
periodic = [true, true, false]
cells = [3, 3, 12]
[fluid]
density = {GAS_DENSITY}
viscosity = 1.8e-5
[energy]
heat_capacity = {GAS_CAPACITY}
conductivity = 0.026
initial_temperature = {INLET}
[[boundary]]
name = "inlet"
side = "z_low"
type = "inlet"
velocity = [0, 0, {SPEED}]
temperature = {INLET}
[[boundary]]
name = "outlet"
side = "z_high"
type = "outlet"
[coupling]
heat_transfer_coefficient = {COEFFICIENT}
coarse_graining = GRAIN
"""

# Springs and dashpots that give parcels the overlap, the restitution and the contact time of the particles over their size.
SCRIPT = f"""
units           si
atom_style      granular
atom_modify     map array sort 1000 0.0
boundary        p p f
newton          off
communicate     single vel yes
region          box block 0 {SIDE} 0 {SIDE} 0 24e-3 units box
create_box      1 box
variable        d equal {DIAMETER}*${{grain}}
variable        spacing equal 7.5e-4*${{grain}}
lattice         sc ${{spacing}} origin 0.5 0.5 0.5
region          filled block 0 {SIDE} 0 {SIDE} 0 7.4e-3 units box
create_atoms    1 region filled
set             group all diameter ${{d}} density {DENSITY}
displace_atoms  all random 2e-5 2e-5 2e-5 49979687 units box
variable        k equal 5*${{grain}}
variable        kt equal 2/7*v_k
variable        mass equal PI/6*{DENSITY}*v_d^3
variable        g equal 0.4*sqrt(v_k*v_mass/2)
fix             kn all property/global kn peratomtypepair 1 ${{k}}
fix             kt all property/global kt peratomtypepair 1 ${{kt}}
fix             gn all property/global gamman_abs peratomtypepair 1 ${{g}}
fix             gt all property/global gammat_abs peratomtypepair 1 ${{g}}
fix             mu all property/global coefficientFriction peratomtypepair 1 0.1
fix             yo all property/global youngsModulusOriginal peratomtype 70e9
fix             pr all property/global poissonsRatio peratomtype 0.3
fix             tk all property/global thermalConductivity peratomtype 1
fix             tc all property/global thermalCapacity peratomtype {SOLID_CAPACITY}
pair_style      gran model hooke/stiffness tangential history absolute_damping on
pair_coeff      * *
neighbor        3e-4 bin
neigh_modify    delay 0
fix             floor all wall/gran model hooke/stiffness tangential history primitive type 1 zplane 0 absolute_damping on
fix             gravity all gravity 9.81 vector 0 0 -1
fix             move all nve/sphere
fix             heat all granflux/heat initial_temperature {HOT} conduction off friction off
fix             gas all granflux/couple case case.toml couple_every 10
variable        height equal xcm(all,z)
thermo_style    custom step time atoms f_gas[1] v_height f_heat[1]
thermo_modify   lost error norm no format float %.9g
thermo          100
timestep        {STEP}
run             {STEPS}
"""


def cooling():
    """Fall of the mean temperature over the run [K]."""
    stream = GAS_DENSITY * GAS_CAPACITY * SPEED * SIDE**2  # W/K
    bed = COUNT * math.pi / 6 * DIAMETER**3 * DENSITY * SOLID_CAPACITY  # J/K
    ntu = COEFFICIENT * COUNT * math.pi * DIAMETER**2 / stream
    return (HOT - INLET) * -math.expm1(-stream / bed * -math.expm1(-ntu) * STEP * STEPS)


class Parcels(HostTest):
    def run_bed(self, grain, told=None):
        """Mean pressure drop [Pa] and height [m] once the bed is up; cooling [K]."""
        self.write("case.toml", CASE.replace("GRAIN", str(told or grain)))
        rows = [row for row in thermo_rows(self.run_script(SCRIPT, options=("-var", "grain", str(grain)))) if len(row) == 6]
        self.assertEqual(rows[-1][2], COUNT / grain**3)
        up = [row for row in rows if row[0] > STEPS / 3]
        return sum(r[3] for r in up) / len(up), sum(r[4] for r in up) / len(up), HOT - rows[-1][5]

    def test_bed_of_parcels_is_the_bed_of_particles(self):
        weight = COUNT * math.pi / 6 * DIAMETER**3 * (DENSITY - GAS_DENSITY) * 9.81 / SIDE**2
        drop, height, cooled = self.run_bed(1)
        parcels_drop, parcels_height, parcels_cooled = self.run_bed(2)
        for pressure in (drop, parcels_drop):
            self.assertAlmostEqual(pressure / weight, 1, delta=0.05)
        for fall in (cooled, parcels_cooled):
            self.assertAlmostEqual(fall / cooling(), 1, delta=0.01)
        self.assertAlmostEqual(parcels_cooled / cooled, 1, delta=0.004)
        # Other places at first change the height by 0.4 %.
        self.assertAlmostEqual(parcels_height / height, 1, delta=0.015)

    def test_a_factor_that_is_five_percent_off_is_noticed(self):
        _, height, cooled = self.run_bed(2)
        _, wrong_height, wrong_cooled = self.run_bed(2, told=2.1)
        self.assertGreater(wrong_height / height, 1.02)
        self.assertGreater(wrong_cooled / cooling(), 1.01)


if __name__ == "__main__":
    unittest.main()
