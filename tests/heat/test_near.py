# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Conduction through the gas in gaps and radiation, of spheres that are held in place."""

import math
import unittest

from host import HostTest, last_snapshot, thermo_rows
from warm_spheres import data_file, head, mass, thermo

DIAMETER, DENSITY, CAPACITY = 1e-3, 2000, 875
RADIUS = DIAMETER / 2
HEAT_CAPACITY = mass(DIAMETER, DENSITY) * CAPACITY
STEFAN_BOLTZMANN = 5.670374419e-8
EMISSIVITY = "fix em all property/global emissivity peratomtype {} {}\n"
TEMPERATURES = 'dump d all custom {every} temperatures id f_Temp f_heatNear[1] f_heatNear[2] f_heatFlux\ndump_modify d sort id format "%d %.17g %.17g %.17g %.17g"\n'


def simpson(f, low, high, pieces=20000):
    h = (high - low) / pieces
    inner = math.fsum((4 if n % 2 else 2) * f(low + n * h) for n in range(1, pieces))
    return h / 3 * (f(low) + f(high) + inner)


def gap_conductance(k, one, other, distance, layer=0.2, least=2.75e-8):
    """Of two spheres that do not touch, by quadrature of 2 pi r k / gap, r = small sin(angle)."""
    large, small = max(one, other), min(one, other)
    edge = (1 + layer) * large
    height = (distance**2 + small**2 - edge**2) / (2 * distance)
    assert height > 0 and distance - one - other > least

    def along(angle):
        r, up = small * math.sin(angle), small * math.cos(angle)
        return 2 * math.pi * k * r * up / (distance - up - math.sqrt(large**2 - r**2))

    return simpson(along, 0, math.acos(height / small))


class Near(HostTest):
    def run_spheres(self, words, spheres, temperatures, steps, dt, emissivity=(1, 1), more="", **run):
        """[(T, heat through gas, by radiation, in all)] of each sphere, rows of thermo."""
        self.write("data.spheres", data_file(spheres))
        script = head(dt=dt) + EMISSIVITY.format(*emissivity)
        script += "fix hold all move linear 0 0 0\n"
        script += f"fix heat all granflux/heat initial_temperature 300 {words}\n{more}run 0\n"
        for number, temperature in enumerate(temperatures, 1):
            script += f"group one id {number}\nset group one property/atom Temp {temperature!r}\ngroup one delete\n"
        script += TEMPERATURES.format(every=steps)
        script += thermo("f_heat[23] f_heat[24] f_heat[6] f_heat[14]", steps) + f"run {steps}\n"
        output = self.run_script(script, **run)
        return list(last_snapshot(self.read("temperatures")).values()), thermo_rows(output)


