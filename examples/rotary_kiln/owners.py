#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""owners.py RESULTS: owners.png, particles at the end of a run by the one of five workers that has each: the
owner of the gas block around it, a rank of LIGGGHTS' own division of space, a thread. Starts in.owners."""

import os
import subprocess
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

import kiln
from plot import MM, draw_particles, drum

WORKERS = 5
COLOURS = ListedColormap(["#e69f00", "#56b4e9", "#009e73", "#cc79a7", "#0072b2"])  # Okabe and Ito


def start(results, ranks):
    """Particles of each rank (n, 3), in the rank's order."""
    for old in (results / "post").glob("owners.*.txt"):
        old.unlink()
    command = ["mpirun", "--oversubscribe", "-np", str(ranks),
               "granflux", "-in", "in.owners", "-log", "log.owners", *sys.argv[2:]]
    with open(results / "owners.out", "w") as out:
        subprocess.run(command, cwd=results, check=True, stdout=out, env={**os.environ, "OMP_NUM_THREADS": "1"})
    rows = [(results / f"post/owners.{rank}.txt").read_text().splitlines()[9:] for rank in range(ranks)]
    return [np.array([row.split()[1:4] for row in of_rank], float).reshape(-1, 3) for of_rank in rows]


def by_gas_block(results, x):
    """Number of the block whose cell is nearest."""
    gas = kiln.gas(sorted((results / "post").glob("gas_*.cgns"))[-1])
    centres = np.stack([gas["x"], gas["y"], gas["z"]], axis=1)
    nearest = [np.argmin(((centres - part[:, None]) ** 2).sum(axis=2), axis=1)
               for part in np.array_split(x, 1 + len(x) // 500)]
    return gas["block"][np.concatenate(nearest)].astype(int)


def by_thread(count, threads=WORKERS):
    """As particle_subset::Subset has it: equal ranges of numbers, beginning at multiples of 8."""
    edges = [count * t // threads // 8 * 8 for t in range(threads)] + [count]
    return np.repeat(np.arange(threads), np.diff(edges))


def main(results):
    ranks = start(results, WORKERS)
    alone = start(results, 1)[0]
    space = np.concatenate([np.full(len(part), rank) for rank, part in enumerate(ranks)])
    block = by_gas_block(results, alone)
    panels = (("gas blocks", alone, block % WORKERS), ("LIGGGHTS' own, 5 ranks", np.concatenate(ranks), space),
              ("particle subsets, 5 threads", alone, by_thread(len(alone))))
    length = MM * (np.ptp(alone[:, 2]) + kiln.DIAMETER)
    figure, axes = plt.subplots(1, 6, figsize=(15, 5), sharey=True, layout="constrained",
                                gridspec_kw={"width_ratios": 3 * [160, max(length, 30)]})
    for axis, side, (title, x, owner) in zip(axes[::2], axes[1::2], panels):
        share = np.bincount(owner, minlength=WORKERS)
        drum(axis, f"{title}\nmost over mean {share.max() / share.mean():.2f}")
        spheres = draw_particles(axis, x, owner, (-0.5, WORKERS - 0.5), COLOURS)
        draw_particles(side, x[:, [2, 1, 0]], owner, (-0.5, WORKERS - 0.5), COLOURS)  # from the side
        side.set_aspect("equal")
        side.set_xlim(0, length)
        side.set_xlabel("z, mm")
        print(f"{title}: particles {', '.join(map(str, share))}; most over mean {share.max() / share.mean():.2f}")
    axes[0].set_ylabel("y, mm")
    bar = figure.colorbar(spheres, ax=axes, location="bottom", shrink=0.3, ticks=range(WORKERS), label="worker")
    bar.ax.tick_params(length=0)
    figure.savefig(results / "owners.png", dpi=110)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
