#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""void_profile.py RESULTS [--from SECONDS] [--timestep S]: time-averaged void fraction across the bed
at 16.4 and 31.2 mm from RESULTS/post/profile.txt, against the magnetic-resonance measurements at
U = 0.6 m/s. Writes profile.csv, profile.json and profile.png into RESULTS."""

import argparse
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import bed

HERE = Path(__file__).resolve().parent
HEIGHTS = (16.4, 31.2)  # mm
TARGET = {16.4: 0.06, 31.2: 0.08}  # root mean square error asked for


def measured(height, who):
    return np.loadtxt(HERE / f"measurements/mueller_U06_y{height}_{who}_void.csv", delimiter=",",
                      skiprows=2)


def error(x, void, points):
    """Root mean square and mean difference at the measured points, by linear interpolation."""
    difference = np.interp(points[:, 0], x, void) - points[:, 1]
    return float(np.sqrt(np.mean(difference**2))), float(difference.mean())


def block_error(profiles, blocks=5):
    """Standard error of a time average, from the scatter of the means of `blocks` parts of it."""
    parts = [part.mean(axis=0) for part in np.array_split(profiles, blocks)]
    return np.std(parts, axis=0, ddof=1) / np.sqrt(blocks)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", type=Path)
    parser.add_argument("--from", dest="start", type=float, default=2.0, help="s, begin of averaging")
    parser.add_argument("--timestep", type=float, default=5e-6, help="s, of the particles")
    options = parser.parse_args()

    edges = np.linspace(0, bed.WIDTH, 26)
    x = 0.5 * (edges[1:] + edges[:-1])
    profiles = {height: [] for height in HEIGHTS}
    times = []
    for step, position in bed.frames(options.results / "post/profile.txt"):
        if step * options.timestep < options.start:
            continue
        times.append(step * options.timestep)
        for height in HEIGHTS:
            profiles[height].append(bed.void_profile(position, height * 1e-3, edges))

    result = {"averaged_from_s": times[0], "averaged_to_s": times[-1], "samples": len(times)}
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.6), sharey=True, layout="constrained")
    table = [x]
    for axis, height in zip(axes, HEIGHTS):
        series = np.array(profiles[height])
        mean, scatter = series.mean(axis=0), block_error(series)
        table += [mean, scatter]
        experiment = measured(height, "exp")
        rmse, bias = error(x, mean, experiment)
        result[f"{height} mm"] = {"rmse": rmse, "bias": bias, "target_rmse": TARGET[height],
                                  "statistical_error_mean": float(scatter.mean()),
                                  "chord_mean": float(mean.mean())}
        axis.fill_between(1e3 * x, mean - 2 * scatter, mean + 2 * scatter, alpha=0.25)
        axis.plot(1e3 * x, mean, label="GranFlux (band: two standard errors)")
        axis.plot(1e3 * experiment[:, 0], experiment[:, 1], "ko", ms=4, label="measured (MRI)")
        for who, style in (("sedifoam", ":"), ("muellerDEM", "--")):
            other = measured(height, who)
            axis.plot(1e3 * other[:, 0], other[:, 1], style, color="0.5", label=who)
        axis.set_title(f"{height} mm above the distributor: RMSE {rmse:.3f}, bias {bias:+.3f}")
        axis.set_xlabel("x, mm")
    axes[0].set_ylabel("void fraction")
    axes[0].legend()
    figure.savefig(options.results / "profile.png", dpi=110)
    np.savetxt(options.results / "profile.csv", np.column_stack(table), delimiter=",", fmt="%.5f",
               header="x_m,void_16.4mm,standard_error,void_31.2mm,standard_error", comments="")
    (options.results / "profile.json").write_text(json.dumps(result, indent=2) + "\n")
    print(json.dumps(result, indent=2))


if __name__ == "__main__":
    main()
