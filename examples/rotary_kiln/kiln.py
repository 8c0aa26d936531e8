# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the files of a run of the kiln and works out what its books say. SI units."""

from pathlib import Path

import numpy as np

RADIUS, DIAMETER, DENSITY = 76.2e-3, 2e-3, 3900.0
MASS = np.pi / 6 * DENSITY * DIAMETER**3
CAPACITY, COLD, HOT = 875.0, 298.0, 373.0  # J/(kg K), K
GRAVITY, OMEGA = 9.81, 2 * np.pi / 60 * 20  # m/s2, rad/s
DT, COUPLE_EVERY, STIFFNESS = 2.5e-5, 40, 1000.0  # of in.drum and in.kiln: s, steps, N/m
FROUDE = OMEGA**2 * RADIUS / GRAVITY

# in.kiln's thermo_style. Heat: W and, since time 0, J.
COLUMNS = (
    "step", "time", "mean", "lowest", "highest", "biot", "largest biot",
    "walls W", "friction W", "damping W", "gas W", "into walls W",
    "walls", "friction", "damping", "gas", "into walls", "open", "heat",
    "gas residual", "handed over", "walls to gas W", "void fraction", "momentum residual", "gas momentum residual",
    "motion", "spin", "x", "y", "angular momentum", "gas power", "gas torque",
    "mean x", "mean gas power", "mean gas torque", "cpu",
)  # fmt: skip


def thermo(log):
    """The table of the run with gas: {column: values}."""
    rows = []
    for line in Path(log).read_text().splitlines():
        words = line.split()
        if words[:1] == ["Step"]:
            rows = []
        elif len(words) == len(COLUMNS) and words[0].isdigit():
            rows.append([float(word) for word in words])
    return dict(zip(COLUMNS, np.array(rows).T))


class Frame:
    """Particles at one time: x (n, 3), v (n, 3), temperature, from_particles, from_walls, received (W)."""

    def __init__(self, step, rows):
        self.step, self.time = step, step * DT
        self.x, self.v = rows[:, 1:4], rows[:, 4:7]
        self.temperature, self.from_particles, self.from_walls, self.received = rows[:, 7:11].T


def tables(path):
    """(step, rows) of a dump, one frame after the other."""
    with open(path) as file:
        while line := file.readline():
            if line.startswith("ITEM: TIMESTEP"):
                step = int(file.readline())
            elif line.startswith("ITEM: NUMBER OF"):
                count = int(file.readline())
            elif line.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")):
                yield step, np.loadtxt(file, max_rows=count, ndmin=2) if count else np.empty((0, 0))


def frames(path):
    """Every frame of post/particles.txt, one after the other."""
    return (Frame(step, rows) for step, rows in tables(path))


def gas(path):
    """Cells of one CGNS file: time; x, y, z of the centres, number of the block and fields by name."""
    import h5py

    def centre(a):
        return sum(a[k : k - 1 or None, j : j - 1 or None, i : i - 1 or None]
                   for k in (0, 1) for j in (0, 1) for i in (0, 1)) / 8

    out, columns = {}, {}
    with h5py.File(path, "r") as file:
        base = next(v for v in file.values() if v.attrs.get("label", b"").startswith(b"CGNSBase"))
        for node in base.values():
            label = node.attrs.get("label", b"")
            if label.startswith(b"BaseIter"):
                out["time"] = float(np.ravel(node["TimeValues"][" data"][()])[0])
            if not label.startswith(b"Zone_t"):
                continue
            grid = next(v for v in node.values() if v.attrs.get("label", b"").startswith(b"GridCoord"))
            values = {c.lower(): centre(grid["Coordinate" + c][" data"][()]) for c in "XYZ"}
            flow = next(v for v in node.values() if v.attrs.get("label", b"").startswith(b"FlowSolution"))
            for name, field in flow.items():
                if " data" in field and field.attrs.get("label", b"").startswith(b"DataArray"):
                    values[name] = field[" data"][()]
            values["block"] = np.full(values["x"].shape, len(columns.get("x", ())))
            for name, value in values.items():
                columns.setdefault(name, []).append(value.ravel())
    out.update({name: np.concatenate(parts) for name, parts in columns.items()})
    return out


