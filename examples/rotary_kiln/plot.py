#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""plot.py RESULTS: pictures of a run of the kiln, and what its books say.

picture.png   particles by temperature at four times
gas.png       stream lines and temperature of the gas at the end
heat.png      mean temperature of the bed and heat to it by conduction and convection, against time
motion.png    the bed's flow and surface, and its energy of motion against time
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection
from matplotlib.tri import LinearTriInterpolator, Triangulation

import kiln

MM = 1e3
BLUE, ORANGE, GREEN, PINK, GREY = "#0072b2", "#e69f00", "#009e73", "#cc79a7", "0.4"  # Okabe and Ito


def drum(axis, title=None):
    """The outline of the drum, millimetres, and where it turns to."""
    axis.add_patch(plt.Circle((0, 0), MM * kiln.RADIUS, fill=False, color="k", lw=1))
    axis.annotate("", xytext=(54, -61), xy=(65.5, -47),
                  arrowprops={"arrowstyle": "->", "connectionstyle": "arc3,rad=0.12", "color": "k"})
    axis.set_aspect("equal")
    axis.set_xlim(-80, 80)
    axis.set_ylim(-80, 80)
    axis.set_xlabel("x, mm")
    axis.set_title(title)


def draw_particles(axis, x, values, limits, cmap):
    """Spheres seen along the axis, those in front drawn last."""
    order = np.argsort(x[:, 2])
    size = MM * kiln.DIAMETER
    spheres = EllipseCollection(size, size, 0, units="xy", offsets=MM * x[order, :2], transOffset=axis.transData,
                                array=values[order], cmap=cmap, linewidths=0)
    spheres.set_clim(*limits)
    axis.add_collection(spheres)
    return spheres


def draw_picture(results, chosen):
    figure, axes = plt.subplots(1, 4, figsize=(15, 4.9), sharey=True, layout="constrained")
    warmest = max(np.percentile(frame.temperature, 99.5) for frame in chosen)
    limits = kiln.COLD, max(warmest, kiln.COLD + 0.1)
    for axis, frame in zip(axes, chosen):
        drum(axis, f"t = {frame.time:.2f} s")
        spheres = draw_particles(axis, frame.x, frame.temperature, limits, "inferno")
    axes[0].set_ylabel("y, mm")
    figure.colorbar(spheres, ax=axes, location="bottom", shrink=0.4, aspect=40, extend="max",
                    label="temperature of the particles, K")
    figure.savefig(results / "picture.png", dpi=110)


def middle_plane(gas):
    """Velocity and temperature of the gas, means of the cells along the axis and values of the wall, on a plane of
    squares; NaN outside."""
    place = np.round(np.stack([gas["x"], gas["y"]], axis=1), 9)
    points, which = np.unique(place, axis=0, return_inverse=True)
    count = np.bincount(which)
    outermost = points[np.hypot(*points.T) > 0.92 * kiln.RADIUS]  # cells at the wall
    angle = np.arctan2(outermost[:, 1], outermost[:, 0])
    wall = kiln.RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    triangles = Triangulation(*np.concatenate([points, wall]).T)
    line = np.linspace(-kiln.RADIUS, kiln.RADIUS, 201)
    X, Y = np.meshgrid(line, line)
    at_wall = {"VelocityX": -kiln.OMEGA * wall[:, 1], "VelocityY": kiln.OMEGA * wall[:, 0],
               "Temperature": np.full(len(wall), kiln.HOT)}
    return line, {name: LinearTriInterpolator(triangles, np.append(np.bincount(which, gas[name]) / count, values))(X, Y)
                  .filled(np.nan) for name, values in at_wall.items()}


def draw_gas(results, bed):
    gas = kiln.gas(sorted((results / "post").glob("gas_*.cgns"))[-1])
    line, fields = middle_plane(gas)
    figure, axes = plt.subplots(1, 2, figsize=(12, 5.8), sharey=True, layout="constrained")
    speed = MM * np.hypot(fields["VelocityX"], fields["VelocityY"])
    drawn = [axes[0].pcolormesh(MM * line, MM * line, speed, cmap="viridis", vmin=0, shading="gouraud"),
             axes[1].pcolormesh(MM * line, MM * line, fields["Temperature"], cmap="inferno", shading="gouraud",
                                vmin=kiln.COLD, vmax=kiln.HOT)]
    axes[0].streamplot(MM * line, MM * line, fields["VelocityX"], fields["VelocityY"], color="w", density=1.6,
                       linewidth=0.8, arrowsize=0.8)
    surface = MM * bed.surface()
    for axis, mesh, label in zip(axes, drawn, ("speed of the gas across the axis, mm/s", "temperature of the gas, K")):
        drum(axis)
        axis.plot(*surface.T, color="w" if mesh is drawn[0] else "c", ls="--", lw=1.5, label="surface of the bed")
        figure.colorbar(mesh, ax=axis, location="bottom", shrink=0.8, aspect=40, label=label)
    axes[1].legend(loc="upper right")
    axes[0].set_ylabel("y, mm")
    figure.suptitle(f"gas, mean along the axis, t = {gas['time']:.2f} s")
    figure.savefig(results / "gas.png", dpi=110)


