# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/rotary_kiln on a smaller drum: its books, and the same totals however the work is divided."""

import re
import unittest

from small_kiln import DIVISIONS, DRUM, PARTICLES, SmallKiln, kiln


class Kiln(SmallKiln):
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
