# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What cannot be meant is refused before the first step, with words that help."""

import unittest

from host import HostTest
from warm_spheres import data_file, head, wall

GOOD = "initial_temperature 300"


class BadInput(HostTest):
    def refused(self, words, *texts, before="", after="", options=(), without="", style="granflux/heat", group="all"):
        self.write("data.spheres", data_file([(1, 1e-3, 2000, (0.0, 0.0, 0.0)), (2, 1e-3, 2000, (5e-3, 0.0, 0.0))]))
        properties = "".join(
            line for line in head().splitlines(True) if not (without and without in line)
        )
        code, output = self.start(
            f"{properties}group some id 1\n{before}fix move all nve/sphere\nfix heat {group} {style} {words}\n{after}run 1\n",
            options=options,
        )
        self.assertNotEqual(code, 0, output)
        self.assertNotIn("Segmentation", output)
        for text in texts:
            self.assertIn(text, output)

    def test_words(self):
        for words, *texts in (
            ("", "initial_temperature is missing"),
            ("initial_temperature -5", "initial_temperature -5", "from 0.001 to 1e5 K"),
            ("initial_temperature warm", "initial_temperature warm"),
            (f"{GOOD} conduction herz", "herz", "hertz geometric overlap stock", "off"),
            (f"{GOOD} friction yes", "friction yes", "slider, speed or off"),
            (f"{GOOD} damping yes", "damping yes", "on or off"),
            (f"{GOOD} wall_share 1.5", "wall_share 1.5", "0 to 1"),
            (f"{GOOD} fixed_temperature nobody", "fixed_temperature nobody", "no such group"),
            (f"{GOOD} conducton hertz", "unknown keyword conducton", "conduction"),
            (f"{GOOD} friction", "friction has no value"),
            (f"{GOOD} gas_gap thick", "gas_gap thick", "off or a conductivity", "W/(m K)"),
            (f"{GOOD} gas_layer 0.3", "gas_layer is of no use without gas_gap"),
            (f"{GOOD} gas_gap 0.03 gas_layer 2", "gas_layer 2", "0.001 to 1"),
            (f"{GOOD} gas_gap 0.03 least_gap 0", "least_gap 0", "1e-12 to 1e-3 m"),
            (f"{GOOD} heat_every 0", "heat_every 0", "whole number from 1 to 1000"),
            (f"{GOOD} heat_every 2.5", "heat_every 2.5", "whole number"),
            (f"{GOOD} radiation on", "radiation on", "temperature of the surroundings"),
            (f"{GOOD} radiation 300", "needs fix property/global emissivity"),
        ):
            with self.subTest(words=words):
                self.refused(words, *texts)

    def test_group(self):
        self.refused(GOOD, "group some", "must be all", group="some")

    def test_missing_properties(self):
        for name in ("thermalCapacity", "thermalConductivity", "youngsModulusOriginal", "poissonsRatio"):
            with self.subTest(name=name):
                self.refused(GOOD, name, "peratomtype", without=name)

    def test_emissivity(self):
        self.refused(
            f"{GOOD} radiation 300",
            "emissivity of type 2 is 1.2: must be at most 1",
            before="fix em all property/global emissivity peratomtype 0.9 1.2\n",
        )

    def test_two_of_them(self):
        self.refused(GOOD, "fix heat is one already", after=f"fix more all granflux/heat {GOOD}\n")

    def test_beside_the_own_law_of_the_host(self):
        self.refused(GOOD, "changes the same temperatures", before="fix old all heat/gran/conduction initial_temperature 300.\n")

    def test_forces_by_the_host(self):
        self.refused(GOOD, "conduction overlap, stock or off", options=("-subset", "off"))
        self.refused(f"{GOOD} conduction overlap", "friction off", options=("-subset", "off"))
        self.refused(f"{GOOD} conduction off friction off gas_gap 0.03", "gas_gap off", options=("-subset", "off"))
        self.refused(
            f"{GOOD} conduction overlap friction off",
            "fix floor wall/gran",
            before=wall("floor", "zplane 0", more="temperature 400"),
            options=("-subset", "off"),
        )

    def test_warnings(self):
        # Soft contacts of large radius, and 800 K.
        self.write(
            "data.spheres", data_file([(1, 1e-3, 2000, (0.0, 0.0, 0.0)), (2, 1e-3, 2000, (0.8e-3, 0.0, 0.0))])
        )
        for temperature, words, *texts in (
            (800, "conduction off", "above 700 K radiation matters"),
            (300, "conduction overlap", "Biot number of a particle is", "above 0.1"),
        ):
            output = self.run_script(
                head() + f"fix hold all freeze\nfix heat all granflux/heat initial_temperature {temperature} {words}\nrun 1\n"
            )
            for text in ("WARNING", *texts):
                self.assertIn(text, output)

    def test_too_few_steps_of_temperature(self):
        """A collision here lasts 568 time steps."""
        self.write("data.spheres", data_file([(1, 1e-3, 2000, (0.0, 0.0, 0.0), (0.1, 0, 0), (0, 0, 0))]))
        text = head(dt=4e-8) + "fix move all nve/sphere\nfix heat all granflux/heat initial_temperature 300 heat_every {}\nrun 1\n"
        code, output = self.start(text.format(900))
        self.assertNotEqual(code, 0)
        for part in ("heat_every 900", "must be no longer", "at most 568 time steps"):
            self.assertIn(part, output)
        self.assertIn("WARNING: granflux: heat_every 400", self.run_script(text.format(400)))
        self.assertNotIn("WARNING: granflux: heat_every", self.run_script(text.format(250)))

    def test_too_long_a_step(self):
        self.write(
            "data.spheres", data_file([(1, 1e-3, 2000, (0.0, 0.0, 0.0)), (2, 1e-3, 2000, (0.99e-3, 0.0, 0.0))])
        )
        code, output = self.start(head(dt=100) + f"fix hold all freeze\nfix heat all granflux/heat {GOOD}\nrun 2\n")
        self.assertNotEqual(code, 0)
        self.assertIn("use a smaller one", output)


if __name__ == "__main__":
    unittest.main()
