# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Steps of temperature that span several time steps (`heat_every N`)."""

import math
import unittest

import test_budget
import test_conduction
import test_energy
import test_friction
import test_gas
from host import HostTest, last_snapshot, thermo_rows
from warm_spheres import data_file, head, mass, thermo, wall

EVERY = 5


class Conduction(test_conduction.TwoSpheres):
    """Two spheres in contact take the Euler steps of EVERY time steps."""

    def test_the_law_to_the_step(self):
        steps, dt = 100, 0.05
        cold, hot = self.run_pair(f"friction off heat_every {EVERY}", steps, dt, sub=EVERY)
        conductance = 2 * test_conduction.CONDUCTIVITY * test_conduction.contact_radius(test_conduction.DIAMETER / 4)
        capacity = mass(test_conduction.DIAMETER, test_conduction.DENSITY) * test_conduction.CAPACITY
        factor = (1 - 2 * conductance * dt / capacity) ** steps
        self.assertAlmostEqual((hot - cold) / (75 * factor), 1, delta=1e-9)
        self.assertAlmostEqual(cold + hot, 2 * 335.5, delta=1e-11)

    test_hertz_and_geometric = test_spheres_of_two_sizes = test_a_fixed_temperature_stays = None


class Ledger(test_budget.Ledger):
    """All effects on: what is booked is what temperatures change by, and a run that is continued
    between two steps of temperature goes on to the last bit."""

    def box_script(self, more="", steps=400, name="temperatures"):
        return super().box_script(more, steps, name=name).replace("damping on", f"damping on heat_every {EVERY}")

    def test_friction_is_the_work_of_every_step(self):
        # Motion does not know of heat: the same work as if temperatures took every step.
        _, _, row = self.run_box()
        text = super().box_script()
        every_step = thermo_rows(self.run_script(text))[-1]
        found, wanted = test_budget.budget_entries(row), test_budget.budget_entries(every_step)
        for name in ("friction", "damping", "to walls"):
            self.assertAlmostEqual(found[name] / wanted[name], 1, delta=1e-11, msg=name)
        for name in ("walls", "radiation"): # taken at fewer moments
            self.assertAlmostEqual(found[name] / wanted[name], 1, delta=0.02, msg=name)

    def test_restart(self):
        text = self.box_script()
        self.run_script(text.replace("run 400\n", "run 203\nrun 197\n"))
        whole = last_snapshot(self.read("temperatures"))
        self.run_script(text.replace("run 400\n", "run 203\nwrite_restart half.restart\n"))
        begin, rest = text.replace("read_data       data.box", "read_restart half.restart").split("run 0\n", 1)
        rest = rest[rest.rindex("dump t") :].replace("run 400", "run 197")
        self.run_script(begin + rest)
        self.assertEqual(last_snapshot(self.read("temperatures")), whole)

    test_steps_with_virial = None


class SlidersWork(test_budget.Ledger):
    """Friction alone: between steps of temperature nothing but the sliders' work is found."""

    def run_box(self, words="", **run):
        text = super().box_script().replace("damping on", f"damping off conduction off wall_share 0.3 {words}")
        output = self.run_script(text.replace("gas_gap 0.03 radiation 450", ""), **run)
        return last_snapshot(self.read("temperatures")), test_budget.budget_entries(thermo_rows(output)[-1])

    def test_each_particle_gets_the_work_of_every_step(self):
        wanted, books = self.run_box()
        warmer = books["friction"] / sum(row[1] * 800 for row in wanted.values())  # K, on the mean
        for run in ({}, {"ranks": 2}, {"options": ["-threads", "2"]}):
            atoms, found = self.run_box(f"heat_every {EVERY}", **run)
            for name in ("friction", "to walls"):
                self.assertAlmostEqual(found[name] / books[name], 1, delta=1e-11, msg=name)
            for particle, row in atoms.items():
                self.assertAlmostEqual(row[2], wanted[particle][2], delta=1e-6 * warmer)

    def test_sampled(self):
        _, books = self.run_box()
        _, found = self.run_box(f"heat_every {EVERY} work sampled")
        for name in ("friction", "to walls"):
            self.assertAlmostEqual(found[name] / books[name], 1, delta=0.03, msg=name)

    test_booked_is_what_temperatures_change_by = test_ranks_and_threads = None
    test_restart = test_steps_with_virial = None


