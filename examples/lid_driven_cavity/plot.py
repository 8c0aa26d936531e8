#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py RESULTS REYNOLDS: compares the last fields of a run with reference.csv and draws
picture.png. Exits with 1 where a point is off by more than LIMIT."""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np

LIMIT = 5e-3  # of the lid's speed
STEADY = 1e-3  # change between the last two files, which lie one unit of time apart


def plane(path):
    """Centres x (n), z (m) and fields (m, n) of a box one cell deep, its blocks put together."""
    parts = []
    with h5py.File(path, "r") as file:
        base = next(v for v in file.values() if v.attrs.get("label", b"").startswith(b"CGNSBase"))
        for zone in base.values():
            if not zone.attrs.get("label", b"").startswith(b"Zone_t"):
                continue
            nodes = zone["GridCoordinates"]
            x = nodes["CoordinateX"][" data"][0, 0, :]
            z = nodes["CoordinateZ"][" data"][:, 0, 0]
            fields = {name: field[" data"][:, 0, :] for name, field in zone["FlowSolution"].items()
                      if isinstance(field, h5py.Group) and " data" in field and name != "GridLocation"}
            parts.append((0.5 * (x[1:] + x[:-1]), 0.5 * (z[1:] + z[:-1]), fields))
    xs = np.unique(np.concatenate([p[0] for p in parts]))
    zs = np.unique(np.concatenate([p[1] for p in parts]))
    whole = {name: np.empty((zs.size, xs.size)) for name in parts[0][2]}
    for x, z, fields in parts:
        i, k = np.searchsorted(xs, x[0]), np.searchsorted(zs, z[0])
        for name, values in fields.items():
            whole[name][k : k + z.size, i : i + x.size] = values
    return xs, zs, whole


def middle(x, values):
    """Values (m, n) on the line halfway along x (n)."""
    i = np.searchsorted(x, 0.5)
    weight = (0.5 - x[i - 1]) / (x[i] - x[i - 1])
    return (1 - weight) * values[:, i - 1] + weight * values[:, i]


def cubic(x, values, at):
    """The cubic through the four nearest samples."""
    first = np.clip(np.searchsorted(x, at) - 2, 0, x.size - 4)
    total = 0.0
    for i in range(first, first + 4):
        others = [j for j in range(first, first + 4) if j != i]
        total += values[i] * np.prod([(at - x[j]) / (x[i] - x[j]) for j in others])
    return total


def reference(reynolds):
    """Points inside the cavity by line: coordinate (a multiple of 1/128) and value."""
    rows = csv.DictReader(line for line in open("reference.csv") if not line.startswith("#"))
    points = {"U": [], "V": []}
    for row in rows:
        coordinate = round(float(row["coord"]) * 128) / 128
        if int(row["Re"]) == reynolds and 0 < coordinate < 1:
            points[row["line"]].append((coordinate, float(row["recomputed"])))
    return {line: np.array(p).T for line, p in points.items()}


def draw(path, reynolds, x, z, fields, lines, points, worst):
    figure, (flow, profile) = plt.subplots(1, 2, figsize=(12.5, 5.6), layout="constrained")
    u, w = fields["VelocityX"], fields["VelocityZ"]
    colours = flow.contourf(x, z, np.hypot(u, w), np.linspace(0, 1, 21), cmap="viridis")
    even = np.linspace(0.003, 0.997, 300)

    def on_even(values):
        rows = np.array([np.interp(even, x, row) for row in values])
        return np.array([np.interp(even, z, column) for column in rows.T]).T

    # Contours of the streamfunction are closed lines, corners included.
    psi = np.cumsum(on_even(u), axis=0) * (even[1] - even[0])
    for levels, width in ((np.linspace(psi.min(), -2e-3, 12), 0.8), ([-1e-4, 1e-5, 2e-4, 8e-4], 0.6)):
        flow.contour(even, even, psi - psi[0], np.unique(levels), colors="w", linewidths=width,
                     linestyles="solid")
    figure.colorbar(colours, ax=flow, label="speed, m/s", ticks=np.linspace(0, 1, 6), pad=0.02)
    flow.annotate("", (0.7, 1.035), (0.3, 1.035), annotation_clip=False,
                  arrowprops={"arrowstyle": "-|>", "lw": 1.5, "color": "k"})
    flow.set(aspect="equal", xlim=(0, 1), ylim=(0, 1), xlabel="x, m", ylabel="z, m")
    flow.set_title(f"lid, 1 m/s; Re = {reynolds}", pad=16)

    profile.plot(lines["U"][0], lines["U"][1], "C0", label="along the lid, on x = 0.5 against z")
    profile.plot(lines["V"][0], lines["V"][1], "C3", label="upwards, on z = 0.5 against x")
    profile.plot(*points["U"], "o", mfc="none", mec="k", ms=5, label="independent solution")
    profile.plot(*points["V"], "o", mfc="none", mec="k", ms=5)
    profile.axhline(0, color="0.8", lw=0.8, zorder=0)
    profile.set(xlim=(0, 1), ylim=(-0.65, 1.05), xlabel="coordinate, m", ylabel="velocity, m/s")
    profile.set_title(f"largest difference {worst:.1e} m/s")
    profile.legend(frameon=False, loc="upper left")
    figure.savefig(path, dpi=110)


def main():
    results, reynolds = Path(sys.argv[1]), int(sys.argv[2])
    before, last = sorted(results.glob("gas_*.cgns"))[-2:]
    x, z, fields = plane(last)
    _, _, old = plane(before)
    change = max(np.abs(fields[name] - old[name]).max() for name in ("VelocityX", "VelocityZ"))
    lines = {"U": (np.r_[0, z, 1], np.r_[0, middle(x, fields["VelocityX"]), 1]),
             "V": (np.r_[0, x, 1], np.r_[0, middle(z, fields["VelocityZ"].T), 0])}
    points = reference(reynolds)
    worst = 0
    print(f"\nlid-driven cavity, Re = {reynolds}: {x.size} x {z.size} cells")
    for line, name in (("U", "u on x = 0.5"), ("V", "v on z = 0.5")):
        off = [cubic(*lines[line], c) - value for c, value in zip(*points[line])]
        at = np.argmax(np.abs(off))
        worst = max(worst, abs(off[at]))
        print(f"  {name}: {len(off)} points, largest difference {off[at]:+.1e} at {points[line][0][at]:.4f}")
    good = worst <= LIMIT and change <= STEADY
    print(f"  change over the last second {change:.1e} m/s (limit {STEADY:.0e})")
    print(f"  {'PASS' if good else 'FAIL'}: within {worst:.1e} of the independent solution "
          f"(limit {LIMIT:.0e} of the lid's speed)")
    draw(results / "picture.png", reynolds, x, z, fields, lines, points, worst)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
