# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Temperatures of LAMMPS' particles: conduction and friction in closed form, exchange with the gas
beside LIGGGHTS, restart, ranks, bad input."""

import math
import unittest

from host import CASE, couple, largest_difference, last_snapshot, thermo_rows
from two_hosts import DENSITY, DIAMETER, MASS, TIME_STEP, TwoHostTest, lammps_bed, liggghts_bed

ENERGY = """
[energy]
heat_capacity = 1000
conductivity = 0.026
initial_temperature = 300
"""
WARM_CASE = CASE.replace("velocity = [0, 0, 0.5]", "velocity = [0, 0, 0.5]\ntemperature = 300") + ENERGY

CAPACITY, CONDUCTIVITY, YOUNG, POISSON = 0.5, 2.0, 70e9, 0.3
MATERIAL = (
    f"thermal_capacity {CAPACITY} thermal_conductivity {CONDUCTIVITY} "
    f"youngs_modulus {YOUNG} poissons_ratio {POISSON}"
)
HEAT = "fix heat all granflux/heat initial_temperature 400 {words} " + MATERIAL + "\n"
PROPERTIES = f"""fix yo all property/global youngsModulusOriginal peratomtype {YOUNG}
fix pr all property/global poissonsRatio peratomtype {POISSON}
fix tk all property/global thermalConductivity peratomtype {CONDUCTIVITY}
fix tc all property/global thermalCapacity peratomtype {CAPACITY}
fix heat all granflux/heat initial_temperature 400 {{words}}
"""
THERMO = (
    "thermo_style custom step f_heat[1] f_heat[2] f_heat[3] f_heat[6] f_heat[8] f_heat[16] f_heat[18] "
    "f_heat[22] f_heat f_heat[5]{gas}\nthermo_modify lost error norm no format float %.17g\nthermo {every}\n"
)
MEAN, LOWEST, HIGHEST, CONDUCTION, FRICTION, FRICTION_ENERGY, CONVECTION_ENERGY, REST, ALL = range(1, 10)
BIOT = 10
WITH_GAS = " f_gas[30] f_gas[31] f_gas[32] f_gas[33]"
RESIDUALS = slice(12, 14)

OVERLAP = 2e-5
TWO = """
units           si
atom_style      sphere
atom_modify     map array
boundary        f f f
newton          {newton}
comm_modify     vel yes
processors      * 1 1
region          box block -5e-3 5e-3 -5e-3 5e-3 -5e-3 5e-3
create_box      1 box
create_atoms    1 single {a} 0 0
create_atoms    1 single {b} {y} 0
set             group all diameter {diameter} density {density}
group           one id 1
group           two id 2
pair_style      gran/{law}
pair_coeff      * *
neighbor        3e-4 bin
timestep        {dt}
"""


def two(distance, law, y=0.0, newton="off", dt=TIME_STEP):
    return TWO.format(
        a=-0.5 * distance, b=0.5 * distance, y=y, law=law, newton=newton, dt=dt, diameter=DIAMETER,
        density=DENSITY,
    )


class Conduction(TwoHostTest):
    def test_two_touching_spheres(self):
        """Held together they come to one temperature by Euler's steps of their closed form."""
        stiffness = 500.0
        radius = 0.25 * DIAMETER  # R_i R_j / (R_i + R_j)
        modulus = 4 / 3 / (2 * (1 - POISSON**2) / YOUNG)
        lens = OVERLAP * (2 * DIAMETER - OVERLAP) / 4  # squared radius of the intersection
        radii = {
            "hertz": (stiffness * OVERLAP * radius / modulus) ** (1 / 3),
            "geometric": (stiffness * OVERLAP * 2 * radius / modulus) ** (1 / 3),
            "overlap": math.sqrt(radius * OVERLAP),
            "stock": math.sqrt(math.pi * lens),
        }
        steps = 100
        for word, contact in radii.items():
            ways = ((1, "off"), (2, "off"), (2, "on")) if word == "hertz" else ((1, "off"),)
            for ranks, newton in ways:
                with self.subTest(conduction=word, ranks=ranks, newton=newton):
                    script = two(DIAMETER - OVERLAP, f"hooke {stiffness} 0 0 0 0 0", newton=newton)
                    script += HEAT.format(words=f"conduction {word}")
                    script += "fix_modify heat temperature two 300\n"
                    script += THERMO.format(every=steps, gas="") + f"run {steps}\n"
                    row = thermo_rows(self.run_lammps(script, ranks))[-1]
                    conductance = 2 * CONDUCTIVITY * contact
                    decay = 1 - 2 * TIME_STEP * conductance / (MASS * CAPACITY)
                    difference = 100 * decay**steps
                    self.assertTrue(0.1 < difference < 95)
                    self.assertAlmostEqual((row[HIGHEST] - row[LOWEST]) / difference, 1, delta=1e-8)
                    self.assertAlmostEqual(row[MEAN], 350, delta=1e-9)
                    self.assertLess(abs(row[REST]), 1e-12 * row[ALL])
                    biot = conductance / (math.pi * CONDUCTIVITY * DIAMETER / 2)
                    self.assertAlmostEqual(row[BIOT] / biot, 1, delta=1e-8)

    def test_fixed_temperature(self):
        script = two(DIAMETER - OVERLAP, "hooke 500 0 0 0 0 0")
        script += HEAT.format(words="conduction overlap fixed_temperature two")
        script += "fix_modify heat temperature two 300\n" + THERMO.format(every=100, gas="")
        rows = thermo_rows(self.run_lammps(script + "run 2000\n"))
        self.assertEqual(rows[-1][LOWEST], 300)
        self.assertLess(rows[-1][HIGHEST], 399)
        self.assertLess(abs(rows[-1][REST]), 1e-12 * rows[-1][ALL])


