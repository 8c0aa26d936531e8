# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""examples/rotary_kiln on a smaller drum."""

import pathlib
import re
import shutil
import sys

from host import HostTest

EXAMPLE = pathlib.Path(__file__).resolve().parents[2] / "examples/rotary_kiln"
sys.path.insert(0, str(EXAMPLE))
import kiln  # noqa: E402

PARTICLES = 1100
DRUM = dict(radius=30e-3, length=8e-3, particles=PARTICLES)
DIVISIONS = ((1, 2), (2, 1), (2, 2))  # ranks, threads; beside 1 x 1


class SmallKiln(HostTest):
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
