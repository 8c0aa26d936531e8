# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Reads the files of a run of the small bed: thermo output, particles, gas; void profiles."""

import re
from pathlib import Path

import numpy as np

WIDTH, DEPTH, DIAMETER = 44e-3, 10e-3, 1.2e-3  # m
PARTICLES, DENSITY, GAS_DENSITY, GRAVITY = 9240, 1000.0, 1.2, 9.81
# Less buoyancy: the pressure drop is that of the dynamic pressure.
WEIGHT_PER_AREA = PARTICLES * (DENSITY - GAS_DENSITY) * np.pi / 6 * DIAMETER**3 * GRAVITY / (WIDTH * DEPTH)  # Pa


def log_of(results):
    """The log of LIGGGHTS or of LAMMPS in a folder of results."""
    return next(log for log in (results / "log.liggghts", results / "log.lammps") if log.exists())


def thermo(log):
    """Columns of the last run that prints f_gas in a log file: {heading: values}. LIGGGHTS leaves the
    f_ of a heading out, LAMMPS does not."""
    table, heads = {}, None
    for line in Path(log).read_text().splitlines():
        words = line.split()
        if words and words[0] == "Step":
            heads = [w.removeprefix("f_") for w in words] if "gas" in line else None
            if heads:
                table = {h: [] for h in heads}
        elif heads and len(words) == len(heads) and re.match(r"^\d+$", words[0]):
            for head, word in zip(heads, words):
                table[head].append(float(word))
    return {head: np.array(values) for head, values in table.items()}


def particles(path):
    """Points and data of one legacy VTK file of particles: {"x": (n, 3), name: (n,) or (n, 3)}."""
    words = Path(path).read_text().split()
    at = words.index("POINTS")
    count = int(words[at + 1])
    data = {"x": np.array(words[at + 3 : at + 3 + 3 * count], float).reshape(count, 3)}
    at = words.index("FieldData") + 2
    while at + 3 < len(words):
        name, components, tuples = words[at], int(words[at + 1]), int(words[at + 2])
        values = words[at + 4 : at + 4 + components * tuples]
        data[name] = np.array(values, float).reshape(tuples, components).squeeze()
        at += 4 + components * tuples
        while at < len(words) and words[at] == "METADATA":  # VTK 9 adds blocks of its own
            while at < len(words) and not (at + 2 < len(words) and words[at + 2].isdigit()
                                           and words[at + 1].isdigit()):
                at += 1
    return data


def frames(path, columns=("x", "y", "z")):
    """Step and columns (n, ...) of every frame of a text dump."""
    with open(path) as file:
        while line := file.readline():
            if line.startswith("ITEM: TIMESTEP"):
                step = int(file.readline())
            elif line.startswith("ITEM: NUMBER OF ATOMS"):
                count = int(file.readline())
            elif line.startswith("ITEM: ATOMS"):
                heads = line.split()[2:]
                rows = np.loadtxt([file.readline() for _ in range(count)], ndmin=2,
                                  usecols=[heads.index(column) for column in columns])
                yield step, rows


def snapshots(results):
    """Step, positions (n, 3) and vertical velocities of every particle output: VTK files of LIGGGHTS,
    a text dump of LAMMPS."""
    dump = results / "post/particles.txt"
    if dump.exists():
        return [(step, rows[:, :3], rows[:, 3]) for step, rows in frames(dump, ("x", "y", "z", "vz"))]
    found = []
    for path in (results / "post").glob("particles_*.vtk"):
        if "bound" in path.name:
            continue
        data = particles(path)
        v = data.get("v", data.get("vz"))
        step = int("".join(c for c in path.stem if c.isdigit()))
        found.append((step, data["x"], v[:, 2] if v.ndim == 2 else v))
    return sorted(found, key=lambda snapshot: snapshot[0])


def _cap(t):
    """Share of a unit sphere's volume below height t."""
    t = np.clip(t, -1, 1)
    return 0.25 * (t + 1) ** 2 * (2 - t)


def void_profile(position, height, edges, thickness=2 * DIAMETER):
    """Void fraction in slabs of the bed: x between `edges` [m], z within `thickness` about
    `height`. A sphere is shared between the boxes as if its cuts in x and z were independent."""
    radius = DIAMETER / 2
    x, z = position[:, 0], position[:, 2]
    near = np.abs(z - height) < thickness / 2 + radius
    x, z = x[near], z[near]
    low, high = (height - thickness / 2 - z) / radius, (height + thickness / 2 - z) / radius
    in_slab = _cap(high) - _cap(low)
    below = _cap((np.asarray(edges)[None, :] - x[:, None]) / radius)
    share = (below[:, 1:] - below[:, :-1]) * in_slab[:, None]
    solids = share.sum(axis=0) * 4 / 3 * np.pi * radius**3
    return 1 - solids / (np.diff(edges) * DEPTH * thickness)


def gas(path):
    """Cell-centred fields of one CGNS file, blocks put together: time, x, z and fields by name."""
    import h5py

    out = {}
    with h5py.File(path, "r") as file:
        base = next(v for k, v in file.items() if v.attrs.get("label", b"").startswith(b"CGNSBase"))
        columns = {}
        for node in base.values():
            label = node.attrs.get("label", b"")
            if label.startswith(b"BaseIter"):
                out["time"] = float(np.ravel(node["TimeValues"][" data"][()])[0])
            if not label.startswith(b"Zone_t"):
                continue
            grid = next(v for v in node.values() if v.attrs.get("label", b"").startswith(b"GridCoord"))
            x, z = grid["CoordinateX"][" data"][()], grid["CoordinateZ"][" data"][()]
            centre = lambda a: sum(  # noqa: E731
                a[k : k - 1 or None, j : j - 1 or None, i : i - 1 or None]
                for k in (0, 1) for j in (0, 1) for i in (0, 1)) / 8
            values = {"x": centre(x), "z": centre(z)}
            flow = next(v for v in node.values() if v.attrs.get("label", b"").startswith(b"FlowSolution"))
            for name, field in flow.items():
                if " data" in field and field.attrs.get("label", b"").startswith(b"DataArray"):
                    values[name] = field[" data"][()]
            for name, value in values.items():
                columns.setdefault(name, []).append(value.mean(axis=1).ravel())  # over the depth
    out.update({name: np.concatenate(parts) for name, parts in columns.items()})
    return out