class Friction(TwoHostTest):
    def test_an_oblique_collision_heats_by_what_it_loses(self):
        """Without normal damping all that is lost is lost by friction, but for the steps in which
        the spheres meet and part: 3e-3 of it in steps of 1e-7 s."""
        for newton, ranks in (("off", 1), ("off", 2), ("on", 2)):
            with self.subTest(newton=newton, ranks=ranks):
                law = "hooke 1e4 0 0 2e4 0.3 1"
                script = two(0.96 * DIAMETER, law, y=3e-4, newton=newton, dt=1e-8)
                script += "velocity one set 1.0 0 0\nvelocity two set -1.0 0 0\n"
                script += HEAT.format(words="conduction off friction speed")
                script += "fix move all nve/sphere\ncompute ke all ke\ncompute er all erotate/sphere\n"
                script += THERMO.format(every=4000, gas=" c_ke c_er") + "run 4000\n"
                first, last = thermo_rows(self.run_lammps(script, ranks))
                lost = first[11] + first[12] - last[11] - last[12]
                self.assertGreater(lost, 0.02 * first[11])
                self.assertEqual(last[FRICTION], 0)  # they have parted
                self.assertAlmostEqual(last[FRICTION_ENERGY] / lost, 1, delta=1e-4)
                self.assertAlmostEqual((last[ALL] - first[ALL]) / lost, 1, delta=1e-4)


