# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""docs/effects.md says what docs/results/data/effects_counts.json holds, and those counts are what is promised: what is
off costs nothing. The counts are made by `tests/bench/run counts`, which takes too long for a test."""

import json
import pathlib
import unittest

DOCS = pathlib.Path(__file__).parents[2] / "docs"
COUNTS = json.loads((DOCS / "results/data/effects_counts.json").read_text())
SCENES = COUNTS["scenes"]
PLAIN = SCENES["plain particles"]


def instructions(name):
    return SCENES[name]["instructions_a_particle_step"]


def row(name):
    """Of the table in docs/effects.md."""
    scene = SCENES[name]
    files = ", ".join(f for f in scene["files"] if f not in PLAIN["files"]) or "-"
    return (f"| {name} | {instructions(name):.1f} | {instructions(name) - instructions('plain particles'):+.1f} "
            f"| {scene['allocations_a_step']:.1f} | {scene['blocks_of_a_run'] - PLAIN['blocks_of_a_run']:+d} "
            f"| {round((scene['largest_heap_bytes'] - PLAIN['largest_heap_bytes']) / 1000):+d} | {files} |")


class Counts(unittest.TestCase):
    def test_page_says_what_was_counted(self):
        page = (DOCS / "effects.md").read_text().splitlines()
        for name in SCENES:
            self.assertIn(row(name), page)

    def test_what_is_off_costs_nothing(self):
        for name in ("dry: heat none", "dry: gas none", "dry: both none"):
            self.assertLess(instructions(name) / instructions("plain particles"), 1.01, name)
        pair = "heat: conduction friction"
        self.assertAlmostEqual(instructions(pair), instructions(pair + ", not given the others' data"), delta=0.1)
        for name in ("cold bed by effects", "cold bed, convection and buoyancy off"):
            self.assertLess(instructions(name) / instructions("cold bed"), 1.01, name)

    def test_a_frozen_bed_does_no_contact_work(self):
        # A wall costs a look whether its particles are as they were; half of them are at walls.
        for name in ("all frozen", "all frozen, gas"):
            self.assertLess(instructions(name) - instructions(name + ", no walls"), 70, name)
        self.assertLess(instructions("all frozen, gas") - instructions("all frozen"),
                        1.02 * (instructions("cold bed") - instructions("plain particles")))
        self.assertLess(instructions("all frozen") / instructions("plain particles"), 0.25)

    def test_gas_without_particles_costs_what_it_costs_alone(self):
        alone, coupled = (COUNTS["gas_alone"][name] for name in ("granflux_cfd", "granflux, an empty box"))
        for what, more in (("gas_instructions_a_cell_step", 0.005), ("program_instructions_a_cell_step", 0.02)):
            self.assertLess(coupled[what] / alone[what] - 1, more, what)


if __name__ == "__main__":
    unittest.main()
