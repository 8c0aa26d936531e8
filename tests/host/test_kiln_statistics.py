# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The small drum of small_kiln.py for a second: ranks and threads, whose rounding has long since led to other
trajectories, give the same means."""

import unittest

import numpy as np

import host
from small_kiln import DIVISIONS, PARTICLES, SmallKiln, kiln

host.TIMEOUT = 3000  # s
BEGIN = 0.5  # s, of the means: the bed flows
# Largest difference allowed: of the centre of mass in mm, of all else as a share.
ALLOWED = {"x, mm": 0.15, "y, mm": 0.15, "motion, uJ": 0.08, "walls' power, mW": 0.05, "heat to the bed, J": 0.01,
           "of it from the gas, J": 0.02}  # fmt: skip


class Statistics(SmallKiln):
    def means(self, ranks, threads):
        table = self.turn(time=1, every=1, ranks=ranks, threads=threads)
        self.check_heat(table)
        late = table["time"] >= BEGIN
        work = kiln.mechanics(table, PARTICLES)["walls"]
        received = sum(table[name][-1] for name in ("walls", "friction", "damping", "gas"))
        return {
            "x, mm": 1e3 * table["x"][late].mean(),
            "y, mm": 1e3 * table["y"][late].mean(),
            "motion, uJ": 1e6 * table["motion"][late].mean(),
            "walls' power, mW": 1e3 * np.polyfit(table["time"][late], work[late], 1)[0],
            "heat to the bed, J": received,
            "of it from the gas, J": table["gas"][-1],
        }

    def test_means_of_a_second(self):
        self.settle(settling=0.2)
        found = {division: self.means(*division) for division in ((1, 1), *DIVISIONS)}
        print("\nranks x threads  ", *(f"{name:>22}" for name in ALLOWED))
        for (ranks, threads), means in found.items():
            print(f"{ranks} x {threads}            ", *(f"{means[name]:22.4f}" for name in ALLOWED))
        for name, allowed in ALLOWED.items():
            values = np.array([means[name] for means in found.values()])
            scale = 1 if name.endswith("mm") else abs(values.mean())
            self.assertLess(np.ptp(values), allowed * scale, name)


if __name__ == "__main__":
    unittest.main()
