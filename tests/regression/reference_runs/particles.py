# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Particles at the start of a case, as a data file of LIGGGHTS.

Everything is had from Python's own generator and sums of doubles, so that every machine makes the same
numbers; dense packings are read from the references.
"""

import random

COUNT = 200
RADIUS = 1e-3  # m
SPREAD = 0.25  # of the radii of unequal particles, either side
DENSITY = 2500.0  # kg/m3
NEAREST = 0.98  # of the sum of radii: in a dilute case some pairs touch at the start
SPEED = {"dense": 0.1, "dilute": 1.0}  # m/s, largest in each direction
SPIN = {"dense": 50.0, "dilute": 200.0}  # rad/s
FROZEN_EVERY = 9  # particles


def radii_of(case):
    numbers = random.Random(1)
    if case.sizes == "equal":
        return [RADIUS] * COUNT
    return [RADIUS * numbers.uniform(1 - SPREAD, 1 + SPREAD) for _ in range(COUNT)]


def dilute_positions(container, radii):
    numbers = random.Random(2)
    half = 0.5 * container.width
    placed = []
    for radius in radii:
        while True:
            room = half - radius
            x, y = numbers.uniform(-room, room), numbers.uniform(-room, room)
            z = numbers.uniform(radius, container.height - radius)
            outside = container.kind == "cylinder" and x * x + y * y > room * room
            if not outside and all(
                (x - p) ** 2 + (y - q) ** 2 + (z - r) ** 2 > (NEAREST * (radius + other)) ** 2
                for (p, q, r), other in zip(placed, radii)
            ):
                placed.append((x, y, z))
                break
    return placed


def data_file(case, container, positions):
    """Text for read_data: particles with radii, types by turns, random velocities and spins.

    Frozen ones rest. LIGGGHTS takes the first one's mass for the contact of two frozen particles, and
    which is first depends on the neighbour list; at rest there is nothing to damp or to remember."""
    numbers = random.Random(3)
    speed, spin = SPEED[case.density], SPIN[case.density]
    box = "".join(f"{low:.9g} {high:.9g} {axis}lo {axis}hi\n" for axis, (low, high) in zip("xyz", container.box))
    atoms, velocities = [], []
    for i, ((x, y, z), radius) in enumerate(zip(positions, radii_of(case)), 1):
        kind = 1 + i % case.type_count
        atoms.append(f"{i} {kind} {2 * radius!r} {DENSITY} {x!r} {y!r} {z!r}\n")
        motion = [numbers.uniform(-size, size) for size in (speed,) * 3 + (spin,) * 3]
        if case.frozen == "yes" and (i - 1) % FROZEN_EVERY == 0:
            motion = [0.0] * 6
        velocities.append(f"{i} " + " ".join(repr(value) for value in motion) + "\n")
    return (f"Particles of case {case.name}\n\n{len(atoms)} atoms\n{case.type_count} atom types\n{box}\n"
            f"Atoms\n\n{''.join(atoms)}\nVelocities\n\n{''.join(velocities)}")