class GasGap(Near):
    K = 0.026

    def check(self, second, gap, layer=0.2):
        distance = RADIUS + second / 2 + gap
        spheres = [(1, DIAMETER, DENSITY, (0.0, 0.0, 0.0)), (2, second, DENSITY, (distance, 0.0, 0.0))]
        steps, dt = 2000, 1e-3
        words = f"gas_gap {self.K} gas_layer {layer}"
        (cold, hot), rows = self.run_spheres(words, spheres, (298, 373), steps, dt)
        conductance = gap_conductance(self.K, RADIUS, second / 2, distance, layer)
        a, b = conductance / HEAT_CAPACITY, conductance / (mass(second, DENSITY) * CAPACITY)
        # Euler's steps to rounding; 1e-8 is that of the quadrature and of places.
        factor = (1 - (a + b) * dt) ** steps
        self.assertAlmostEqual((hot[0] - cold[0]) / (75 * factor), 1, delta=1e-8)
        self.assertLess(factor, 0.99)
        self.assertAlmostEqual(cold[1] / (conductance * 75 * (1 - (a + b) * dt) ** (steps - 1)), 1, delta=1e-8)
        self.assertEqual(cold[1], -hot[1])
        self.assertEqual((cold[2], hot[2]), (0, 0))
        self.assertEqual(rows[-1][5], 0)  # J between particles, in all

    def test_equal_spheres(self):
        self.check(DIAMETER, 1e-6)
        self.check(DIAMETER, 5e-5)

    def test_unequal_spheres(self):
        self.check(0.6 * DIAMETER, 1e-5)

    def test_layer(self):
        self.check(DIAMETER, 2e-5, layer=0.5)

    def test_beyond_the_reach_of_the_skin(self):
        # The lists reach 3e-4 m beyond contact without it; a layer of 1 radius is 5e-4.
        self.check(DIAMETER, 4.5e-4, layer=1)

    def test_touching_spheres_conduct_both_ways(self):
        distance = DIAMETER - 1e-7
        spheres = [(1, DIAMETER, DENSITY, (0.0, 0.0, 0.0)), (1, DIAMETER, DENSITY, (distance, 0.0, 0.0))]
        flux = {}
        for words in ("", f"gas_gap {self.K} least_gap 1e-7", f"gas_gap {self.K} least_gap 1e-7 conduction off"):
            (cold, hot), _ = self.run_spheres(words, spheres, (298, 373), 1, 1e-6)
            flux[words] = cold[3]
        both = flux[f"gas_gap {self.K} least_gap 1e-7"]
        self.assertAlmostEqual(sum(flux.values()) / both, 2, delta=1e-12)
        # Between circle of overlap and where the gap is the least one, then out to the layer's edge.
        u = [(d + (RADIUS**2 - e**2) / d) / 2 for d, e in ((distance, RADIUS), (distance, 1.2 * RADIUS))]
        u.insert(1, (distance - 1e-7) / 2)
        expected = math.pi * self.K * ((u[0] ** 2 - u[1] ** 2) / 1e-7 + u[2] - u[1] + distance / 2 * math.log((distance - 2 * u[2]) / (distance - 2 * u[1])))
        self.assertAlmostEqual(flux[f"gas_gap {self.K} least_gap 1e-7 conduction off"] / (75 * expected), 1, delta=1e-8)


