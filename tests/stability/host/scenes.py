# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scenes of hard cases: spheres, a gas case and what of a run is looked at."""

import math

from host import HostTest, last_snapshot, thermo_rows

GRAVITY = 9.81  # m/s2
AIR = dict(density=1.2, viscosity=1.8e-5)
WATER = dict(density=1000.0, viscosity=1e-3)
ENTRIES = 36  # of the vector of fix granflux/couple, from 1

HEAD = """
units           si
atom_style      granular
atom_modify     map array
boundary        {boundary}
newton          off
communicate     single vel yes
processors      {ranks}
read_data       data.spheres
fix             kn all property/global kn peratomtypepair 1 {kn}
fix             kt all property/global kt peratomtypepair 1 {kt}
fix             gn all property/global gamman_abs peratomtypepair 1 {gn}
fix             gt all property/global gammat_abs peratomtypepair 1 {gt}
fix             mu all property/global coefficientFriction peratomtypepair 1 {mu}
pair_style      gran model hooke/stiffness tangential history absolute_damping on
pair_coeff      * *
neighbor        {skin} bin
neigh_modify    delay 0
timestep        {dt}
fix             move all nve/sphere
"""

THERMO = """
variable        mass equal mass(all)
variable        px equal vcm(all,x)*mass(all)
variable        py equal vcm(all,y)*mass(all)
variable        pz equal vcm(all,z)*mass(all)
thermo_style    custom step atoms ke v_mass v_px v_py v_pz {entries}
thermo_modify   lost {lost} norm no format float %.17g
thermo          {every}
"""

DUMP = """
dump            d all custom {every} dump.spheres id x y z vx vy vz {more}
dump_modify     d sort id format "%d{numbers}"
"""


def volume(diameter):
    return math.pi / 6 * diameter**3


def data_file(spheres, low, high):
    """spheres: (diameter, density, (x, y, z), (vx, vy, vz))."""
    lines = [f"spheres\n\n{len(spheres)} atoms\n1 atom types\n"]
    lines += [f"{a!r} {b!r} {d}lo {d}hi" for a, b, d in zip(low, high, "xyz")]
    lines.append("\nAtoms\n")
    for n, (diameter, density, x, _) in enumerate(spheres, 1):
        lines.append(" ".join(map(repr, [n, 1, diameter, density, *x])))
    lines.append("\nVelocities\n")
    for n, (_, _, _, v) in enumerate(spheres, 1):
        lines.append(" ".join(map(repr, [n, *v, 0, 0, 0])))
    return "\n".join(lines) + "\n"


def lattice(numbers, spacing, diameter, density, velocity=(0, 0, 0), low=(0, 0, 0)):
    """Simple cubic, the first sphere half a spacing from `low`."""
    return [
        (diameter, density, tuple(a + spacing * (n + 0.5) for a, n in zip(low, (i, j, k))), velocity)
        for k in range(numbers[2])
        for j in range(numbers[1])
        for i in range(numbers[0])
    ]


def head(dt, boundary="p p p", ranks="* * *", kn=1, kt=None, gn=0, gt=None, mu=0.3, skin=1e-4):
    kt, gt = 0.3 * kn if kt is None else kt, gn if gt is None else gt
    return HEAD.format(boundary=boundary, ranks=ranks, kn=kn, kt=kt, gn=gn, gt=gt, mu=mu, skin=skin, dt=dt)


def walls(places):
    """places: "zplane 0" and the like."""
    style = "model hooke/stiffness tangential history"
    return "".join(
        f"fix wall{n} all wall/gran {style} primitive type 1 {place} absolute_damping on\n"
        for n, place in enumerate(places)
    )


def gravity(value=GRAVITY, direction="0 0 -1"):
    return f"fix gravity all gravity {value} vector {direction}\n"


def heat(temperature, capacity):
    return f"""
fix             tc all property/global thermalCapacity peratomtype {capacity}
fix             heat all granflux/heat initial_temperature {temperature} conduction off friction off
"""


def box(size, cells, fluid, sides=None, more=""):
    """A case on a box; sides: {name of side: lines of its table}; directions without any are periodic."""
    sides = sides or {}
    periodic = [str(d + "_low" not in sides).lower() for d in "xyz"]
    text = f"""
[grid]
size = {list(size)}
cells = {list(cells)}
periodic = [{", ".join(periodic)}]
[fluid]
density = {fluid["density"]}
viscosity = {fluid["viscosity"]}
"""
    for side, lines in sides.items():
        text += f'[[boundary]]\nname = "{side}"\nside = "{side}"\n{lines}\n'
    return text + more


def energy(temperature, capacity=1000.0, conductivity=0.026):
    return f"""
[energy]
heat_capacity = {capacity}
conductivity = {conductivity}
initial_temperature = {temperature}
"""


def thermo(every=1, lost="error"):
    entries = " ".join(f"f_gas[{n}]" for n in range(1, ENTRIES + 1))
    return THERMO.format(entries=entries, every=every, lost=lost)


def dump(every=1, more=""):
    numbers = " %.17g" * (6 + len(more.split()))
    return DUMP.format(every=every, more=more, numbers=numbers)


class Row:
    """A line of thermo output: momentum of the particles, and the fix vector as gas[1] to gas[36]."""

    def __init__(self, values):
        self.step, self.atoms, self.kinetic, self.mass, *rest = values
        self.momentum, self.gas = rest[:3], [math.nan, *rest[3:]]

    @property
    def velocity(self):
        return [p / self.mass for p in self.momentum]


class HardCase(HostTest):
    def run_scene(self, script, spheres, low, high, case=None, **run):
        """Rows of the run, its output; the books are closed and everything is a number."""
        self.write("data.spheres", data_file(spheres, low, high))
        if case is not None:
            self.write("case.toml", case)
        output = self.run_script(script, **run)
        rows = [Row(values) for values in thermo_rows(output)]
        self.assertGreater(len(rows), 1, output)
        self.check_books(rows)
        return rows, output

    def start_scene(self, script, spheres, low, high, case=None, **run):
        self.write("data.spheres", data_file(spheres, low, high))
        if case is not None:
            self.write("case.toml", case)
        return self.start(script, **run)

    def check_books(self, rows):
        for row in rows:
            at = f"step {row.step:.0f}"
            for value in (row.kinetic, *row.gas[1:]):
                self.assertTrue(math.isfinite(value), at)
            self.assertTrue(row.gas[8] == 0 or 0 < row.gas[8] <= 1, at)
            for entry, name, least in (
                (10, "void volume", 1e-12),
                (11, "momentum", 1e-12),
                (12, "gas mass", 1e-9),
                (13, "gas momentum", 1e-9),
                (28, "momentum of both", 1e-9),
                (31, "gas heat", 1e-9),
                (32, "heat", 1e-12),
            ):
                self.assertLess(row.gas[entry], least, f"{name}, {at}")

    def spheres_now(self):
        return last_snapshot(self.read("dump.spheres"))

