# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Dense packings: random points pushed apart until hardly anything overlaps, then squeezed."""

import random

import numpy as np

SOLIDS = {"planes": 0.55, "mesh": 0.55, "cylinder": 0.55, "periodic": 0.59}  # below the lid
SQUEEZE = 0.998  # of lengths, at the end
SWEEPS = 1500
STEP = 0.4  # of an overlap, that each sweep takes away
DIGITS = 8  # of a position in m


def packed_positions(container, radii):
    """Centres, m, of particles that rest on one another and the walls of the container; a lid, which
    the container does not have, holds them down meanwhile."""
    radii = np.array(radii)
    area = np.pi * container.width**2 / 4 if container.kind == "cylinder" else container.width**2
    lid = (4 / 3 * np.pi * radii**3).sum() / (SOLIDS[container.kind] * area)
    numbers = random.Random(4)
    half = 0.5 * container.width
    x = np.array([[numbers.uniform(-0.7, 0.7) * half, numbers.uniform(-0.7, 0.7) * half,
                   numbers.uniform(0.1, 0.9) * lid] for _ in radii])
    reach = radii[:, None] + radii[None, :]
    for _ in range(SWEEPS):
        apart = x[:, None, :] - x[None, :, :]
        if container.kind == "periodic":
            apart[..., :2] -= container.width * np.round(apart[..., :2] / container.width)
        distance = np.sqrt((apart**2).sum(axis=2))
        np.fill_diagonal(distance, np.inf)
        overlap = np.maximum(reach - distance, 0)
        push = 0.5 * (overlap / distance)[..., None] * apart
        x += STEP * (push.sum(axis=1) + _push_of_walls(container, x, radii, lid))
    if container.kind == "periodic":
        x[:, :2] -= container.width * np.round(x[:, :2] / container.width)
        x[:, 2] *= SQUEEZE
    else:
        x *= SQUEEZE
    return [tuple(round(float(c), DIGITS) for c in point) for point in x]


def _push_of_walls(container, x, radii, lid):
    push = np.zeros_like(x)
    push[:, 2] = np.maximum(radii - x[:, 2], 0) - np.maximum(x[:, 2] + radii - lid, 0)
    half = 0.5 * container.width
    if container.kind == "cylinder":
        distance = np.sqrt((x[:, :2] ** 2).sum(axis=1))
        outside = np.maximum(distance + radii - half, 0)
        push[:, :2] -= (outside / np.maximum(distance, 1e-12))[:, None] * x[:, :2]
    elif container.kind != "periodic":
        for axis in (0, 1):
            push[:, axis] += np.maximum(radii - half - x[:, axis], 0)
            push[:, axis] -= np.maximum(x[:, axis] + radii - half, 0)
    return push
