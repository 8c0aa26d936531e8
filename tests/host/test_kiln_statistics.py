# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The small drum of small_kiln.py for six seconds: ranks and threads, whose rounding has long since led to other
trajectories, give the same means, as far as the scatter within the runs tells means at all. A drum that turns 5 %
faster does not. With RESULT=FILE in the environment the numbers are written there."""

import json
import os
import unittest

import numpy as np

import host
from small_kiln import DIVISIONS, PARTICLES, SmallKiln, kiln

host.TIMEOUT = 3000  # s
BEGIN, BLOCK, END = 0.5, 0.5, 6.5  # s: from when on the bed flows, what one mean is of, end
# Standard errors by which two runs may differ: one difference in 200 is larger by chance (Student, twelve blocks).
ERRORS, TOLD = 3.5, 2
# And the most that they may where two standard errors tell so much: of the centre of mass in mm, of all else as a share.
MOST = {"x, mm": 0.15, "y, mm": 0.15, "motion, uJ": 0.08, "spin, uJ": 0.08, "walls' power, mW": 0.05,
        "friction, mW": 0.05, "damping, mW": 0.05, "heat to the bed, W": 0.01, "of it from the gas, W": 0.02}  # fmt: skip


class Statistics(SmallKiln):
    def blocks(self, ranks=1, threads=1, **variables):
        """{quantity: its mean in each block}."""
        table = self.turn(time=END, every=1, ranks=ranks, threads=threads, **variables)
        self.check_heat(table)
        time, work = table["time"], kiln.mechanics(table, PARTICLES)
        edges = np.arange(BEGIN, END + BLOCK / 2, BLOCK)

        def mean(values):
            return np.array([values[(time > low + 1e-9) & (time < low + BLOCK + 1e-9)].mean() for low in edges[:-1]])

        def rate(summed):
            return np.diff(np.interp(edges, time, summed)) / BLOCK

        received = sum(table[name] for name in ("walls", "friction", "damping", "gas"))
        found = (1e3 * mean(table["x"]), 1e3 * mean(table["y"]), 1e6 * mean(table["motion"]), 1e6 * mean(table["spin"]),
                 1e3 * rate(work["walls"]), 1e3 * rate(work["friction"]), 1e3 * rate(work["damping"]),
                 rate(received), rate(table["gas"]))  # fmt: skip
        return dict(zip(MOST, found))

    def differences(self, run, alone):
        """{quantity: (mean, difference from `alone`, standard error of that)}; block by block, so that what changes
        slowly in both is no scatter."""
        found = {}
        for name, blocks in run.items():
            difference = blocks - alone[name]
            error = difference.std(ddof=1) / np.sqrt(len(blocks))
            found[name] = blocks.mean(), difference.mean(), error
        return found

    def test_means(self):
        self.settle(settling=0.2)
        alone = self.blocks()
        found = {f"{ranks} x {threads}": self.differences(self.blocks(ranks, threads), alone)
                 for ranks, threads in DIVISIONS}
        found["21 rpm"] = self.differences(self.blocks(rpm=21), alone)
        print("\nranks x threads: difference from 1 x 1, and its standard error")
        for name, blocks in alone.items():
            print(f"{name:22} {blocks.mean():9.4f}", *(f"  {run}: {of[name][1]:8.4f} {of[name][2]:7.4f}"
                                                       for run, of in found.items()))
        if path := os.environ.get("RESULT"):
            keys = ("mean", "difference", "standard_error")
            with open(path, "w") as file:
                json.dump({"blocks": len(blocks), "seconds": BLOCK, "1 x 1": {n: {"mean": b.mean()} for n, b in alone.items()},
                           **{run: {name: dict(zip(keys, three)) for name, three in of.items()} for run, of in found.items()}},
                          file, indent=1)
        faster = found.pop("21 rpm")
        self.assertGreater(abs(faster["motion, uJ"][1]), ERRORS * faster["motion, uJ"][2])
        for run, of in found.items():
            for name, (mean, difference, error) in of.items():
                most = MOST[name] * (1 if name.endswith("mm") else abs(mean))
                self.assertLess(ERRORS * error, 0.05 * abs(mean), f"{name}, {run}: 5 % would not show")
                self.assertLessEqual(abs(difference), min(ERRORS * error, max(most, TOLD * error)), f"{name}, {run}")


if __name__ == "__main__":
    unittest.main()
