# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What is booked is what temperatures change by, and what the sources come to."""

import math
import unittest

from host import CASE, HostTest, bed, couple, last_snapshot, thermo_rows
from packed_box import data_file as box_file
from packed_box import script
from warm_spheres import data_file, head, mass, thermo

CAPACITIES = (700, 900)
TEMPERATURES = 'dump t all custom {every} {name} id type mass f_Temp f_heatFlux\ndump_modify t sort id format "%d %d %.17g %.17g %.17g"\n'

# The entries of the fix vector, by their numbers.
CARRIED = 22
ENERGIES = {"conduction": 14, "walls": 15, "friction": 16, "damping": 17, "convection": 18, "source": 19, "to walls": 20, "held": 21, "radiation": 24}
GAINS = ("conduction", "walls", "friction", "damping", "convection", "source", "radiation")

HEAT = """
fix             yo all property/global youngsModulusOriginal peratomtype 70e9 190e9
fix             tk all property/global thermalConductivity peratomtype 36 12
fix             tc all property/global thermalCapacity peratomtype 700 900
fix             low all wall/gran {model} primitive type 1 zplane 0 temperature 500
fix             high all wall/gran {model} primitive type 2 zplane {top} temperature 350
group           held id 5 6 7
fix             em all property/global emissivity peratomtype 0.9 0.6
fix             heat all granflux/heat initial_temperature 300 damping on fixed_temperature held &
                gas_gap 0.03 radiation 450
{more}
"""


def thermal_energy(atoms):
    return math.fsum(row[1] * CAPACITIES[int(row[0]) - 1] * row[2] for row in atoms.values())


def budget_entries(row, first=2):
    return dict(zip(ENERGIES, row[first:]))


def received(energy):
    return math.fsum(energy[name] for name in GAINS) - energy["held"]


class Ledger(HostTest):
    """Spheres of two types that collide between a hot and a cold wall, all effects on."""

    MADE = ("walls", "friction", "damping", "source", "to walls", "held", "radiation")

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
        for name in self.MADE:
            self.assertNotEqual(energy[name], 0, name)
        exchanged = sum(abs(e) for e in energy.values())
        self.assertLess(abs(energy["conduction"]), 1e-12 * exchanged)
        change = thermal_energy(atoms) - begin
        self.assertLess(abs(change - received(energy)), 1e-10 * exchanged)
        # A slip of 5 % in any of them would show.
        for name in self.MADE:
            if name != "to walls":
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
        """Temperatures and books go on to the last bit on as many ranks."""
        text = self.box_script()
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                output = self.run_script(text.replace("run 400\n", "run 200\nrun 200\n"), ranks=ranks)
                whole, books = last_snapshot(self.read("temperatures")), thermo_rows(output)[-1]
                self.run_script(text.replace("run 400\n", "run 200\nwrite_restart half.restart\n"), ranks=ranks)
                begin, rest = text.replace("read_data       data.box", "read_restart half.restart").split("run 0\n", 1)
                rest = rest[rest.rindex("dump t") :].replace("run 400", "run 200")
                for other_ranks in (ranks, 3 - ranks):
                    output = self.run_script(begin + rest, ranks=other_ranks)
                    again, again_books = last_snapshot(self.read("temperatures")), thermo_rows(output)[-1]
                    if other_ranks == ranks:
                        self.assertEqual(again, whole)
                        self.assertEqual(again_books, books)
                    exchanged = sum(abs(e) for e in books[2:])
                    for name, a, b in zip([*ENERGIES, "carried"], again_books[2:], books[2:]):
                        self.assertAlmostEqual(a, b, delta=1e-10 * exchanged, msg=name)
                    self.assertNotEqual(books[4], 0)


class LedgerOfContactsAlone(Ledger):
    """Conduction and friction: temperatures take their step with the forces, block by block."""

    MADE = ("walls", "friction", "source", "to walls", "held")

    def box_script(self, more="", **other):
        text = super().box_script(more, **other).replace("damping on", "")
        return text.replace("gas_gap 0.03 radiation 450", "")

    test_steps_with_virial = None


ROLLING = "fix rf all property/global coefficientRollingFriction peratomtypepair 1 0.05\n"
EVERY = """
fix             yo all property/global youngsModulusOriginal peratomtype 70e9
fix             pr all property/global poissonsRatio peratomtype 0.3
fix             tk all property/global thermalConductivity peratomtype 1
fix             tc all property/global thermalCapacity peratomtype 5
fix             em all property/global emissivity peratomtype 0.8
group           held id 5 6 7
fix             heat all granflux/heat initial_temperature 400 damping on gas_gap 0.026 radiation 600 &
                wall_share 0.3 fixed_temperature held
"""
ENERGY = "[energy]\nheat_capacity = 1000\nconductivity = 0.026\ninitial_temperature = 300\n"


