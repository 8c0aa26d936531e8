#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py RESULTS: picture.png (particles by temperature at four times) and plot.png (temperatures
and heat by mechanism against time) of a run of the hot bed."""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection

DIAMETER, DT = 1.2, 8e-6  # mm, s
COLUMNS = ("step", "time", "mean", "lowest", "highest", "walls", "friction", "damping", "gas", "handed over",
           "gas residual", "open", "heat", "biot")


def thermo(log):
    """The last table of the log."""
    rows = []
    for line in log.read_text().splitlines():
        words = line.split()
        if words[:2] == ["Step", "t"]:
            rows = []
        elif len(words) == len(COLUMNS):
            try:
                rows.append([float(word) for word in words])
            except ValueError:
                pass
    return dict(zip(COLUMNS, np.array(rows).T))


def snapshots(path):
    """[(step, array of id x y z temperature ...)]"""
    found = []
    for part in path.read_text().split("ITEM: TIMESTEP\n")[1:]:
        step, rest = part.split("\n", 1)
        rows = rest.split("ITEM: ATOMS", 1)[1].splitlines()[1:]
        found.append((int(step), np.array([[float(word) for word in row.split()] for row in rows])))
    return found


def draw_bed(results):
    all_ = snapshots(results / "post/particles.txt")
    chosen = [all_[round(i * (len(all_) - 1) / 3)] for i in range(4)]
    figure, axes = plt.subplots(1, 4, figsize=(11, 7.5), sharey=True, layout="constrained")
    for axis, (step, data) in zip(axes, chosen):
        order = np.argsort(-data[:, 2])
        spheres = EllipseCollection(DIAMETER, DIAMETER, 0, units="xy", offsets=1e3 * data[order][:, [1, 3]],
                                    transOffset=axis.transData, array=data[order, 4], cmap="inferno", linewidths=0)
        spheres.set_clim(300, 400)
        axis.add_collection(spheres)
        axis.set_aspect("equal")
        axis.set_xlim(0, 24)
        axis.set_ylim(0, 60)
        axis.set_xlabel("x, mm")
        axis.set_title(f"t = {step * DT:.2f} s")
    axes[0].set_ylabel("z, mm")
    figure.colorbar(spheres, ax=axes, location="bottom", shrink=0.5, aspect=40, label="temperature of the particles, K")
    figure.savefig(results / "picture.png", dpi=110, bbox_inches="tight")


def draw_heat(results):
    t = thermo(results / "log.liggghts")
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 7), sharex=True, layout="constrained")
    above.fill_between(t["time"], t["lowest"], t["highest"], color="tab:red", alpha=0.2, label="lowest to highest")
    above.plot(t["time"], t["mean"], color="tab:red", label="mean")
    above.set_ylabel("temperature of the particles, K")
    above.legend()
    shown = (("gas", "from the gas", "tab:blue"), ("walls", "from the cold wall", "tab:green"),
             ("friction", "friction", "tab:orange"), ("damping", "damping", "tab:purple"))
    for name, label, colour in shown:
        below.plot(t["time"], np.abs(t[name]), color=colour, label=label, linewidth=1)
    below.set_yscale("log")
    below.set_ylim(1e-8, 1e2)
    below.set_xlabel("time, s")
    below.set_ylabel("heat to or from the particles, W")
    below.legend(ncol=2)
    figure.savefig(results / "plot.png", dpi=110)
    print(f"mean temperature {t['mean'][0]:.2f} K at first, {t['mean'][-1]:.2f} K after {t['time'][-1]:.2f} s; "
          f"largest residual of heat handed over {t['handed over'].max():.1e}, of the gas's heat "
          f"{t['gas residual'].max():.1e}; heat not accounted for {abs(t['open'] - t['open'][0]).max() / t['heat'][0]:.1e} of all; "
          f"Biot number {t['biot'].max():.1e}")


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    draw_bed(folder)
    draw_heat(folder)
