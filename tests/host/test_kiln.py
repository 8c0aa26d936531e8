# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/rotary_kiln on a smaller drum: its books, and the same totals however the work is divided."""

import pathlib
import re
import shutil
import sys
import unittest

from host import HostTest

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/rotary_kiln"
sys.path.insert(0, str(EXAMPLE))
import kiln  # noqa: E402

PARTICLES = 1100
DRUM = dict(radius=30e-3, length=8e-3, particles=PARTICLES)
DIVISIONS = ((1, 2), (2, 1), (2, 2))  # ranks, threads


class Kiln(HostTest):
    def setUp(self):
        super().setUp()
        for file in [*EXAMPLE.glob("in.*"), EXAMPLE / "end.stl"]:
            shutil.copy(file, self.folder)
        case = (EXAMPLE / "kiln.toml").read_text()
        for key, value in (("radius", 30e-3), ("length", 8e-3), ("cells", [2, 4, 3])):
            case, found = re.subn(rf"^{key} = .*$", f"{key} = {value}", case, flags=re.M)
            self.assertEqual(found, 1, key)
        self.write("kiln.toml", re.sub(r"\[output\].*", "", case, flags=re.S))

    def run_example(self, script, ranks=1, threads=1, **variables):
        options = ["-threads", str(threads)]
        for name, value in {**DRUM, **variables}.items():
            options += ["-var", name, str(value)]
        text = (self.folder / script).read_text()
        return self.run_script(text, ranks, options=options)

    def settle(self, **variables):
        self.run_example("in.settle", **{"fill": 6e-3, "settling": 0.06, **variables})

    def turn(self, **variables):
        output = self.run_example("in.kiln", **variables)
        self.assertIn("granflux: contact forces by particle subset", output)
        return kiln.thermo(self.folder / "log.liggghts")

    def check_heat(self, table):
        received = sum(table[name][-1] for name in ("walls", "friction", "damping", "gas"))
        self.assertGreater(received, 0)
        self.assertLess(abs(table["open"][-1]), 1e-8 * received)
        self.assertLess(table["handed over"].max(), 1e-10)
        self.assertLess(table["gas residual"].max(), 1e-9)
        self.assertLess(table["momentum residual"].max(), 1e-10)

    def test_ranks_and_threads_give_the_same_totals(self):
        self.settle()
        short = dict(time=100 * kiln.DT, report=20 * kiln.DT, couple_every=10, every=1)
        alone = self.turn(**short)
        self.check_heat(alone)
        names = ("walls", "friction", "damping", "gas", "into walls", "angular momentum", "motion", "spin", "x", "y",
                 "walls to gas W", "gas power", "gas torque")
        for ranks, threads in DIVISIONS:
            other = self.turn(ranks=ranks, threads=threads, **short)
            for name in names:
                scale = abs(alone[name]).max()
                self.assertGreater(scale, 0, name)
                self.assertLess(abs(other[name] - alone[name]).max(), 1e-10 * scale, f"{name}, {ranks} x {threads}")
            self.assertLess(abs(other["heat"] - alone["heat"]).max(), 1e-10 * alone["heat"][0])

    def energy_left_over(self, dt):
        """Of 0.05 s after the start: energy of motion that is not accounted for, over what was dissipated."""
        table = self.turn(time=0.05, every=0.05, dt=dt)
        self.check_heat(table)
        terms = kiln.mechanics(table, PARTICLES, dt * kiln.COUPLE_EVERY)
        end = {name: value[-1] for name, value in terms.items()}
        springs = kiln.Springs(self.folder / "post", DRUM["radius"])
        self.assertLess(springs.largest.max(), 0.01)
        dissipated = end["friction"] + end["damping"]
        for name in ("walls", "kinetic", "friction"):  # a slip of 5 % in any of them would show
            self.assertGreater(0.05 * end[name], 0.015 * dissipated, name)
        gained = end["kinetic"] + end["height"] + springs.energy[-1] - springs.energy[0]
        return (end["walls"] + end["gas"] - gained - dissipated) / dissipated

    def test_energy_of_motion_is_accounted_for(self):
        self.settle(settling=0.2)
        coarse, fine = (self.energy_left_over(dt) for dt in (kiln.DT, kiln.DT / 2))
        print(f"energy not accounted for, of what is dissipated: {coarse:.1e}, with half the step {fine:.1e}")
        self.assertLess(abs(coarse), 0.015)
        self.assertLess(abs(fine), 0.7 * abs(coarse))

    def test_other_ends(self):
        case = self.read("kiln.toml")
        still = re.sub(r'(name = "(low|high)"\ntype = "wall"\n)angular_velocity.*\n', r"\1", case)
        open_ = re.sub(r'\[\[boundary\]\]\nname = "(low|high)"\n(.+\n)+', "", case)
        open_ = open_.replace("axial_blocks = 1", "axial_blocks = 1\nperiodic_axis = true")
        for ends, text in (dict(ends_turn=0), still), (dict(ends=0), open_):
            self.assertNotEqual(text, case)
            self.write("kiln.toml", text)
            self.settle(**ends)
            self.check_heat(self.turn(time=0.02, **ends))


if __name__ == "__main__":
    unittest.main()
