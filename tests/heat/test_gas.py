# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Heat between particles and gas in whole runs."""

import math
import unittest

from host import CASE, HostTest, bed, bed_from, couple, last_snapshot, thermo_rows

ENERGY = """
[energy]
heat_capacity = 1000
conductivity = 0.026
initial_temperature = 300
"""

HEAT = """
fix             yo all property/global youngsModulusOriginal peratomtype 70e9
fix             pr all property/global poissonsRatio peratomtype 0.3
fix             tk all property/global thermalConductivity peratomtype 1
fix             tc all property/global thermalCapacity peratomtype 0.5
fix             heat all granflux/heat initial_temperature 400 damping on {words}
"""

DUMP = 'dump t all custom {every} {name} id mass f_Temp f_gasTemperature\ndump_modify t sort id format "%d %.17g %.17g %.17g"\n'
THERMO = (
    "thermo_style custom step atoms f_heat[1] f_heat[2] f_heat[3] f_gas[30] f_gas[31] f_gas[32] f_heat[18] f_heat[22] f_heat f_gas[33] f_gas[14]\n"
    "thermo_modify lost error norm no format float %.17g\nthermo {every}\n"
)


def warm_case(more="", inlet=300):
    text = CASE.replace("velocity = [0, 0, 0.5]", f"velocity = [0, 0, 0.5]\ntemperature = {inlet}")
    return text + ENERGY + f"[coupling]\n{more}\n"


class Gas(HostTest):
    def script(self, words="", every=10, steps=400, name="t", heat_first=True):
        gas, heat = couple(every), HEAT.format(words=words)
        return bed() + (heat + gas if heat_first else gas + heat) + THERMO.format(every=steps) + DUMP.format(every=steps, name=name)

    def run_bed(self, case, words="", steps=400, more="", **run):
        heat_first = run.pop("heat_first", True)
        self.write("case.toml", case)
        output = self.run_script(self.script(words, steps=steps, heat_first=heat_first) + more + f"run {steps}\n", **run)
        return thermo_rows(output), last_snapshot(self.read("t")), output

    def test_hot_bed_cooled_by_gas(self):
        for law in ("gunn", "ranz_marshall", "wakao", "li_mason"):
            with self.subTest(law=law):
                rows, atoms, output = self.run_bed(warm_case(f'nusselt = "{law}"'))
                first, last = rows[0], rows[-1]
                self.assertLess(last[2], first[2] - 1)  # it cools
                self.assertGreaterEqual(last[3], 300)
                # friction and damping warm by less than 1e-3 K here
                self.assertLessEqual(last[4], 400.001)
                self.assertLess(last[5], 0)  # W from the gas
                for residual in last[6:8]:
                    self.assertLess(residual, 1e-10)
                self.assertLess(abs(last[9]), 1e-12 * last[10])
                self.assertIn("residual of heat handed over", output)

    def test_lumped_cooling(self):
        """In gas of so great a capacity that it stays at 300 K: T - 300 falls as exp(-h A t / (m c))."""
        coefficient, density, capacity, steps, dt = 50, 1000, 0.5, 400, 1e-5
        case = warm_case(f"heat_transfer_coefficient = {coefficient}").replace("heat_capacity = 1000", "heat_capacity = 1e12")
        _, atoms, _ = self.run_bed(case, "friction off conduction off damping off", steps=steps)
        for mass, temperature, _ in atoms.values():
            diameter = (6 * mass / (math.pi * density)) ** (1 / 3)
            rate = coefficient * math.pi * diameter**2 / (mass * capacity)
            self.assertAlmostEqual(temperature, 300 + 100 * math.exp(-rate * steps * dt), delta=1e-6)

    def test_heat_that_leaves_the_particles_is_that_of_the_gas(self):
        # Closed box of gas (nothing flows in): what particles lose is what the gas gains.
        case = warm_case().replace("0.5]", "0]")
        rows, atoms, _ = self.run_bed(case, "friction off conduction off")
        lost = rows[0][10] - rows[-1][10]
        self.assertAlmostEqual(lost / -rows[-1][8], 1, delta=2e-3)  # damping makes a little
        self.assertGreater(lost, 0.02 * rows[0][10])

    def test_order_of_the_fixes_is_all_one(self):
        one = self.run_bed(warm_case())[1]
        other = self.run_bed(warm_case(), heat_first=False)[1]
        self.assertEqual(one, other)

    def test_ranks_and_threads(self):
        _, one, _ = self.run_bed(warm_case(), steps=100)
        for ranks, threads in ((1, 2), (2, 1), (2, 2)):
            rows, other, _ = self.run_bed(warm_case(), steps=100, ranks=ranks, options=("-threads", str(threads)))
            self.assertLess(rows[-1][7], 1e-10)
            # Ids depend on the ranks: create_atoms numbers rank by rank.
            for a, b in zip(sorted(row[1] for row in one.values()), sorted(row[1] for row in other.values())):
                self.assertAlmostEqual(a, b, delta=1e-8)

    def test_restart(self):
        self.write("case.toml", warm_case())
        self.run_script(self.script() + "run 150\nrun 250\n")
        whole = last_snapshot(self.read("t"))
        self.run_script(self.script() + "run 150\nwrite_restart half.restart\n")
        text = bed_from("half.restart") + HEAT.format(words="") + couple(10)
        self.run_script(text + DUMP.format(every=400, name="again") + "run 250\n")
        self.assertEqual(whole, last_snapshot(self.read("again")))

    def test_refused(self):
        self.write("case.toml", warm_case())
        code, output = self.start(bed() + couple(10) + "run 1\n")
        self.assertNotEqual(code, 0)
        self.assertIn("define fix granflux/heat", output)
        for more, *texts in (
            ('nusselt = "gun"', "gun", "gunn"),
            ("heat_transfer_coefficient = 0", "heat_transfer_coefficient"),
            ('heat_transfer_coefficient = 1\nnusselt = "gunn"', "nusselt"),
        ):
            with self.subTest(more=more):
                self.write("case.toml", warm_case(more))
                code, output = self.start(self.script() + "run 1\n")
                self.assertNotEqual(code, 0)
                for text in texts:
                    self.assertIn(text, output)
        self.write("case.toml", CASE + '[coupling]\nnusselt = "gunn"\n')
        code, output = self.start(bed() + couple(10) + "run 1\n")
        self.assertNotEqual(code, 0)
        self.assertIn("no [energy] table", output)


if __name__ == "__main__":
    unittest.main()
