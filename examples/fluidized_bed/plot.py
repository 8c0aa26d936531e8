#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py RESULTS: picture.png (bed and gas at four times) and plot.png (pressure drop against
time) of a run of the small bed. A run that left post/profile.txt also gets profile.png."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection

import bed


def draw_bed(results):
    snapshots = bed.snapshots(results)
    gases = [bed.gas(f) for f in sorted((results / "post").glob("gas_*.cgns"))]
    table = bed.thermo(bed.log_of(results))
    time_of = dict(zip(table["Step"], table["Time"]))
    chosen = [snapshots[round(i * (len(snapshots) - 1) / 3)] for i in range(4)]
    figure, axes = plt.subplots(1, 5, figsize=(13, 8), sharey=True, layout="constrained")
    for axis, (step, x, speed) in zip(axes, chosen):
        order = np.argsort(-x[:, 1])
        spheres = EllipseCollection(
            1.2, 1.2, 0, units="xy", offsets=1e3 * x[order][:, [0, 2]],
            transOffset=axis.transData, array=speed[order], cmap="coolwarm", linewidths=0)
        spheres.set_clim(-0.5, 0.5)
        axis.add_collection(spheres)
        axis.set_title(f"t = {time_of.get(step, np.nan):.2f} s")
    figure.colorbar(spheres, ax=axes[:4], location="bottom", shrink=0.5, aspect=40,
                    label="particle velocity upwards, m/s")
    gas = gases[-1]
    levels = np.linspace(0.4, 1, 13)
    filled = axes[4].tricontourf(1e3 * gas["x"], 1e3 * gas["z"], gas["VoidFraction"], levels,
                                 cmap="viridis", extend="both")
    axes[4].quiver(1e3 * gas["x"], 1e3 * gas["z"], gas["VelocityX"], gas["VelocityZ"], color="w",
                   scale=40, width=4e-3)
    axes[4].set_title(f"gas, t = {gas['time']:.2f} s")
    figure.colorbar(filled, ax=axes[4], location="bottom", label="void fraction")
    for axis in axes:
        axis.set_aspect("equal")
        axis.set_xlim(0, 1e3 * bed.WIDTH)
        axis.set_ylim(0, 120)
        axis.set_xlabel("x, mm")
    axes[0].set_ylabel("z, mm")
    figure.savefig(results / "picture.png", dpi=110, bbox_inches="tight")


def draw_pressure_drop(results):
    table = bed.thermo(bed.log_of(results))
    time, drop = table["Time"], table["gas[1]"]
    figure, axis = plt.subplots(figsize=(8, 4.5), layout="constrained")
    axis.plot(time, drop, lw=1, label="pressure drop of the gas")
    axis.axhline(bed.WEIGHT_PER_AREA, color="k", ls="--",
                 label=f"weight of the bed per area, {bed.WEIGHT_PER_AREA:.1f} Pa")
    late = time > 0.25 * time[-1]
    axis.set_xlabel("time, s")
    axis.set_ylabel("Pa")
    if time[-1] > 1:
        axis.set_title(f"mean of the last three quarters: {drop[late].mean():.1f} Pa")
    else:
        axis.set_title("the start only; a mean needs some seconds")
    axis.legend()
    figure.savefig(results / "plot.png", dpi=110)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    draw_bed(folder)
    draw_pressure_drop(folder)
