# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Heat of friction against closed forms."""

import math
import unittest

from host import HostTest, thermo_rows
from warm_spheres import data_file, head, mass, thermo, wall

DIAMETER, DENSITY, GRAVITY, SPEED = 1e-3, 1e4, 9.80665, 0.1
MASS = mass(DIAMETER, DENSITY)


def resting_height(kn):
    return DIAMETER / 2 - MASS * GRAVITY / kn


def rolling_script(heat, kn=1e4, kt=8e3, mu=0.3, steps=1500, every=1, dt=1e-7, gt=0):
    """A sphere on a plane, thermo: vx, wy, friction [W], friction [J], to the wall [J], temperature."""
    return (
        head(kn=kn, kt=kt, mu=mu, dt=dt, gt=gt)
        + wall("floor", "zplane 0")
        + f"fix gravity all gravity {GRAVITY} vector 0 0 -1\nfix move all nve/sphere\n"
        + f"fix heat all granflux/heat initial_temperature 300 {heat}\n"
        + "variable v equal vcm(all,x)\n"
        + thermo("v_v f_heat[8] f_heat[16] f_heat[20] f_heat[1]", every)
        + f"run {steps}\n"
    )


class SlipToRoll(HostTest):
    """A sphere set down with speed u0 and no spin slides for 2 u0 / (7 mu g), until it rolls with
    5 u0 / 7; friction makes m u0^2 / 7 of heat, whatever the friction and the springs."""

    def run_until_rolling(self, heat, kn=1e4, kt=8e3, mu=0.3, gt=0.0):
        self.write(
            "data.spheres", data_file([(1, DIAMETER, DENSITY, (0.0, 0.0, resting_height(kn)), (SPEED, 0, 0), (0, 0, 0))])
        )
        expected = 2 / 7 * SPEED / (mu * GRAVITY)
        dt = 2e-7
        every = 50
        steps = int(1.2 * expected / dt) // every * every
        return expected, dt, thermo_rows(
            self.run_script(rolling_script(heat, kn, kt, mu, steps, every, dt, gt))
        )

    def check(self, rows, expected, dt, share):
        sliding = [row[0] * dt for row in rows if row[3] > 0]
        self.assertAlmostEqual(max(sliding) / expected, 1, delta=0.005)
        self.assertAlmostEqual(rows[-1][2] / (5 / 7 * SPEED), 1, delta=0.005)
        made = rows[-1][4] + rows[-1][5]
        self.assertAlmostEqual(made / (MASS * SPEED**2 / 7), 1, delta=1e-4)
        self.assertAlmostEqual(rows[-1][5], share * made, delta=1e-12 * made)
        warmer = (1 - share) * SPEED**2 / (7 * 875)
        self.assertAlmostEqual((rows[-1][6] - 300) / warmer, 1, delta=1e-4)

    def test_heat_does_not_depend_on_friction(self):
        for mu in (0.3, 0.8):
            with self.subTest(mu=mu):
                expected, dt, rows = self.run_until_rolling("wall_share 0", mu=mu)
                self.check(rows, expected, dt, 0)

    def test_heat_does_not_depend_on_stiffness(self):
        expected, dt, rows = self.run_until_rolling("wall_share 0", kn=4e4, kt=1e4, mu=0.8)
        self.check(rows, expected, dt, 0)

    def test_half_of_it_goes_into_the_wall(self):
        expected, dt, rows = self.run_until_rolling("", mu=0.8)
        self.check(rows, expected, dt, 0.5)

    def test_by_friction_times_speed(self):
        # Counts what the spring stores while sliding begins too: closer than 0.5 %, not than 1e-4.
        _, _, rows = self.run_until_rolling("wall_share 0 friction speed", mu=0.8)
        self.assertAlmostEqual(rows[-1][4] / (MASS * SPEED**2 / 7), 1, delta=0.005)

    def test_off(self):
        _, _, rows = self.run_until_rolling("friction off", mu=0.8)
        self.assertEqual(rows[-1][3:], [0, 0, 0, 300])

    def test_a_rolling_sphere_makes_none(self):
        spin = SPEED / resting_height(1e4)
        self.write(
            "data.spheres",
            data_file([(1, DIAMETER, DENSITY, (0.0, 0.0, resting_height(1e4)), (SPEED, 0, 0), (0, spin, 0))]),
        )
        for kind in ("slider", "speed"):
            rows = thermo_rows(self.run_script(rolling_script(f"friction {kind}", steps=20000, every=20000)))
            self.assertEqual(rows[-1][3:], [0, 0, 0, 300])


class SpeedAtTheWallAlone(HostTest):
    """Friction goes by speed at the wall, by a slider between particles: heat of half a kick looks at
    forces, which stay until then whether or not there is output to show them."""

    def test_heat_does_not_depend_on_output(self):
        made = []
        for every in (1, 400):
            self.write("data.spheres", data_file([(1, DIAMETER, DENSITY, (0.0, 0.0, resting_height(1e4)), (SPEED, 0, 0), (0, 0, 0))]))
            text = rolling_script("", mu=0.8, gt=0.05, steps=400, every=every)
            by_speed = text.replace(wall("floor", "zplane 0"), wall("floor", "zplane 0", tangential="no_history"))
            self.assertNotEqual(by_speed, text)
            made.append(thermo_rows(self.run_script(by_speed))[-1][4])
        self.assertGreater(made[0], 0)
        self.assertAlmostEqual(made[1] / made[0], 1, delta=1e-12)