class MeanBed:
    """Solids fraction and velocity of the bed on squares of `width`, means of frames and of the axis."""

    def __init__(self, width=1.5 * DIAMETER):
        self.edges = np.arange(-RADIUS, RADIUS + width, width)
        self.centres = 0.5 * (self.edges[1:] + self.edges[:-1])
        shape = (len(self.centres),) * 2
        self.count, self.vx, self.vy = np.zeros(shape), np.zeros(shape), np.zeros(shape)
        self.frames, self.length = 0, 0.0

    def add(self, frame):
        place = frame.x[:, 0], frame.x[:, 1]
        for total, weight in ((self.count, None), (self.vx, frame.v[:, 0]), (self.vy, frame.v[:, 1])):
            total += np.histogram2d(*place, bins=(self.edges, self.edges), weights=weight)[0]
        self.frames += 1
        self.length = max(self.length, np.ptp(frame.x[:, 2]) + DIAMETER)

    def solids(self):
        area = (self.edges[1] - self.edges[0]) ** 2
        return self.count * np.pi / 6 * DIAMETER**3 / (area * self.length * self.frames)

    def velocity(self):
        with np.errstate(invalid="ignore", divide="ignore"):
            return self.vx / self.count, self.vy / self.count

    def surface(self, level=0.3):
        """(x, y) of the bed's surface where the solids fraction, from above, first passes `level`."""
        points = []
        solids = self.solids()
        for column, x in zip(solids, self.centres):
            above = np.flatnonzero(column > level)
            if len(above) == 0 or above[-1] + 1 >= len(column):
                continue
            j = above[-1]
            share = (column[j] - level) / (column[j] - column[j + 1])
            y = self.centres[j] + share * (self.centres[1] - self.centres[0])
            if np.hypot(x, y) < RADIUS - DIAMETER:  # else it is the wall that ends the bed
                points.append((x, y))
        return np.array(points)

    def angle(self, within=0.5):
        """Slope of the surface in degrees: of a line through its part within a share of the radius."""
        points = self.surface()
        middle = points[np.hypot(*points.T) < within * RADIUS]
        return np.degrees(np.arctan(np.polyfit(*middle.T, 1)[0]))


class Springs:
    """Springs of all contacts at the times of the frames: energy (J), overlap over diameter (mean, largest).

    Of the curved wall, whose contacts LIGGGHTS does not list, overlaps alone."""

    def __init__(self, post, radius=RADIUS):
        energy, overlaps = {}, {}
        for name in ("pairs.txt", "ends.txt"):
            if not (post / name).exists():
                continue
            for step, rows in tables(post / name):
                if not len(rows):
                    continue
                overlap, strain = rows[:, 3], rows[:, :3]
                stored = 0.5 * STIFFNESS * ((overlap**2).sum() + 2 / 7 * (strain**2).sum())
                energy[step] = energy.get(step, 0.0) + stored
                overlaps.setdefault(step, []).append(overlap)
        for frame in frames(post / "particles.txt"):
            overlap = np.maximum(np.hypot(*frame.x[:, :2].T) + DIAMETER / 2 - radius, 0)
            energy[frame.step] += 0.5 * STIFFNESS * (overlap**2).sum()
            overlaps[frame.step].append(overlap[overlap > 0])
        self.steps = np.array(sorted(energy))
        self.energy = np.array([energy[step] for step in self.steps])
        every = [np.concatenate(overlaps[step]) / DIAMETER for step in self.steps]
        self.mean, self.largest = (np.array([f(o) for o in every]) for f in (np.mean, np.max))
        self.contacts = np.array([len(o) for o in every])


def elapsed_integral(table, mean, now, interval):
    """Integral since time 0 of what was sampled at every gas step: trapezes, from its running mean."""
    samples = np.rint(table["time"] / interval) + 1
    value = table[now]
    return interval * (samples * table[mean] - 0.5 * (value[0] + value))


def mechanics(table, particles, interval=DT * COUPLE_EVERY):
    """Terms of the energy of motion since time 0 [J], each with its sign as a gain of the bed.

    The walls turn at OMEGA, so their work is OMEGA times the impulse of their torque, and that is the angular
    momentum of the bed less the impulses of the torques of weight and gas. Contacts between particles have none."""
    weight = particles * MASS * GRAVITY
    impulse = (table["angular momentum"] - table["angular momentum"][0]
               + weight * elapsed_integral(table, "mean x", "x", interval)
               - elapsed_integral(table, "mean gas torque", "gas torque", interval))
    kinetic = table["motion"] + table["spin"]
    return {
        "walls": OMEGA * impulse,
        "gas": elapsed_integral(table, "mean gas power", "gas power", interval),
        "kinetic": kinetic - kinetic[0],
        "height": weight * (table["y"] - table["y"][0]),
        "friction": table["friction"] + table["into walls"],
        "damping": table["damping"],
    }
