# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The keyword `effects` in whole runs: decisions, the same bits as by hand, warnings, bad words."""

import re
import unittest

from host import CASE, HostTest, bed, couple, dump, thermo
from test_gas import HEAT, warm_case


def states(output):
    """{effect: state} of the tables in an output."""
    found = {}
    for line in output.splitlines():
        row = re.match(r"  (\w[\w ]*?)\s{2,}.*?  (on|off, no data|off|not modelled) ", line)
        if row:
            found[row[1]] = row[2]
    return found


class Effects(HostTest):
    def gas(self, effects, steps=60, name="d", more="", script=None, every=10):
        return (
            (script or bed())
            + couple(every, f"effects {effects} {more}" if effects else more)
            + dump(name, steps)
            + f"run {steps}\n"
        )

    def test_cold_bed(self):
        output = self.run_script(self.gas("auto"))
        found = states(output)
        for effect in ("gas", "drag", "pressure_gradient", "two_way"):
            self.assertEqual(found[effect], "on", output)
        self.assertEqual(found["convection"], "off, no data", output)
        self.assertEqual(found["added mass"], "not modelled", output)
        self.assertIn("measured cost of the effects that are on", output)
        # By hand, and without the keyword, it is the same run to the last bit.
        automatic = self.read("d")
        self.run_script(self.gas("gas drag pressure_gradient two_way", name="h"))
        self.assertEqual(automatic, self.read("h"))
        self.run_script(self.gas("", name="n"))
        self.assertEqual(automatic, self.read("n"))

    def test_gas_that_does_not_count(self):
        # A thousandth of air's density and viscosity, no inlet to speak of.
        thin = CASE.replace("1.2", "1.2e-4").replace("1.8e-5", "1.8e-9").replace("0, 0, 0.5", "0, 0, 0.001")
        self.write("case.toml", thin + '[output]\nfields = "gas"\nevery = 1e-4\n')
        output = self.run_script(self.gas("auto"))
        self.assertEqual(states(output)["gas"], "off", output)
        self.assertIn("the gas was not solved", output)
        self.assertEqual([p.name for p in self.folder.glob("gas*")], [])  # nor any file opened
        automatic = self.read("d")
        self.run_script(self.gas("none", name="h"))
        self.assertEqual(automatic, self.read("h"))
        # Nor does it hold memory: the properties of particles in gas are not there.
        code, output = self.start(self.gas("none") + "compute c all reduce max f_voidfraction\nrun 1\n")
        self.assertNotEqual(code, 0, output)
        # It is what plain particles do.
        self.run_script(bed() + dump("p", 60) + "run 60\n")
        self.assertEqual(automatic, self.read("p"))

    def test_parts(self):
        runs = {}
        for effects in ("gas two_way", "gas drag", "gas drag pressure_gradient", "gas pressure_gradient two_way"):
            self.run_script(self.gas(effects, name="d") + "run 20\n")
            runs[effects] = self.read("d")
        self.assertEqual(len(set(runs.values())), 4)

    def test_warm_bed(self):
        self.write("case.toml", warm_case())
        script = bed() + HEAT.replace("damping on", "effects auto").format(words="") + couple(10, "effects auto")
        tail = 'dump t all custom 60 {} id f_Temp x\ndump_modify t sort id format "%d %.17g %.17g"\nrun 60\n'
        output = self.run_script(script + tail.format("a"))
        found = states(output)
        for effect in ("gas", "drag", "two_way", "convection", "radiation"):
            self.assertIn(effect, found, output)
        self.assertEqual(found["convection"], "on", output)
        self.assertEqual(found["friction"], "off", output)
        self.assertEqual(found["radiation"], "off, no data", output)
        on = [effect for effect, state in found.items() if state == "on"]
        heat = " ".join(e for e in on if e in ("conduction", "friction", "damping")) or "none"
        gas = " ".join(e for e in on if e in ("gas", "drag", "pressure_gradient", "two_way", "convection", "buoyancy"))
        by_hand = bed() + HEAT.replace("damping on", f"effects {heat}").format(words="") + couple(10, f"effects {gas}")
        self.run_script(by_hand + tail.format("h"))
        self.assertEqual(self.read("a"), self.read("h"))

    def test_warning_when_a_neglected_effect_comes_to_count(self):
        # Particles at rest in gas at rest; then the script sets them in motion.
        case = CASE.replace("0, 0, 0.5", "0, 0, 0")
        self.write("case.toml", case)
        still = bed() + "velocity all set 0 0 0\n"
        still = still.replace("fix             gravity all gravity 9.81 vector 0 0 -1\n", "fix gravity all gravity 9.81 vector 0 0 -1\n")
        output = self.run_script(still + couple(10, "effects auto") + "run 10\nvelocity all set 3 0 0\nrun 10\n")
        before, after = output.split("the gas was not solved", 1)
        self.assertNotIn("now counts", before)
        self.assertIn("WARNING: the effect drag, which is off, now counts", after)
        self.assertEqual(after.count("the effect drag, which is off"), 1, after)

    def test_isothermal(self):
        properties = HEAT.replace("initial_temperature 400 damping on", "initial_temperature 300 effects auto").format(words="")
        properties += "velocity all set 0 0 0\n"
        output = self.run_script(bed() + properties + "run 20\n")
        found = states(output)
        for effect in ("conduction", "friction", "damping"):
            self.assertEqual(found[effect], "off", output)
        code, output = self.start(bed() + properties + "run 20\ncompute c all reduce max f_heatContact[1]\nrun 1\n")
        self.assertNotEqual(code, 0, output)

    def test_bad_words(self):
        for effects, *texts in (
            ("gass", "effects gass: unknown", "auto, none, gas, drag, pressure_gradient, two_way, convection, buoyancy"),
            ("drag", "needs the effect gas"),
            ("gas conduction", "is of fix granflux/heat"),
            ("gas convection", "no [energy] table"),
            ("auto gas", "stands alone"),
        ):
            with self.subTest(effects=effects):
                code, output = self.start(self.gas(effects))
                self.assertNotEqual(code, 0)
                for text in texts:
                    self.assertIn(text, output)
        for effects, text in (("radiation", "keyword radiation is missing"), ("gas", "is of fix granflux/couple")):
            with self.subTest(effects=effects):
                heat = HEAT.replace("damping on", f"effects {effects}").format(words="")
                code, output = self.start(bed() + heat + "run 1\n")
                self.assertNotEqual(code, 0)
                self.assertIn(text, output)


if __name__ == "__main__":
    unittest.main()