class Radiation(Near):
    def time_to(self, end, start, around, emissivity, diameter=DIAMETER):
        """Of a sphere alone, m c dT/dt = sigma e A (T_s^4 - T^4) by separation of variables."""
        rate = STEFAN_BOLTZMANN * emissivity * math.pi * diameter**2 / (mass(diameter, DENSITY) * CAPACITY)

        def primitive(t):
            return (math.log((around + t) / abs(around - t)) + 2 * math.atan(t / around)) / (4 * around**3)

        return (primitive(end) - primitive(start)) / rate

    def test_a_sphere_in_uniform_surroundings(self):
        alone = [(1, DIAMETER, DENSITY, (0.0, 0.0, 0.0))]
        for start, around, e in ((1200.0, 300, 0.8), (300.0, 1100, 0.5)):
            found = []
            for dt in (4e-3, 2e-3):
                (one,), rows = self.run_spheres(f"radiation {around}", alone, (start,), round(2 / dt), dt, (e, e))
                found.append(one[0])
                booked = rows[-1][3]
                self.assertAlmostEqual(booked / (HEAT_CAPACITY * (one[0] - start)), 1, delta=1e-11)
            # Euler's error goes with the step: the two together have none to the first order.
            exact = 2 * found[1] - found[0]
            self.assertAlmostEqual(self.time_to(exact, start, around, e) / 2, 1, delta=1e-5)
            self.assertGreater(abs(exact - start), 250)
            for dt, t in zip((4e-3, 2e-3), found):
                self.assertLess(abs(t - exact), 300 * dt)
            self.assertNotAlmostEqual(self.time_to(exact, start, around, 1.05 * e) / 2, 1, delta=1e-2)

    def test_equilibrium_at_the_temperature_of_the_surroundings(self):
        (one,), _ = self.run_spheres("radiation 1000", [(1, DIAMETER, DENSITY, (0.0, 0.0, 0.0))], (400.0,), 4000, 0.02)
        self.assertAlmostEqual(one[0], 1000, delta=1e-9)

    def facing(self, one, other, distance):
        """4 pi R^2 times what the other has of the space around, the lesser of both ways."""

        def share(own, that):
            def disc(x):  # of both balls, across the line of the centres
                return math.pi * max(0, min((2 * own) ** 2 - x * x, that**2 - (x - distance) ** 2))

            kink = (distance**2 + (2 * own) ** 2 - that**2) / (2 * distance)
            volume = simpson(disc, distance - that, kink) + simpson(disc, kink, min(2 * own, distance + that))
            return volume / (4 / 3 * math.pi * ((2 * own) ** 3 - own**3))

        return min(4 * math.pi * one**2 * share(one, other), 4 * math.pi * other**2 * share(other, one))

    def test_two_spheres_and_their_surroundings(self):
        second, distance = 0.8 * DIAMETER, 1.1 * DIAMETER
        spheres = [(1, DIAMETER, DENSITY, (0.0, 0.0, 0.0)), (2, second, DENSITY, (distance, 0.0, 0.0))]
        t1, t2, around, e1, e2 = 800.0, 1200.0, 500, 0.9, 0.4
        (one, other), rows = self.run_spheres(f"radiation {around}", spheres, (t1, t2), 1, 1e-6, (e1, e2))
        area = self.facing(RADIUS, second / 2, distance)
        self.assertGreater(area, 0.01 * math.pi * DIAMETER**2)
        between = STEFAN_BOLTZMANN * area / (1 / e1 + 1 / e2 - 1) * (t2**4 - t1**4)
        first = STEFAN_BOLTZMANN * e1 * (math.pi * DIAMETER**2 - area) * (around**4 - t1**4)
        last = STEFAN_BOLTZMANN * e2 * (math.pi * second**2 - area) * (around**4 - t2**4)
        self.assertAlmostEqual(one[2] / (first + between), 1, delta=1e-9)
        self.assertAlmostEqual(other[2] / (last - between), 1, delta=1e-9)
        self.assertAlmostEqual(rows[-1][2] / (first + last), 1, delta=1e-9)  # W booked
        self.assertAlmostEqual(rows[-1][3] / (1e-6 * (first + last)), 1, delta=1e-9)  # J

    def test_what_spheres_give_each_other_cancels(self):
        spheres = [(1, DIAMETER, DENSITY, (1.02e-3 * i, 1.02e-3 * j, 1.02e-3 * k)) for i in range(3) for j in range(3) for k in range(3)]
        hot = [1000 + 30.0 * n for n in range(27)]
        rows = []
        for around in (0, 1500):
            atoms, thermo_ = self.run_spheres(f"radiation {around}", spheres, hot, 1, 1e-6, (0.7, 0.7))
            rows.append(thermo_[-1][2])
            self.assertAlmostEqual(math.fsum(a[2] for a in atoms) / thermo_[-1][2], 1, delta=1e-12)
        # The difference is that of the surroundings alone: what faces nobody times their 1500 K to the fourth.
        area = (rows[1] - rows[0]) / (0.7 * STEFAN_BOLTZMANN * 1500**4)
        facing = 0
        for n, a in enumerate(spheres):
            for b in spheres[:n]:
                distance = math.dist(a[3], b[3])
                if distance < 1.5 * DIAMETER:
                    facing += 2 * self.facing(RADIUS, RADIUS, distance)
        self.assertAlmostEqual(area / (27 * math.pi * DIAMETER**2 - facing), 1, delta=1e-6)


class RanksAndThreads(Near):
    def test_same_heat(self):
        spheres = [(1 + n % 2, DIAMETER * (1 - 0.1 * (n % 3)), DENSITY, (1.05e-3 * (n % 10) - 5e-3, 1.03e-3 * (n // 10 % 5), 1.01e-3 * (n // 50))) for n in range(150)]
        hot = [600 + 7.0 * (n * 37 % 101) for n in range(150)]
        words = "gas_gap 0.03 gas_layer 0.4 radiation 400"
        found = {}
        for ranks, threads in ((1, 1), (1, 2), (2, 1), (4, 1), (2, 2)):
            found[ranks, threads], rows = self.run_spheres(
                words, spheres, hot, 20, 1e-3, (0.9, 0.5), ranks=ranks, options=("-threads", str(threads))
            )
            self.assertLess(abs(rows[-1][5]), 1e-13 * abs(rows[-1][3]))  # between particles: nothing
        one = found[1, 1]
        self.assertEqual(found[1, 2], one)  # the same bits
        for other in found.values():
            for a, b in zip(one, other):
                self.assertAlmostEqual(a[0], b[0], delta=1e-10)
                self.assertAlmostEqual(a[3], b[3], delta=1e-10 * abs(a[3]) + 1e-15)


if __name__ == "__main__":
    unittest.main()
