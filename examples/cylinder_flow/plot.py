#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py RESULTS REYNOLDS: drag, wake and frequency of shedding of a run against published numbers;
draws picture.png. Exits with 1 where one of them is off by more than it may be."""

import csv
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import h5py
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.tri import CubicTriInterpolator, Triangulation

DEPTH = 0.1  # m, of the grid
# Published: drag coefficient, length of the wake in radii; then amplitude of the lift coefficient and
# Strouhal number. Each with what this grid may differ by.
PUBLISHED = {20: {"Cd": (2.091, 0.03), "La/R": (1.86, 0.05)},
             40: {"Cd": (1.565, 0.03), "La/R": (4.62, 0.08)},
             100: {"Cd": (1.364, 0.03), "Cl": (0.344, 0.06), "St": (0.1645, 0.02)}}


def ring(path):
    """Radius r (n), angle t (m) and fields (m, n) of a ring one cell deep, its blocks put together."""
    columns = {}
    with h5py.File(path, "r") as file:
        base = next(v for v in file.values() if v.attrs.get("label", b"").startswith(b"CGNSBase"))
        for zone in base.values():
            if not zone.attrs.get("label", b"").startswith(b"Zone_t"):
                continue
            nodes = {axis: zone["GridCoordinates"]["Coordinate" + axis][" data"][0] for axis in "XY"}
            for axis, at in nodes.items():
                centre = 0.25 * (at[1:, 1:] + at[1:, :-1] + at[:-1, 1:] + at[:-1, :-1])
                columns.setdefault(axis, []).append(centre.ravel())
            radius = np.hypot(nodes["X"], nodes["Y"])  # wider cells have their centres further in
            columns.setdefault("radius", []).append((0.5 * (radius[:-1, 1:] + radius[:-1, :-1])).ravel())
            for name in ("VelocityX", "VelocityY", "Pressure"):
                columns.setdefault(name, []).append(zone["FlowSolution"][name][" data"][0].ravel())
    data = {name: np.concatenate(parts) for name, parts in columns.items()}
    r = np.round(data["radius"], 7)
    t = np.round(np.mod(np.arctan2(data["Y"], data["X"]), 2 * np.pi), 7)
    order = np.lexsort((r, t))
    radii = np.unique(r)
    return radii, t[order][:: radii.size], {name: values[order].reshape(-1, radii.size)
                                            for name, values in data.items()}


def vorticity(r, t, data):
    """(d(r u_t)/dr - du_r/dt) / r, 1/s."""
    c, s = np.cos(t)[:, None], np.sin(t)[:, None]
    radial = c * data["VelocityX"] + s * data["VelocityY"]
    around = c * data["VelocityY"] - s * data["VelocityX"]
    closed = np.vstack([radial[-1], radial, radial[0]])
    angles = np.r_[t[-1] - 2 * np.pi, t, t[0] + 2 * np.pi]
    return (np.gradient(r * around, r, axis=1) - np.gradient(closed, angles, axis=0)[1:-1]) / r


def wake_length(r, t, data):
    """Radii from the rear of the cylinder to where the gas on the axis behind it stands still."""
    u = data["VelocityX"]
    near, far = 0.5 * (u[0] + u[-1]), 0.5 * (u[1] + u[-2])
    axis = (t[1] ** 2 * near - t[0] ** 2 * far) / (t[1] ** 2 - t[0] ** 2)  # a parabola of the angle
    i = np.flatnonzero((axis[:-1] < 0) & (axis[1:] >= 0))
    if i.size == 0:
        return 0.0
    i = i[0]
    return ((r[i] - axis[i] * (r[i + 1] - r[i]) / (axis[i + 1] - axis[i])) - 0.5) / 0.5


def coefficients(path):
    """Time, drag and lift coefficient of all steps."""
    with open(path) as file:
        rows = list(csv.reader(file))
    at = [rows[0].index(name) for name in ("time", "inner x", "inner y")]
    time, fx, fy = np.array([[float(row[i]) for i in at] for row in rows[1:]]).T
    return time, fx / (0.5 * DEPTH), fy / (0.5 * DEPTH)


def measure(reynolds, r, t, data, time, drag, lift):
    if reynolds < 50:
        return {"Cd": drag[-1], "La/R": wake_length(r, t, data)}, (time[-1], time[-1])
    up = np.flatnonzero((lift[:-1] < 0) & (lift[1:] >= 0))
    zero = time[up] - lift[up] * (time[up + 1] - time[up]) / (lift[up + 1] - lift[up])
    periods = min(4, zero.size - 1)
    if periods < 1:
        sys.exit("the wake does not shed yet: run for longer")
    last = slice(up[-1 - periods] + 1, up[-1] + 1)
    return ({"Cd": drag[last].mean(), "Cl": 0.5 * np.ptp(lift[last]),
             "St": periods / (zero[-1] - zero[-1 - periods])}, (zero[-1 - periods], zero[-1]))


def on_grid(r, t, data, names, x, y):
    """Fields on a straight grid, the cylinder cut out."""
    near = r < 1.5 * max(np.abs(x).max(), np.abs(y).max())
    px = np.r_[data["X"][:, near].ravel(), 0.5 * np.cos(t)]
    py = np.r_[data["Y"][:, near].ravel(), 0.5 * np.sin(t)]
    mesh = Triangulation(px, py)
    xx, yy = np.meshgrid(x, y)
    out = []
    for name in names:
        at_wall = np.zeros(t.size) if name.startswith("Velocity") else data[name][:, 0]
        values = CubicTriInterpolator(mesh, np.r_[data[name][:, near].ravel(), at_wall], kind="geom")(xx, yy)
        out.append(np.ma.masked_where(np.hypot(xx, yy) < 0.5, values))
    return out


def draw(path, reynolds, r, t, data, time, drag, lift, measured, span):
    figure = plt.figure(figsize=(12, 8), layout="constrained")
    axes = figure.subplot_mosaic([["wake", "wake"], ["near", "forces"]], width_ratios=[1, 1],
                                 height_ratios=[1.15, 1])
    data["vorticity"] = vorticity(r, t, data)

    wake = axes["wake"]
    x, y = np.linspace(-1.8, 12.2, 840), np.linspace(-2.25, 2.25, 270)
    (turn,) = on_grid(r, t, data, ["vorticity"], x, y)
    levels = np.r_[-np.linspace(0.1, 3.1, 13)[::-1], np.linspace(0.1, 3.1, 13)]
    colours = wake.contourf(x, y, turn, levels, cmap="RdBu_r", extend="both")
    wake.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), xlabel="x, m", ylabel="y, m",
             title=f"Re = {reynolds}: vorticity at t = {time[-1]:.0f} s")
    figure.colorbar(colours, ax=wake, label="vorticity, 1/s", pad=0.01,
                    ticks=[-2.6, -1.6, -0.6, 0.6, 1.6, 2.6])

    near = axes["near"]
    x, y = np.linspace(-1.5, 4, 360), np.linspace(-1.75, 1.75, 240)
    u, v = on_grid(r, t, data, ["VelocityX", "VelocityY"], x, y)
    colours = near.contourf(x, y, np.hypot(u, v), np.linspace(0, 1.5, 16), cmap="viridis", extend="max")
    near.streamplot(x, y, u, v, color="w", linewidth=0.7, density=1.5, arrowsize=0.7,
                    broken_streamlines=True)
    near.set(xlim=(x[0], x[-1]), ylim=(y[0], y[-1]), xlabel="x, m", ylabel="y, m",
             title="streamlines at the cylinder")
    figure.colorbar(colours, ax=near, label="speed, m/s", ticks=[0, 0.5, 1, 1.5], pad=0.02,
                    location="bottom", shrink=0.7)
    for axis in (wake, near):
        axis.set_aspect("equal")
        axis.add_patch(plt.Circle((0, 0), 0.5, fc="0.75", ec="k", lw=0.8, zorder=3))

    forces = axes["forces"]
    published = PUBLISHED[reynolds]
    forces.plot(time, drag, "C0", label="drag")
    forces.plot(time, lift, "C3", lw=1, label="lift")
    forces.axhline(published["Cd"][0], color="k", ls="--", lw=0.9, label="published")
    if "Cl" in published:
        for sign in (-1, 1):
            forces.axhline(sign * published["Cl"][0], color="k", ls="--", lw=0.9)
        forces.axvspan(*span, color="0.92", zorder=0, label="measured over")
    high = 1.25 * published["Cd"][0]
    forces.set(xlim=(0, time[-1]), xlabel="time, s", ylabel="coefficient",
               ylim=(-0.6 if "Cl" in published else -0.05 * high, high))
    forces.set_title(",  ".join(f"{name} {value:.3f}" for name, value in measured.items()) + "\npublished: "
                     + ",  ".join(f"{name} {published[name][0]:g}" for name in measured), fontsize=11)
    forces.legend(frameon=False, ncols=2, loc="center", bbox_to_anchor=(0.5, 0.59))
    figure.savefig(path, dpi=110)


def main():
    results, reynolds = Path(sys.argv[1]), int(sys.argv[2])
    r, t, data = ring(sorted(results.glob("gas_*.cgns"))[-1])
    time, drag, lift = coefficients(results / "forces.csv")
    measured, span = measure(reynolds, r, t, data, time, drag, lift)
    print(f"\ncylinder, Re = {reynolds}: {r.size} x {t.size} cells")
    good = True
    for name, value in measured.items():
        wanted, allowed = PUBLISHED[reynolds][name]
        off = value / wanted - 1
        fits = abs(off) <= allowed
        good = good and fits
        print(f"  {'PASS' if fits else 'FAIL'}: {name} {value:.4f}, published {wanted:g}: {100 * off:+.1f} % "
              f"(limit {100 * allowed:.0f} %)")
    draw(results / "picture.png", reynolds, r, t, data, time, drag, lift, measured, span)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