def draw_heat(results, table, particles):
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 7), sharex=True, layout="constrained")
    share = (table["mean"] - kiln.COLD) / (kiln.HOT - kiln.COLD)
    above.plot(table["time"], table["mean"], color=BLUE)
    above.set_ylabel("mean temperature of the bed, K")
    right = above.secondary_yaxis("right", functions=(lambda t: (t - kiln.COLD) / 75, lambda s: kiln.COLD + 75 * s))
    right.set_ylabel("(T - 298 K)/75 K")
    above.set_title(f"{share[-1]:.5f} of the way to the wall's temperature after {table['time'][-1]:.1f} s")
    area = particles * np.pi * kiln.DIAMETER**2
    for name, label, colour in (("gas W", "convection from the gas", BLUE),
                                ("walls W", "conduction from the wall", ORANGE),
                                ("friction W", "friction", GREEN), ("damping W", "damping", PINK)):
        below.plot(table["time"][1:], table[name][1:] / area, color=colour, label=label, lw=1)
    below.set_yscale("log")
    below.set_xlabel("time, s")
    below.set_ylabel("heat to the particles, W/m2")
    below.legend(ncol=2)
    figure.savefig(results / "heat.png", dpi=110)


def left_over(table, terms, springs):
    """Energy of motion that is not accounted for, at the times of the frames [J]: (times, energies)."""
    at = np.searchsorted(table["step"], springs.steps[springs.steps <= table["step"][-1]])
    gained = sum(terms[name][at] for name in ("kinetic", "height", "friction", "damping"))
    springs_gained = springs.energy[: len(at)] - springs.energy[0]
    return table["time"][at], terms["walls"][at] + terms["gas"][at] - gained - springs_gained


def draw_motion(results, table, bed, terms, open_):
    figure, (left, right) = plt.subplots(1, 2, figsize=(13, 5.6), layout="constrained")
    vx, vy = bed.velocity()
    dense = bed.solids() > 0.1
    X, Y = np.meshgrid(bed.centres, bed.centres, indexing="ij")
    arrows = left.quiver(MM * X[dense], MM * Y[dense], MM * vx[dense], MM * vy[dense], MM * np.hypot(vx, vy)[dense],
                         cmap="viridis", scale=6000, width=2.5e-3)
    figure.colorbar(arrows, ax=left, label="speed of the particles, mm/s")
    left.plot(*MM * bed.surface().T, color="k", lw=1.5, label="surface")
    drum(left, f"mean flow; surface at {bed.angle():.1f} degrees in the middle")
    left.set_ylabel("y, mm")
    left.legend(loc="upper left")
    t = table["time"]
    lines = (("walls", "work of the walls", BLUE), ("friction", "turned into heat by friction", ORANGE),
             ("damping", "by damping", PINK), ("height", "gained in height", GREEN),
             ("kinetic", "gained in speed", GREY))
    for name, label, colour in lines:
        right.plot(t, MM * terms[name], color=colour, label=label)
    right.plot(open_[0], MM * open_[1], "kx", label="not accounted for")
    right.set_xlabel("time, s")
    right.set_ylabel("energy of motion since the start, mJ")
    right.legend()
    figure.savefig(results / "motion.png", dpi=110)


def main(results):
    table = kiln.thermo(results / "log.liggghts")
    steady = 0.5 * table["time"][-1]
    wanted = np.linspace(0.25, 1, 4) * table["time"][-1]
    chosen, bed = [None] * 4, kiln.MeanBed()
    for frame in kiln.frames(results / "post/particles.txt"):
        particles = len(frame.x)
        for n, time in enumerate(wanted):
            if chosen[n] is None or abs(frame.time - time) < abs(chosen[n].time - time):
                chosen[n] = frame
        if frame.time >= steady:
            bed.add(frame)
    draw_picture(results, chosen)
    draw_gas(results, bed)
    draw_heat(results, table, particles)
    terms = kiln.mechanics(table, particles)
    springs = kiln.Springs(results / "post")
    open_ = left_over(table, terms, springs)
    draw_motion(results, table, bed, terms, open_)

    received = sum(table[name][-1] for name in ("walls", "friction", "damping", "gas"))
    late = table["time"] >= steady
    power = np.polyfit(table["time"][late], terms["walls"][late], 1)[0]
    print(f"{particles} particles, {table['time'][-1]:.2f} s at Froude number {kiln.FROUDE:.4f}; "
          f"means of the second half:")
    print(f"  surface of the bed at {bed.angle():.1f} degrees, walls do {1e3 * power:.1f} mW of work")
    print(f"  mean temperature of the bed {table['mean'][-1]:.4f} K; Biot number {table['biot'].mean():.2e}, "
          f"largest {table['largest biot'].max():.2e}")
    convection = table["gas"][-1] / (table["gas"][-1] + table["walls"][-1])
    print(f"  heat to the bed {received:.4f} J; {100 * convection:.1f} % of what the wall gives comes through the gas")
    print(f"  heat not accounted for: particles {abs(table['open'][-1]) / received:.1e} of it; largest "
          f"residuals of heat handed over {table['handed over'].max():.1e}, "
          f"of the gas's heat {table['gas residual'].max():.1e}")
    work = terms["walls"][np.searchsorted(table["time"], open_[0][-1] - 1e-9)]
    print(f"  energy of motion not accounted for: {open_[1][-1] / work:.1e} of the walls' work of {1e3 * work:.2f} mJ; "
          f"springs hold {1e3 * springs.energy[-1]:.3f} mJ")
    print(f"  overlaps of {springs.contacts[-1]} contacts: mean {springs.mean[-1]:.1e} of a diameter, "
          f"largest ever found {springs.largest.max():.1e}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