class RollingFriction(HostTest):
    """A sphere that rolls against a rolling friction m_r loses 7/10 m (v0^2 - v^2), with v = v0 - 5/7 m_r
    g t: all of it is heat."""

    ROLLING = 0.05

    def run_rolling(self, model, time=0.02, dt=1e-6):
        height, spin = resting_height(1e4), SPEED / resting_height(1e4)
        self.write("data.spheres", data_file([(1, DIAMETER, DENSITY, (0.0, 0.0, height), (SPEED, 0, 0), (0, spin, 0))]))
        steps = round(time / dt)
        text = rolling_script("wall_share 0.25", steps=steps, every=steps, dt=dt, mu=0.5, gt=0.05)
        text = text.replace("tangential history", f"tangential history rolling_friction {model}")
        text = text.replace("fix floor", "fix rf all property/global coefficientRollingFriction peratomtypepair 2" + 4 * f" {self.ROLLING}" + "\nfix floor")
        text = text.replace(f"run {steps}", "compute rot all erotate/sphere\nthermo_style custom step atoms ke c_rot v_v f_heat[16] f_heat[20]\nthermo_modify format float %.17g\n" + f"run {steps}")
        first, last = thermo_rows(self.run_script(text))
        return first[2] + first[3], last[2] + last[3], last[4], last[5], last[6]

    def test_all_that_it_loses_is_heat(self):
        time = 0.02
        speed = SPEED - 5 / 7 * self.ROLLING * GRAVITY * time
        closed = 0.7 * MASS * (SPEED**2 - speed**2)
        for model in ("cdt", "epsd2"):
            with self.subTest(model=model):
                before, after, found, to_particle, to_wall = self.run_rolling(model, time)
                self.assertAlmostEqual(found / speed, 1, delta=2e-3)
                self.assertAlmostEqual((to_particle + to_wall) / closed, 1, delta=2e-3)
                self.assertAlmostEqual((to_particle + to_wall) / (before - after), 1, delta=1e-3)
                self.assertAlmostEqual(to_wall / to_particle, 1 / 3, delta=1e-12)
                print(model, "heat over closed form, over what motion loses:", (to_particle + to_wall) / closed, (to_particle + to_wall) / (before - after))


class SteadyDrag(HostTest):
    """Spheres held in place while a surface slides along: mu N v, at a wall and between spheres."""

    NORMAL_STIFFNESS, OVERLAP, MU, DRAG_SPEED = 1e4, 1e-6, 0.4, 0.2
    POWER = MU * NORMAL_STIFFNESS * OVERLAP * DRAG_SPEED

    def test_at_a_wall(self):
        self.write("data.spheres", data_file([(1, DIAMETER, DENSITY, (0.0, 0.0, DIAMETER / 2 - self.OVERLAP))]))
        for kind in ("slider", "speed"):
            rows = thermo_rows(
                self.run_script(
                    head(kn=self.NORMAL_STIFFNESS, mu=self.MU, dt=1e-6)
                    + wall("floor", "zplane 0", more=f"shear x {self.DRAG_SPEED}")
                    + "fix hold all freeze\n"
                    + f"fix heat all granflux/heat initial_temperature 300 wall_share 0.25 friction {kind}\n"
                    + thermo("f_heat[8] f_heat[12]", 100)
                    + "run 1000\n"
                )
            )
            self.assertAlmostEqual(rows[-1][2] / (0.75 * self.POWER), 1, delta=1e-9)
            self.assertAlmostEqual(rows[-1][3] / (0.25 * self.POWER), 1, delta=1e-9)

    def test_between_spheres_by_conductivity(self):
        # Two frozen spheres: the surface of one turns past the other's.
        spin = self.DRAG_SPEED / (DIAMETER / 2 - self.OVERLAP / 2)
        self.write(
            "data.spheres",
            data_file(
                [
                    (1, DIAMETER, DENSITY, (0.0, 0.0, 0.0), (0, 0, 0), (0, 0, spin)),
                    (2, DIAMETER, DENSITY, (DIAMETER - self.OVERLAP, 0.0, 0.0)),
                ]
            ),
        )
        output = self.run_script(
            head(kn=self.NORMAL_STIFFNESS, mu=self.MU, dt=1e-6, k1=10, k2=30)
            + "group first id 1\ngroup second id 2\nfix hold second freeze\nfix turn first move linear 0 0 0\n"
            + "fix heat all granflux/heat initial_temperature 300 conduction off\n"
            + "compute one first reduce sum f_heatContact[2]\ncompute two second reduce sum f_heatContact[2]\n"
            + thermo("c_one c_two f_heat[8]", 200)
            + "run 400\n"
        )
        rows = thermo_rows(output)
        self.assertAlmostEqual(rows[-1][2] / (0.25 * self.POWER), 1, delta=1e-6)
        self.assertAlmostEqual(rows[-1][3] / (0.75 * self.POWER), 1, delta=1e-6)


if __name__ == "__main__":
    unittest.main()
