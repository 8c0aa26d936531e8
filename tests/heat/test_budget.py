# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What is booked is what temperatures change by, and what motion loses."""

import math
import unittest

from host import HostTest, last_snapshot, thermo_rows
from packed_box import data_file as box_file
from packed_box import script
from warm_spheres import data_file, head, mass, thermo, wall

CAPACITIES = (700, 900)
TEMPERATURES = 'dump t all custom {every} {name} id type mass f_Temp f_heatFlux\ndump_modify t sort id format "%d %d %.17g %.17g %.17g"\n'

# The entries of the fix vector, by their numbers.
CARRIED = 22
ENERGIES = {"conduction": 14, "walls": 15, "friction": 16, "damping": 17, "convection": 18, "source": 19, "to walls": 20, "held": 21}

HEAT = """
fix             yo all property/global youngsModulusOriginal peratomtype 70e9 190e9
fix             tk all property/global thermalConductivity peratomtype 36 12
fix             tc all property/global thermalCapacity peratomtype 700 900
fix             low all wall/gran {model} primitive type 1 zplane 0 temperature 500
fix             high all wall/gran {model} primitive type 2 zplane {top} temperature 350
group           held id 5 6 7
fix             heat all granflux/heat initial_temperature 300 damping on fixed_temperature held
{more}
"""


def thermal_energy(atoms):
    return math.fsum(row[1] * CAPACITIES[int(row[0]) - 1] * row[2] for row in atoms.values())


def budget_entries(row, first=2):
    return dict(zip(ENERGIES, row[first:]))


class Ledger(HostTest):
    """Spheres of two types that collide between a hot and a cold wall, all effects on."""

    def box_script(self, more="", steps=400, model="model hertz tangential history", name="temperatures"):
        cells, spacing = (5, 5, 5), 0.93
        self.write("data.box", box_file(cells, spacing, 0.5, 100, 0))
        text = script(
            "forces",
            model,
            boundary="p p f",
            more=HEAT.format(model=model, top=cells[2] * spacing * 2e-3, more=more),
            runs=(),
            step=1e-6,
        )
        text = text.replace("dump            d all custom 1", "dump d all custom 100000")
        return (
            text
            + "run 0\ngroup hot id <= 60\nset group hot property/atom Temp 800\n"
            + "set group hot property/atom heatSource 1e-2\nrun 0\n"
            + TEMPERATURES.format(every=steps, name=name)
            + thermo(" ".join(f"f_heat[{n}]" for n in [*ENERGIES.values(), CARRIED]), steps)
            + f"run {steps}\n"
        )

    def run_box(self, more="", **run):
        output = self.run_script(self.box_script(more), **run)
        text = self.read("temperatures")
        begin = thermal_energy(last_snapshot(text[: text.index("ITEM: TIMESTEP", 5)]))
        return begin, last_snapshot(text), thermo_rows(output)[-1]

    def check(self, begin, atoms, row):
        energy = budget_entries(row)
        for name in ("walls", "friction", "damping", "source", "to walls", "held"):
            self.assertNotEqual(energy[name], 0, name)
        exchanged = sum(abs(e) for e in energy.values())
        self.assertLess(abs(energy["conduction"]), 1e-12 * exchanged)
        received = sum(energy[n] for n in ("conduction", "walls", "friction", "damping", "source")) - energy["held"]
        change = thermal_energy(atoms) - begin
        self.assertLess(abs(change - received), 1e-10 * exchanged)
        # A slip of 5 % in any of them would show.
        for name in ("walls", "friction", "damping", "source", "held"):
            self.assertGreater(0.05 * abs(energy[name]), 1e-8 * exchanged, name)

    def test_booked_is_what_temperatures_change_by(self):
        self.check(*self.run_box())

    def test_ranks_and_threads(self):
        _, one, row = self.run_box()
        for ranks, threads in ((1, 2), (2, 1), (2, 2)):
            with self.subTest(ranks=ranks, threads=threads):
                begin, other, found = self.run_box(ranks=ranks, options=("-threads", str(threads)))
                self.check(begin, other, found)
                for i, line in one.items():
                    self.assertAlmostEqual(other[i][2], line[2], delta=1e-9)
                if ranks == 1:  # the same bits
                    self.assertEqual([r[2] for r in one.values()], [r[2] for r in other.values()])

    def test_steps_with_virial(self):
        # Forces are LIGGGHTS' own where the virial is asked for: heat must not be left out there.
        _, one, row = self.run_box()
        begin, other, found = self.run_box("compute s all stress/atom\nfix s all ave/atom 1 1 1 c_s[1]")
        self.check(begin, other, found)
        for i, line in one.items():
            self.assertAlmostEqual(other[i][2], line[2], delta=1e-9)

    def test_restart(self):
        script_ = self.box_script()
        self.run_script(script_.replace("run 400\n", "run 200\nrun 200\n"))
        whole = last_snapshot(self.read("temperatures"))
        half = script_.replace("run 400\n", "run 200\nwrite_restart half.restart\n")
        self.run_script(half)
        again = script_.replace("read_data       data.box", "read_restart half.restart")
        again = again[: again.index("run 0\n")]
        self.run_script(again + TEMPERATURES.format(every=400, name="again") + "run 200\n")
        other = last_snapshot(self.read("again"))
        self.assertEqual([r[2] for r in whole.values()], [r[2] for r in other.values()])


