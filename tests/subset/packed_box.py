# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Small scripts of pure LIGGGHTS commands: spheres of several sizes and two materials that touch,
slide and roll in a box."""

import random

DIAMETER = 2e-3  # m, the mean

HEAD = """
units           si
atom_style      granular
atom_modify     map array {sort}
boundary        {boundary}
newton          off
communicate     single vel yes
processors      {grid}
read_data       data.box
neighbor        4e-4 bin
neigh_modify    delay 0
group           fixed id {fixed}
fix             kn all property/global kn peratomtypepair 2 {kn} {kn} {kn} 1.3e3
fix             kt all property/global kt peratomtypepair 2 300 250 250 400
fix             gn all property/global gamman peratomtypepair 2 1500 1200 1200 900
fix             gt all property/global gammat peratomtypepair 2 700 600 600 500
fix             ga all property/global gamman_abs peratomtypepair 2 0.01 0.012 0.012 0.008
fix             gb all property/global gammat_abs peratomtypepair 2 0.004 0.005 0.005 0.003
fix             ym all property/global youngsModulus peratomtype 5e6 8e6
fix             pr all property/global poissonsRatio peratomtype 0.3 0.25
fix             cr all property/global coefficientRestitution peratomtypepair 2 0.6 0.7 0.7 0.8
fix             cf all property/global coefficientFriction peratomtypepair 2 0.3 0.4 0.4 0.5
fix             rf all property/global coefficientRollingFriction peratomtypepair 2 0.1 0.2 0.2 0.15
fix             ce all property/global cohesionEnergyDensity peratomtypepair 2 2e4 3e4 3e4 1e4
fix             cv all property/global characteristicVelocity scalar 1.0
pair_style      gran {model}
pair_coeff      * *
timestep        {step}
fix             gravity all gravity 9.81 vector 0 0 -1
fix             move all nve/sphere
{more}
thermo_style    custom step atoms ke
thermo_modify   lost error norm no
dump            d all custom 1 {name} id type x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz
dump_modify     d sort id format "%d %d{numbers}"
"""

COLUMNS = ["x", "v", "omega", "f", "torque"]


def data_file(cells, spacing, speed, spin, periodic_gap, seed=20, types=2, sizes=(0.85, 1.1)):
    """Spheres on a lattice of `cells` in a box, pushed off their places. spacing: in mean diameters;
    below 1 most of them touch. sizes: least and largest diameter, in mean ones. periodic_gap: the box is so much longer than the lattice, in spacings."""
    rng = random.Random(seed)
    a = spacing * DIAMETER
    atoms, velocities = [], []
    number = 0
    for k in range(cells[2]):
        for j in range(cells[1]):
            for i in range(cells[0]):
                number += 1
                place = [a * (c + 0.5 + periodic_gap / 2 + 0.08 * rng.uniform(-1, 1)) for c in (i, j, k)]
                diameter = DIAMETER * rng.uniform(*sizes)
                kind = rng.randint(1, types)
                atoms.append(
                    f"{number} {kind} {diameter!r} {2000.0 if kind == 1 else 3000.0} {place[0]!r} {place[1]!r} {place[2]!r}"
                )
                v = [speed * rng.uniform(-1, 1) for _ in range(3)]
                w = [spin * rng.uniform(-1, 1) for _ in range(3)]
                velocities.append(" ".join(map(repr, [number, *v, *w])))
    box = "".join(
        f"0 {a * (n + periodic_gap)!r} {d}lo {d}hi\n" for n, d in zip(cells, "xyz")
    )
    return (
        f"spheres\n\n{number} atoms\n{types} atom types\n\n{box}\nAtoms\n\n"
        + "\n".join(atoms)
        + "\n\nVelocities\n\n"
        + "\n".join(velocities)
        + "\n"
    )


def script(name, model, boundary="p p p", grid="* * *", step=2e-6, more="", sort="", fixed=1, kn="1e3", runs=(1, 99)):
    """A dump of each step of the first run, of every 25th of later ones."""
    head = HEAD.format(
        name=name,
        model=model,
        boundary=boundary,
        grid=grid,
        step=step,
        more=more,
        sort=sort,
        fixed=fixed,
        kn=kn,
        numbers=" %.17g" * 15,
    )
    return head + "dump_modify d every 25\n".join(f"run {steps}\n" for steps in runs)


def snapshots(text):
    """{step: {id: [15 numbers]}} of a dump."""
    found = {}
    for part in text.split("ITEM: TIMESTEP\n")[1:]:
        step, rest = part.split("\n", 1)
        rows = {}
        for line in rest.split("ITEM: ATOMS", 1)[1].splitlines()[1:]:
            words = line.split()
            rows[int(words[0])] = [float(word) for word in words[2:]]
        found[int(step)] = rows
    return found


def difference(a, b):
    """Largest difference of two snapshots, for each vector relative to its largest component."""
    assert a.keys() == b.keys()
    worst = {}
    for v, column in enumerate(COLUMNS):
        part = slice(3 * v, 3 * v + 3)
        scale = max(abs(x) for row in a.values() for x in row[part]) or 1.0
        worst[column] = max(abs(x - y) for i in a for x, y in zip(a[i][part], b[i][part])) / scale
    return worst
