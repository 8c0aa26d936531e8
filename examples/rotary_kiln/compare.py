#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""compare.py radii|ends RESULTS RESULTS ...: radii.png, the mean temperature of the bed against time, or ends.png,
the bed's flow, of several runs of the kiln. Pictures go into the first folder; folders are named as run.sh does."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import kiln
from plot import BLUE, GREEN, MM, ORANGE, PINK, drum

NAMES = ("geometric", "overlap", "stock", "resting", "periodic")


def name_of(results, default):
    return next((name for name in NAMES if results.name.endswith("-" + name)), default)


def compare_radii(folders):
    figure, axis = plt.subplots(figsize=(8, 5), layout="constrained")
    for results, colour, style in zip(folders, (BLUE, ORANGE, GREEN, PINK), ("-", "--", "-.", ":")):
        table = kiln.thermo(results / "log.liggghts")
        share = (table["mean"] - kiln.COLD) / (kiln.HOT - kiln.COLD)
        name = name_of(results, "hertz")
        axis.plot(table["time"], 1e3 * share, color=colour, ls=style, label=name)
        wall = table["walls"][-1] / (table["walls"][-1] + table["gas"][-1])
        print(f"{name}: (T - 298 K)/75 K = {share[-1]:.5f} after {table['time'][-1]:.2f} s; {100 * wall:.1f} % of it by conduction "
              f"from the wall; Biot number mean {table['biot'][1:].mean():.1e}, largest {table['largest biot'].max():.1e}")
    axis.set_xlabel("time, s")
    axis.set_ylabel("(T - 298 K)/75 K of the bed, thousandths")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)
    axis.legend(title="contact radius")
    figure.savefig(folders[0] / "radii.png", dpi=110)


def compare_ends(folders):
    figure, axes = plt.subplots(1, len(folders), figsize=(4.7 * len(folders), 5.4), sharey=True, layout="constrained")
    for axis, results in zip(axes, folders):
        table = kiln.thermo(results / "log.liggghts")
        steady = 0.5 * table["time"][-1]
        bed = kiln.MeanBed()
        for frame in kiln.frames(results / "post/particles.txt"):
            if frame.time >= steady:
                bed.add(frame)
        vx, vy = bed.velocity()
        dense = bed.solids() > 0.1
        X, Y = np.meshgrid(bed.centres, bed.centres, indexing="ij")
        speed = MM * np.hypot(vx, vy)
        arrows = axis.quiver(MM * X[dense], MM * Y[dense], MM * vx[dense], MM * vy[dense], speed[dense], cmap="viridis",
                             scale=5000, width=3e-3, clim=(0, 300))
        axis.plot(*MM * bed.surface().T, color="k", lw=1.5)
        name = name_of(results, "turning")
        drum(axis, f"ends: {name}\nsurface at {bed.angle():.1f} degrees")
        terms = kiln.mechanics(table, len(frame.x))
        late = table["time"] >= steady
        power = np.polyfit(table["time"][late], terms["walls"][late], 1)[0]
        print(f"{name}: surface at {bed.angle():.1f} degrees in the middle, centre of mass at ({MM * table['x'][late].mean():.1f}, "
              f"{MM * table['y'][late].mean():.1f}) mm, walls do {1e3 * power:.0f} mW, fastest mean flow "
              f"{speed[bed.solids() > 0.3].max():.0f} mm/s")
    axes[0].set_ylabel("y, mm")
    figure.colorbar(arrows, ax=axes, location="bottom", shrink=0.4, aspect=40, extend="max", label="mean speed of the particles, mm/s")
    figure.savefig(folders[0] / "ends.png", dpi=110)


if __name__ == "__main__":
    {"radii": compare_radii, "ends": compare_ends}[sys.argv[1]]([Path(folder) for folder in sys.argv[2:]])
