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
        print(f"{name}: (T - 298 K)/75 K = {share[-1]:.5f} after {table['time'][-1]:.2f} s; {100 * wall:.1f} % of it "
              f"by conduction from the wall; Biot number mean {table['biot'][1:].mean():.1e}, "
              f"largest {table['largest biot'].max():.1e}")
    axis.set_xlabel("time, s")
    axis.set_ylabel("(T - 298 K)/75 K of the bed, thousandths")
    axis.set_xlim(left=0)
    axis.set_ylim(bottom=0)
    axis.legend(title="contact radius")
    figure.savefig(folders[0] / "radii.png", dpi=110)


def compare_ends(folders):
    count = len(folders)
    figure, axes = plt.subplots(1, 1 + count, figsize=(4.4 * (1 + count), 5.8), layout="constrained")
    for results, axis, colour, style in zip(folders, axes[1:], (BLUE, ORANGE, GREEN), ("-", "--", "-.")):
        table, name = kiln.thermo(results / "log.liggghts"), name_of(results, "turning")
        inclination = np.degrees(np.arctan2(table["x"], -table["y"]))
        axes[0].plot(table["time"], inclination, color=colour, ls=style, label=name)
        late = table["time"] >= 0.75 * table["time"][-1]
        bed = kiln.MeanBed()
        for frame in kiln.frames(results / "post/particles.txt"):
            if frame.time >= 0.75 * table["time"][-1]:
                bed.add(frame)
        vx, vy = bed.velocity()
        dense = bed.solids() > 0.1
        X, Y = np.meshgrid(bed.centres, bed.centres, indexing="ij")
        speed = MM * np.hypot(vx, vy)
        arrows = axis.quiver(MM * X[dense], MM * Y[dense], MM * vx[dense], MM * vy[dense], speed[dense],
                             cmap="viridis", scale=6000, width=3e-3, clim=(0, 500))
        axis.plot(*MM * bed.surface().T, color="k", lw=1.5)
        drum(axis, f"ends: {name}; {table['time'][late][0]:.2f} to {table['time'][-1]:.2f} s\n"
                   f"surface at {bed.angle():.1f} degrees in the middle")
        work = kiln.mechanics(table, len(frame.x))["walls"]
        power = np.polyfit(table["time"][late], work[late], 1)[0]
        print(f"{name}, {table['time'][late][0]:.2f} to {table['time'][-1]:.2f} s: "
              f"surface at {bed.angle():.1f} degrees, centre of mass at {inclination[late].mean():.1f} degrees, "
              f"walls do {1e3 * power:.0f} mW of work, kinetic energy {1e3 * table['motion'][late].mean():.2f} mJ")
    axes[0].set_xlabel("time, s")
    axes[0].set_ylabel("centre of mass, degrees from below the axis")
    axes[0].set_xlim(0, 1)
    axes[0].legend(title="ends")
    axes[1].set_ylabel("y, mm")
    figure.colorbar(arrows, ax=axes[1:], location="bottom", shrink=0.4, aspect=40, extend="max",
                    label="mean speed of the particles, mm/s")
    figure.savefig(folders[0] / "ends.png", dpi=110, bbox_inches="tight")


if __name__ == "__main__":
    {"radii": compare_radii, "ends": compare_ends}[sys.argv[1]]([Path(folder) for folder in sys.argv[2:]])
