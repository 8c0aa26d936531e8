#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py RESULTS: picture.png (all particles, seen from above one corner, by vertical velocity) and
plot.png (pressure drop against time, and where the time of the timed steps went) of a run of the large bed."""

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

DIAMETER, DENSITY, GAS_DENSITY, GRAVITY = 0.004, 2700, 1.2, 9.81  # m, kg/m3, kg/m3, m/s2
PIXELS = 1500  # across the picture
COLUMNS = ("step", "time", "particles", "kinetic energy", "pressure drop", "least void fraction", "volume",
           "momentum", "gas mass", "cpu")


def thermo(log):
    """All tables of the log, one after the other."""
    rows = []
    for line in log.splitlines():
        words = line.split()
        if len(words) == len(COLUMNS):
            try:
                rows.append([float(word) for word in words])
            except ValueError:
                pass
    return dict(zip(COLUMNS, np.array(rows).T))


def spheres(positions, values):
    """An image of spheres by their values, seen along the diagonal of the floor, from 35 degrees above it:
    each pixel shows the nearest sphere. (image of values, image of brightness), not a number where there is none."""
    turn, tilt = np.radians(30), np.radians(35)
    right = np.array([np.cos(turn), np.sin(turn), 0])
    away = np.array([-np.sin(turn) * np.cos(tilt), np.cos(turn) * np.cos(tilt), -np.sin(tilt)])
    up = np.cross(right, away)
    x, y, depth = positions @ right, positions @ up, positions @ away
    pixel = (x.max() - x.min() + 2 * DIAMETER) / PIXELS
    column, row = (x - x.min() + DIAMETER) / pixel, (y - y.min() + DIAMETER) / pixel
    shape = (int(row.max() + DIAMETER / pixel) + 1, PIXELS + 1)
    radius = DIAMETER / 2 / pixel
    nearest = np.full(shape[0] * shape[1], np.inf)
    shown, bright = np.full(nearest.size, np.nan), np.full(nearest.size, np.nan)
    reach = int(np.ceil(radius))
    for dj in range(-reach, reach + 1):
        for di in range(-reach, reach + 1):
            i, j = column.astype(int) + di, row.astype(int) + dj
            off = ((i + 0.5 - column)**2 + (j + 0.5 - row)**2) / radius**2  # of the pixel's centre from the sphere's
            seen = np.flatnonzero((off < 1) & (i >= 0) & (i < shape[1]) & (j >= 0) & (j < shape[0]))
            height = np.sqrt(1 - off[seen])
            place = j[seen] * shape[1] + i[seen]
            surface = depth[seen] - height * DIAMETER / 2
            order = np.argsort(-surface)  # the nearest is written last
            place, surface, seen, height = place[order], surface[order], seen[order], height[order]
            closer = surface < nearest[place]
            place, surface, seen, height = place[closer], surface[closer], seen[closer], height[closer]
            nearest[place], shown[place], bright[place] = surface, values[seen], height
    return shown.reshape(shape), bright.reshape(shape)


def draw_bed(results):
    data = np.loadtxt(results / "particles.txt", skiprows=9)
    shown, bright = spheres(data[:, :3], data[:, 3])
    most = np.percentile(np.abs(data[:, 3]), 99)
    colours = plt.get_cmap("coolwarm")(plt.Normalize(-most, most)(shown))
    colours[..., :3] *= (0.45 + 0.55 * np.nan_to_num(bright))[..., None]
    colours[np.isnan(shown)] = 1
    figure, axis = plt.subplots(figsize=(11, 11 * shown.shape[0] / shown.shape[1] + 1))
    axis.imshow(colours, origin="lower", interpolation="antialiased")
    axis.set_axis_off()
    axis.set_title(f"{len(data)} particles after {last_time(results):.3f} s")
    scale = plt.cm.ScalarMappable(plt.Normalize(-most, most), "coolwarm")
    figure.colorbar(scale, ax=axis, location="bottom", shrink=0.4, aspect=40, pad=0.02, label="vertical velocity, m/s")
    figure.savefig(results / "picture.png", dpi=90, bbox_inches="tight")


def last_time(results):
    return thermo((results / "log.liggghts").read_text())["time"][-1]


def parts_of(log):
    """{part: ns per particle-step} of the timed steps: the table of the last run but one, which only writes."""
    table = log[log.index("timed steps:"):]
    table = table[table.index("granflux: time of the run"):].partition("  total")[0]
    rows = re.findall(r"^  ([a-z][a-z ,]*?) {2,}-?[\d.]+ +-?[\d.]+ +(-?[\d.]+)", table, re.M)
    return {name: float(ns) for name, ns in rows}


def draw_plot(results):
    log = (results / "log.liggghts").read_text()
    t = thermo(log)
    width = float(re.search(r"^size = \[([\d.]+)", (results / case_of(log)).read_text(), re.M)[1])
    weight = t["particles"][-1] * np.pi / 6 * DIAMETER**3 * (DENSITY - GAS_DENSITY) * GRAVITY / width**2
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    left.plot(t["time"], t["pressure drop"], label="across the bed")
    left.axhline(weight, color="0.4", linestyle="--", label="weight of the bed over its floor")
    left.set_xlabel("time, s")
    left.set_ylabel("pressure drop, Pa")
    left.set_ylim(0, None)
    left.legend()
    parts = {name: ns for name, ns in parts_of(log).items() if ns >= 0.5}
    right.barh(list(parts)[::-1], list(parts.values())[::-1], color="tab:blue")
    right.set_xlabel("timed steps, ns per particle and step")
    figure.savefig(results / "plot.png", dpi=110)
    memory = re.search(r"peak memory .*", log)
    print(f"pressure drop at the end {t['pressure drop'][-1]:.1f} Pa, weight of the bed {weight:.1f} Pa; largest residuals: "
          f"void volume {t['volume'].max():.1e}, momentum {t['momentum'].max():.1e}, gas mass {t['gas mass'].max():.1e}; "
          + memory[0])


def case_of(log):
    return re.findall(r"granflux/couple case (\S+\.toml)", log)[-1]


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    draw_bed(folder)
    draw_plot(folder)