class Sampled(test_friction.SlipToRoll):
    """The power of a sphere that slips until it rolls falls to nothing along a straight line: where each
    step of temperature takes the power at its end, it misses the step's part of the time of slipping."""

    def test_sphere_slipping_until_it_rolls(self):
        for every in (50, 100):
            slipping, dt, rows = self.run_until_rolling(f"wall_share 0.5 heat_every {every} work sampled", mu=0.8)
            made = (rows[-1][4] + rows[-1][5]) / (test_friction.MASS * test_friction.SPEED**2 / 7)
            self.assertAlmostEqual((1 - made) / (every * dt / slipping), 1, delta=0.06)

    test_heat_does_not_depend_on_friction = test_heat_does_not_depend_on_stiffness = None
    test_half_of_it_goes_into_the_wall = test_by_friction_times_speed = test_off = None
    test_a_rolling_sphere_makes_none = None


class Cloud(test_energy.EnergyOfACloud):
    """What dashpots, friction by speed, springs at parting and the half kick make of heat is the work of
    every time step there, too, between particles and at walls."""

    LAWS = (
        dict(gn=5e-3, gt=2e-3),
        dict(gn=5e-3, gt=5e-3, tangential="no_history"),
        dict(gn=5e-3, tangential="history rolling_friction cdt"),
    )

    def run_script(self, *script, **options):
        output = super().run_script(*script, **options)
        self.books = thermo_rows(output)[-1][4:7]
        return output

    def test_books_of_every_step(self):
        for law in self.LAWS:
            books = []
            for every in (1, 7):  # step 1001 is one of temperature
                self.error(4e-6, 1, lambda script: script.replace("conduction off", f"conduction off heat_every {every}"), self.planes(), -100, **law)
                books.append(self.books)
            for name, one, seven in zip(("friction", "damping", "to walls"), *books):
                self.assertGreater(one, 0)
                self.assertAlmostEqual(seven / one, 1, delta=1e-11, msg=f"{law}: {name}")

    test_friction = test_normal_dashpots = test_tangential_dashpots = test_all_dashpots = None
    test_dashpots_as_friction = test_rolling = test_walls = test_triangles = test_hertz = None


class Gas(test_gas.Gas):
    """Lumped cooling in steps of EVERY time steps is as exact; the gas receives what particles lose."""

    def script(self, words="", **more):
        return super().script(f"{words} heat_every {EVERY}", **more)

    test_order_of_the_fixes_is_all_one = test_ranks_and_threads = test_refused = None
    test_hot_bed_cooled_by_gas = test_restart = None


class Collisions(HostTest):
    """Two spheres that collide conduct as much as if temperatures took every step: on the mean over the
    moments at which the collision begins; where it is seen twice it scatters by a tenth."""

    SPEED, RADIUS, DENSITY, STIFFNESS = 0.1, 1e-3, 2000, 1e4

    def heat(self, every, late=0.0):
        m = mass(2 * self.RADIUS, self.DENSITY)
        contact = math.pi * math.sqrt(m / 2 / self.STIFFNESS)
        dt = contact / 40
        gap = self.SPEED * dt * (2 + late)
        self.write(
            "data.spheres",
            data_file(
                [
                    (1, 2 * self.RADIUS, self.DENSITY, (0.0, 0.0, 0.0), (self.SPEED / 2, 0, 0), (0, 0, 0)),
                    (2, 2 * self.RADIUS, self.DENSITY, (2 * self.RADIUS + gap, 0.0, 0.0), (-self.SPEED / 2, 0, 0), (0, 0, 0)),
                ]
            ),
        )
        output = self.run_script(
            head(kn=self.STIFFNESS, dt=dt)
            + "group hot id 2\nfix move all nve/sphere\n"
            + f"fix heat all granflux/heat initial_temperature 300 heat_every {every}\n"
            + "run 0\nset group hot property/atom Temp 400\n"
            + thermo("f_heat[2]", 100)
            + "run 100\n"
        )
        return thermo_rows(output)[-1][2] - 300

    def test_mean_of_collisions(self):
        one = self.heat(1)
        self.assertGreater(one, 0)
        every = 20  # of the 40 steps of a collision: it is seen twice
        heats = [self.heat(every, late) / one for late in range(every)]
        self.assertAlmostEqual(sum(heats) / len(heats), 1, delta=1e-5)
        scatter = math.sqrt(sum((heat - 1) ** 2 for heat in heats) / len(heats))
        self.assertLess(scatter, 0.12)
        self.assertGreater(scatter, 0.05)


if __name__ == "__main__":
    unittest.main()
