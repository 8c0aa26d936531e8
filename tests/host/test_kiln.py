# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/rotary_kiln on a smaller drum: its books, and the same totals however the work is divided."""

import re
import unittest

from host import last_snapshot
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

    def test_continues_bit_for_bit(self):
        # Ends of triangles that turn, gas on blocks fitted to the drum, heat and friction.
        self.settle()
        script = (self.folder / "in.kiln").read_text().partition("timestep ")[0]
        digits = "dump_modify end sort id format \"%d" + " %.17g" * 13 + '"\n'
        moving = "".join(f"fix turn_{end} all move/mesh mesh {end} rotate origin 0. 0. 0. axis 0. 0. 1. period 3.\n" for end in ("low", "high"))
        for ranks, threads, every, more in ((1, 2, 30, ""), (2, 1, 33, moving)):

            def run(name, to, start="settled.restart"):
                end = f"dump end all custom 100 {name} id x y z vx vy vz omegax omegay omegaz f_Temp fx fy fz\n{digits}"
                end += f"fix keep all granflux/checkpoint kiln.checkpoint every {every}\ntimestep ${{dt}}\nrun {to} upto\n"
                text = script.replace("read_restart    settled.restart", f"read_restart {start}")
                variables = dict(DRUM, couple_every=10)
                options = [word for name, value in variables.items() for word in ("-var", name, str(value))]
                return self.run_script(text + more + end, ranks, options=["-threads", str(threads), *options])

            with self.subTest(ranks=ranks, threads=threads, every=every):
                if more:  # triangles that move; else they have a speed of their own
                    contacts = self.read("in.contacts")
                    self.write("in.contacts", re.sub(r" &\n +surface_ang_vel .*\$\{turn\}", "", contacts))
                    self.assertNotEqual(self.read("in.contacts"), contacts)
                run("whole", 100)
                run("first", 2 * every + 5)
                run("again", 100, "kiln.checkpoint")
                whole, again = last_snapshot(self.read("whole")), last_snapshot(self.read("again"))
                self.assertEqual(len(whole), PARTICLES)
                self.assertEqual(whole, again)

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