class WithGas(TwoHostTest):
    def setUp(self):
        super().setUp()
        self.write("case.toml", WARM_CASE)

    def lammps(self, words="conduction overlap", heat_first=True, **bed):
        gas, heat = couple(), HEAT.format(words=words)
        return (
            lammps_bed(**bed) + (heat + gas if heat_first else gas + heat)
            + THERMO.format(every=20, gas=WITH_GAS)
            + 'dump d all custom 200 dump.txt id x y z vx vy vz f_heat\n'
            + 'dump_modify d sort id format line "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"\n'
        )

    def liggghts(self, words):
        return (
            liggghts_bed(False) + PROPERTIES.format(words=words) + couple()
            + THERMO.format(every=20, gas=WITH_GAS)
            + 'dump d all custom 200 dump.txt id x y z vx vy vz f_Temp\n'
            + 'dump_modify d sort id format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"\n'
        )

    def end_of(self, script, ranks=1):
        rows = thermo_rows(self.run_lammps(script, ranks))
        for row in rows[1:]:
            for residual in row[RESIDUALS]:
                self.assertLess(residual, 1e-10)
            self.assertLess(abs(row[REST]), 1e-11 * row[ALL])
        return rows, last_snapshot(self.read("dump.txt"))

    def test_as_in_liggghts(self):
        for conduction in ("overlap", "hertz", "off"):
            with self.subTest(conduction=conduction):
                words = f"conduction {conduction} friction off"
                other_rows = thermo_rows(self.run_script(self.liggghts(words) + "run 200\n"))
                others = last_snapshot(self.read("dump.txt"))
                rows, particles = self.end_of(self.lammps(words, history=False) + "run 200\n")
                self.assertLess(largest_difference(particles, others, columns=7), 1e-10)
                self.assertLess(rows[-1][MEAN], 399)
                for a, b in zip(rows, other_rows):
                    for column in (MEAN, LOWEST, HIGHEST, CONVECTION_ENERGY, ALL, 11):
                        self.assertAlmostEqual(a[column], b[column], delta=1e-11 * abs(b[column]))

    def test_ranks_newton_and_order(self):
        one_rows, one = self.end_of(self.lammps() + "run 200\n")
        for ranks, more in (
            (2, {}),
            (2, {"newton": "on"}),
            (1, {"heat_first": False}),
        ):
            with self.subTest(ranks=ranks, **more):
                rows, other = self.end_of(self.lammps(**more) + "run 200\n", ranks)
                self.assertLess(largest_difference(one, other, columns=7), 1e-9)
                self.assertAlmostEqual(rows[-1][ALL] / one_rows[-1][ALL], 1, delta=1e-12)

    def test_restart(self):
        output = self.run_lammps(self.lammps() + "run 100\nwrite_restart warm.restart\nrun 100\n", 2)
        end = thermo_rows(output)[-1]
        split = last_snapshot(self.read("dump.txt"))
        again = self.lammps(source="read_restart warm.restart")
        rows, restarted = self.end_of(again + "run 100\n", 2)
        self.assertEqual(split, restarted)
        for column in (ALL, CONVECTION_ENERGY):
            self.assertEqual(rows[-1][column], end[column])


class BadInput(TwoHostTest):
    def refused(self, heat, *messages, bed=None, ranks=(1,)):
        script = (bed or lammps_bed()) + heat + "run 1\n"
        for count in ranks:
            code, output = self.start_lammps(script, count)
            self.assertNotIn(code, (0, 124), output)
            for message in ("ERROR", *messages):
                self.assertIn(message, output)

    def test_words(self):
        start = "fix heat all granflux/heat "
        self.refused(start + MATERIAL + "\n", "initial_temperature is missing", ranks=(1, 2))
        self.refused(start + "initial_temperature 300\n", "thermal_capacity is missing")
        self.refused(
            start + "initial_temperature 300 thermal_capacity 500\n", "thermal_conductivity is missing"
        )
        self.refused(
            start + "initial_temperature 300 conduction overlap thermal_capacity 500 "
            "thermal_conductivity -1\n", "thermal_conductivity -1",
        )
        self.refused(HEAT.format(words="friction slider"), "friction slider", "speed")
        self.refused(HEAT.format(words="friction speed"), "friction speed", "needs gran/hooke")
        self.refused(HEAT.format(words="damping on"), "damping on", "must be off")
        self.refused(HEAT.format(words="radiation 300"), "radiation", "LIGGGHTS only")
        self.refused(HEAT.format(words="fixed_temperature none"), "fixed_temperature none")
        self.refused(HEAT.format(words="conductoin hertz"), "conductoin", "conduction?")

    def test_gas_with_a_temperature_needs_that_of_particles(self):
        self.write("case.toml", WARM_CASE)
        self.refused(couple(), "define fix granflux/heat", ranks=(1, 2))

    def test_long_time_step(self):
        self.refused(
            HEAT.format(words="conduction overlap"), "time step of 0.5 s is", "use a smaller one",
            bed=two(DIAMETER - OVERLAP, "hooke 500 0 0 0 0 0", dt=0.5),
        )


if __name__ == "__main__":
    unittest.main()