class Insertion(HostTest):
    def test_heat_comes_with_particles(self):
        self.write("data.spheres", data_file([(1, 1e-3, 2000, (0.0, 0.0, 0.0))], (-5e-3,) * 3, (5e-3,) * 3))
        output = self.run_script(
            head(dt=1e-6)
            + "fix ts all particletemplate/sphere 10487 atom_type 1 density constant 2000 radius constant 0.5e-3\n"
            + "fix pd all particledistribution/discrete 32452867 1 ts 1.0\n"
            + "region filled block -4e-3 4e-3 -4e-3 4e-3 1e-3 4e-3 units box\n"
            + "fix move all nve/sphere\nfix heat all granflux/heat initial_temperature 320\n"
            + "fix ins all insert/pack seed 123457 distributiontemplate pd insert_every once overlapcheck yes "
            + "all_in yes particles_in_region 10 region filled\n"
            + thermo(f"f_heat[1] f_heat[{CARRIED}] f_heat", 10)
            + "run 20\n"
        )
        row = thermo_rows(output)[-1]
        self.assertEqual(row[1], 11)
        self.assertAlmostEqual(row[2], 320, delta=1e-12)
        one = mass(1e-3, 2000) * 875 * 320
        self.assertAlmostEqual(row[3] / (10 * one), 1, delta=1e-12)
        self.assertAlmostEqual(row[4] / (11 * one), 1, delta=1e-12)


class EnergyOfMotion(HostTest):
    """With all that is dissipated turned into heat, the energy of motion and heat together is kept,
    to the second order of the time step."""

    PAIRS = 25  # which meet at other parts of a time step each

    def pairs(self, gap, one, other):
        spheres = []
        for n in range(self.PAIRS):
            y, z = 5e-3 * (n // 5) - 1e-2, 5e-3 * (n % 5) - 1e-2
            for (kind, diameter, density, (px, py), *motion), side in ((one, -1), (other, 1)):
                x = px + side * gap * n / self.PAIRS / 2
                spheres.append((kind, diameter, density, (x, y + py, z), *motion))
        return spheres

    def error(self, dt, time, spheres, stiffness, measure):
        self.write("data.spheres", data_file(spheres, (-2e-2,) * 3, (2e-2,) * 3))
        steps = round(time / dt)
        output = self.run_script(
            head(dt=dt, **stiffness)
            + "fix move all nve/sphere\nfix heat all granflux/heat initial_temperature 300 damping on conduction off\n"
            + "compute rot all erotate/sphere\n"
            + thermo("ke c_rot f_heat[16] f_heat[17]", steps)
            + f"run {steps}\n"
        )
        first, last = thermo_rows(output)[0], thermo_rows(output)[-1]
        lost = first[2] + first[3] - last[2] - last[3]
        made = last[4] + last[5]
        self.assertGreater(last[4] if measure == "friction" else last[5], 0.2 * made)
        return (lost - made) / lost

    def check(self, name, spheres, stiffness, measure):
        # Apart before and after: no energy is left in springs.
        errors = [self.error(dt, 1.2e-3, spheres, stiffness, measure) for dt in (4e-6, 2e-6, 1e-6, 5e-7)]
        print(f"{name}: energy not accounted for, of what is lost:", *(f"{e:.2e}" for e in errors))
        self.assertLess(abs(errors[-1]), 2e-4)
        self.assertGreater(math.log2(abs(errors[0] / errors[-1])) / 3, 1.8)

    def test_damped_impact(self):
        still = ((0, 0, 0),)
        spheres = self.pairs(
            0.2 * 4e-6,
            (1, 1e-3, 2000, (-0.51e-3, 0.0), (0.1, 0, 0), *still),
            (1, 1e-3, 2000, (0.51e-3, 0.0), (-0.1, 0, 0), *still),
        )
        self.check("damped", spheres, dict(kn=1000, kt=300, gn=5e-3, gt=2e-3, mu=0.2), "damping")

    def test_sliding_impact(self):
        # Without normal damping: it would end contacts with a tangential spring still strained.
        spheres = self.pairs(
            0.2 * 4e-6,
            (1, 1e-3, 2000, (-0.51e-3, 0.0), (0.1, 0.2, 0), (0, 0, 0)),
            (2, 1.3e-3, 2000, (0.66e-3, 0.1e-3), (-0.1, -0.1, 0), (0, 0, 50)),
        )
        self.check("sliding", spheres, dict(kn=1000, kt=300, gn=0, gt=2e-3, mu=0.2), "friction")


if __name__ == "__main__":
    unittest.main()
