# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""With all that is dissipated turned into heat, the energy of motion, of springs and heat together is kept."""

import itertools
import math
import random
import unittest

from host import HostTest, last_snapshot, thermo_rows
from warm_spheres import data_file, head, thermo, wall


# Of a box whose corner 4 a + 2 b + c has the coordinates a, b, c of 0 and 1.
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def stl(triangles):
    lines = ["solid box"]
    for corners in triangles:
        lines += ["facet normal 0 0 0", "outer loop", *("vertex %r %r %r" % corner for corner in corners), "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid box", ""])


class EnergyOfMotion(HostTest):
    """Impacts of pairs and at a wall: to the second order of the time step."""

    PAIRS = 25  # which meet at other parts of a time step each

    def pairs(self, gap, one, other):
        spheres = []
        for n in range(self.PAIRS):
            y, z = 5e-3 * (n // 5) - 1e-2, 5e-3 * (n % 5) - 1e-2
            for (kind, diameter, density, (px, py), *motion), side in ((one, -1), (other, 1)):
                x = px + side * gap * n / self.PAIRS / 2
                spheres.append((kind, diameter, density, (x, y + py, z), *motion))
        return spheres

    def error(self, dt, time, spheres, stiffness, measure, walls):
        self.write("data.spheres", data_file(spheres, (-2e-2,) * 3, (2e-2,) * 3))
        steps = round(time / dt)
        output = self.run_script(
            head(dt=dt, **stiffness)
            + "fix rf all property/global coefficientRollingFriction peratomtypepair 2 0.3 0.3 0.3 0.3\n"
            + "fix move all nve/sphere\nfix heat all granflux/heat initial_temperature 300 damping on conduction off\n"
            + "compute rot all erotate/sphere\n"
            + walls
            + thermo("ke c_rot f_heat[16] f_heat[17] f_heat[20]", steps)
            + f"run {steps}\nrun 1\n"  # which receives what springs held when contacts ended
        )
        first, last = thermo_rows(output)[0], thermo_rows(output)[-1]
        lost = first[2] + first[3] - last[2] - last[3]
        made = last[4] + last[5] + last[6]
        self.assertGreater(last[4] if measure == "friction" else last[5], 0.2 * made)
        return (lost - made) / lost

    def errors(self, name, spheres, stiffness, measure, walls=""):
        # Apart before and after: no energy is left in springs.
        errors = [self.error(dt, 1.2e-3, spheres, stiffness, measure, walls) for dt in (4e-6, 2e-6, 1e-6, 5e-7)]
        print(f"{name}: energy not accounted for, of what is lost:", *(f"{e:.2e}" for e in errors))
        return errors

    def check(self, *case, least=2e-4, order=1.8):
        errors = self.errors(*case)
        self.assertLess(abs(errors[-1]), least)
        self.assertGreater(math.log2(abs(errors[0] / errors[-1])) / 3, order)

    def test_damped_impact(self):
        still = ((0, 0, 0),)
        spheres = self.pairs(
            0.2 * 4e-6,
            (1, 1e-3, 2000, (-0.51e-3, 0.0), (0.1, 0, 0), *still),
            (1, 1e-3, 2000, (0.51e-3, 0.0), (-0.1, 0, 0), *still),
        )
        self.check("damped", spheres, dict(kn=1000, kt=300, gn=5e-3, gt=2e-3, mu=0.2), "damping")

    def test_dashpots_that_end_contacts(self):
        # With springs of sliding still strained.
        spheres = self.pairs(
            0.2 * 4e-6,
            (1, 1e-3, 2000, (-0.51e-3, 0.0), (0.1, 0.2, 0), (0, 0, 0)),
            (2, 1.3e-3, 2000, (0.66e-3, 0.1e-3), (-0.1, -0.1, 0), (0, 0, 50)),
        )
        self.check("sliding, damped", spheres, dict(kn=1000, kt=300, gn=2e-2, mu=0.5), "friction", least=7e-5)

    def test_dashpots_that_end_contacts_with_a_wall(self):
        dt = 4e-6
        spheres = []
        for n in range(self.PAIRS):
            y, z = 5e-3 * (n // 5) - 1e-2, 5e-3 * (n % 5) - 1e-2
            spheres.append((1, 1e-3, 2000, (0.51e-3 + 0.1 * dt * n / self.PAIRS, y, z), (-0.1, 0.2, 0), (0, 0, 0)))
        self.check(
            "sliding, damped, wall",
            spheres,
            dict(kn=1000, kt=300, gn=2e-2, mu=0.5),
            "friction",
            wall("side", "xplane 0"),
        )

    def test_sliding_impact(self):
        spheres = self.pairs(
            0.2 * 4e-6,
            (1, 1e-3, 2000, (-0.51e-3, 0.0), (0.1, 0.2, 0), (0, 0, 0)),
            (2, 1.3e-3, 2000, (0.66e-3, 0.1e-3), (-0.1, -0.1, 0), (0, 0, 50)),
        )
        self.check("sliding", spheres, dict(kn=1000, kt=300, gn=0, gt=2e-3, mu=0.2), "friction", least=2e-6)

    def test_rolling_friction(self):
        # Spheres that spin against each other as they meet.
        spheres = self.pairs(
            0.2 * 4e-6,
            (1, 1e-3, 2000, (-0.51e-3, 0.0), (0.1, 0, 0), (0, 100, 200)),
            (2, 1.3e-3, 2000, (0.66e-3, 0.1e-3), (-0.1, 0, 0), (0, -300, 50)),
        )
        stiffness = dict(kn=1000, kt=0, gn=0, mu=0)
        errors = self.errors("rolling", spheres, dict(stiffness, tangential="history rolling_friction cdt"), "friction")
        # So small that other errors of the last digits show at the shortest step.
        self.assertLess(abs(errors[-1]), 1e-6)
        self.assertGreater(math.log2(abs(errors[0] / errors[2])) / 2, 1.8)


class EnergyOfACloud(HostTest):
    """64 spheres that fly together, between walls or without, many of them touching several others at
    once: energy of motion, of springs and heat together is kept, to the second order of the step."""

    STEPS = (4e-6, 2e-6, 1e-6, 5e-7)

    def cloud(self, seed, inward=100):
        random_, spheres = random.Random(seed), []
        for n in range(64):
            diameter = 1e-3 * (0.8 + 0.4 * random_.random())
            place = tuple((m - 1.5) * 1.3e-3 + 1e-5 * random_.random() for m in (n % 4, n // 4 % 4, n // 16))
            speed = tuple(-inward * x + 0.1 * (random_.random() - 0.5) for x in place)
            spin = tuple(100 * (random_.random() - 0.5) for _ in range(3))
            spheres.append((1, diameter, 2000, place, speed, spin))
        return spheres

    def error(self, dt, seed, law, walls="", inward=100, kn=1000, kt=300, **changes):
        """Of one run: what motion and springs lose and heat does not gain, over what they lose."""
        spheres = self.cloud(seed, inward)
        self.write("data.spheres", data_file(spheres, (-1e-2,) * 3, (1e-2,) * 3))
        steps = round(4e-3 / dt)
        tangential = changes.get("tangential", "history")
        remembered = 3 * (tangential.startswith("history") + tangential.endswith("epsd2"))
        columns = " ".join(f"c_springs[{n}]" for n in range(1, 4 + remembered + 1))
        script = (
            head(dt=dt, kn=kn, kt=kt, **changes)
            + "fix rf all property/global coefficientRollingFriction peratomtypepair 2 0.1 0.1 0.1 0.1\n"
            + walls
            + "fix move all nve/sphere\nfix heat all granflux/heat initial_temperature 300 damping on conduction off\n"
            + f"compute rot all erotate/sphere\ncompute springs all pair/gran/local id {'history ' if remembered else ''}delta\n"
            + thermo("ke c_rot f_heat[16] f_heat[17] f_heat[20] f_heat[9]", steps)
            + f"run {steps}\n"
            + 'dump w all custom 1 places id x y z radius\ndump_modify w format "%d %.17g %.17g %.17g %.17g"\n'
            + f"dump a all local 1 springs {columns}\n"
            + 'dump_modify a format "' + " ".join(["%.17g"] * (4 + remembered)) + '"\n'
            + "run 1\n"  # which receives what springs held when contacts ended
        )
        output = self.run_script(law(script))
        elastic = self.elastic([sphere[1] / 2 for sphere in spheres], kn, kt, law is self.hertz)
        if walls:  # what springs hold there is not known from outside
            for *place, r in last_snapshot(self.read("places")).values():
                self.assertLess(max(map(abs, place)) + r, self.BOX)
        first, last = thermo_rows(output)[0], thermo_rows(output)[-1]
        lost = first[2] + first[3] - last[2] - last[3] - elastic
        # Dashpots give the heat of a whole step with its force, half a step ahead of motion.
        made = last[4] + last[5] + last[6] - dt / 2 * last[7]
        self.assertGreater(lost, 0.3 * (first[2] + first[3]))
        return (lost - made) / lost

    def elastic(self, radius, kn, kt, hertz):
        """What the springs of all contacts hold at the end."""
        energy = 0
        for line in self.read("springs").rsplit("ITEM: ENTRIES", 1)[1].splitlines()[1:]:
            i, j, _, *history, overlap = map(float, line.split())
            ri, rj = radius[int(i) - 1], radius[int(j) - 1]
            reduced = ri * rj / (ri + rj)
            root, power = (math.sqrt(reduced * overlap), 2 / 5) if hertz else (1, 1 / 2)
            energy += root * (power * kn * overlap**2 + kt / 2 * sum(h * h for h in history[:3]))
            energy += sum(h * h for h in history[3:]) / (2 * kt * root * reduced**2)
        return energy

    @staticmethod
    def linear(script):
        return script

    @staticmethod
    def hertz(script):
        """Stiffness in Pa."""
        return script.replace("hooke/stiffness", "hertz/stiffness").replace("absolute_damping on", "").replace("_abs", "")

    def check(self, name, least, law=None, order=1.8, **changes):
        law = law or self.linear
        errors = [
            math.sqrt(sum(self.error(dt, seed, law, **changes) ** 2 for seed in (1, 2)) / 2) for dt in self.STEPS
        ]
        found = math.log2(errors[0] / errors[-1]) / 3
        print(f"cloud, {name}: energy not accounted for, of what is lost:", *(f"{e:.2e}" for e in errors), f"order {found:.2f}")
        self.assertLess(errors[-1], least)
        self.assertGreater(found, order)

    def test_friction(self):
        self.check("friction", 1.5e-5)

    def test_normal_dashpots(self):
        self.check("normal dashpots", 2e-4, gn=5e-3, mu=0)

    def test_tangential_dashpots(self):
        self.check("tangential dashpots", 4e-5, gt=2e-3, mu=3)

    def test_all_dashpots(self):
        self.check("friction, dashpots", 1.2e-4, gn=5e-3, gt=2e-3)

    def test_dashpots_as_friction(self):
        self.check("no_history", 1.2e-4, gn=5e-3, gt=5e-3, tangential="no_history")

    def test_rolling(self):
        for model in ("cdt", "epsd2"):
            with self.subTest(model=model):
                self.check(f"rolling {model}", 2e-4, gn=5e-3, tangential=f"history rolling_friction {model}")

    BOX = 2.7e-3

    def planes(self):
        return "".join(wall(f"{d}{s}", f"{d}plane {self.BOX if s == 'up' else -self.BOX!r}") for d in "xyz" for s in ("down", "up"))

    def test_walls(self):
        self.check("planes", 8e-5, walls=self.planes(), inward=-100, gn=5e-3, gt=2e-3)

    def test_triangles(self):
        corners = list(itertools.product((-self.BOX, self.BOX), repeat=3))
        self.write("box.stl", stl([corners[k] for k in face] for face in FACES))
        triangles = "fix box all mesh/surface file box.stl type 1\n" + wall("side", "").replace("primitive type 1", "mesh n_meshes 1 meshes box")
        self.check("triangles", 1e-4, walls=triangles, inward=-100, gn=5e-3, gt=2e-3)

    def test_hertz(self):
        self.check("hertz", 2e-5, law=self.hertz, kn=1e8, kt=1e8, gn=0, gt=0)


if __name__ == "__main__":
    unittest.main()
