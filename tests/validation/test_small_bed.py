# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The small bed at U = 0.6 m/s, 8 s averaged: pressure drop against the weight of the bed, void
fraction against the magnetic-resonance measurements of Mueller et al."""

import json
import subprocess
import sys
import unittest
from pathlib import Path

EXAMPLE = Path(__file__).resolve().parents[2] / "examples/fluidized_bed"
sys.path.insert(0, str(EXAMPLE))
import bed  # noqa: E402


class SmallBed(unittest.TestCase):
    def test_pressure_drop_and_void_profiles(self):
        subprocess.run([EXAMPLE / "run.sh", "--validate"], check=True)
        results = EXAMPLE / "results/validation"
        table = bed.thermo(results / "log.liggghts")
        drop = table["gas[1]"][table["Time"] > 2].mean()
        self.assertAlmostEqual(drop / bed.WEIGHT_PER_AREA, 1, delta=0.03)
        profile = json.loads((results / "profile.json").read_text())
        for height in ("16.4 mm", "31.2 mm"):
            self.assertLess(profile[height]["rmse"], profile[height]["target_rmse"])


if __name__ == "__main__":
    unittest.main()