class EveryEffect(HostTest):
    """Spheres that collide in gas between walls, with every effect on: the books are the sums of the
    sources as they are dumped in every step, and what temperatures change by."""

    PARTS = "f_heatContact[1] f_heatContact[2] f_heatDetail[1] f_heatDetail[2] f_heatWall[1] f_heatWall[2] f_heatNear[1] f_heatNear[2]"

    def script(self, steps):
        text = bed().replace("tangential history", "tangential history rolling_friction cdt")
        for place, temperature in (("zplane 0", 500), ("xplane 0", 350)):
            text = text.replace(f"type 1 {place} ", f"type 1 {place} temperature {temperature} ")
        first_wall = text.index("fix             zlow")
        return (
            text[:first_wall]
            + ROLLING
            + text[first_wall:]
            + EVERY
            + couple(10)
            + "run 0\ngroup hot id <= 60\nset group hot property/atom Temp 450\n"
            + "set group hot property/atom heatSource 1e-4\nrun 200\n"
            + f"dump t all custom 1 steps id mass f_Temp f_heatFlux f_heatSource {self.PARTS}\n"
            + 'dump_modify t sort id format "%d' + 12 * " %.17g" + '"\n'
            + thermo(" ".join(f"f_heat[{n}]" for n in [*ENERGIES.values(), CARRIED]) + " f_gas[31] f_gas[32]", steps)
            + f"run {steps}\n"
        )

    def test_books_are_the_sum_of_the_sources(self):
        steps, dt = 200, 1e-5
        case = CASE.replace("velocity = [0, 0, 0.5]", "velocity = [0, 0, 0.5]\ntemperature = 300")
        self.write("case.toml", case + ENERGY)
        for ranks, threads in ((1, 1), (2, 2)):
            with self.subTest(ranks=ranks, threads=threads):
                output = self.run_script(self.script(steps), ranks=ranks, options=("-threads", str(threads)))
                first, last = thermo_rows(output)[-2:]
                booked = budget_entries([b - a for a, b in zip(first, last)])
                self.check(booked, dt)
                self.assertLess(last[-2], 1e-10)  # of the gas's heat
                self.assertLess(last[-1], 1e-10)  # handed over between particles and gas

    def check(self, booked, dt):
        parts = self.read("steps").split("ITEM: ATOMS")
        frames = [last_snapshot("ITEM: ATOMS" + part.partition("ITEM: TIMESTEP")[0]) for part in parts[1:]]
        found = {name: [] for name in ("conduction", "walls", "friction", "damping", "convection", "source", "to walls", "held", "radiation")}
        for frame in frames[1:]:
            for number, (_, _, flux, source, pp, made, rubbed, damped, wall, to_wall, gap, radiated) in frame.items():
                self.assertAlmostEqual(made, rubbed + damped, delta=1e-14 * abs(made) + 1e-25)
                convection = flux - pp - made - wall - gap - radiated
                found["conduction"] += [dt * pp, dt * gap]
                found["walls"].append(dt * wall)
                found["friction"].append(dt * rubbed)
                found["damping"].append(dt * damped)
                found["convection"].append(dt * convection)
                found["source"].append(dt * source)
                found["to walls"].append(dt * to_wall)
                found["radiation"].append(dt * radiated)
                if number in (5, 6, 7):
                    found["held"].append(dt * (flux + source))
        exchanged = sum(abs(e) for e in booked.values())
        for name, values in found.items():
            self.assertAlmostEqual(booked[name], math.fsum(values), delta=1e-10 * exchanged, msg=name)
            if name != "conduction":
                self.assertGreater(0.05 * abs(booked[name]), 1e-8 * exchanged, name)
            else:  # between particles: nothing in all, but something each
                self.assertGreater(math.fsum(map(abs, values)), 1e-3 * exchanged)
        heat = [math.fsum(row[0] * 5 * row[1] for row in frame.values()) for frame in (frames[0], frames[-1])]
        self.assertAlmostEqual(heat[1] - heat[0], received(booked), delta=1e-10 * exchanged)


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


if __name__ == "__main__":
    unittest.main()
