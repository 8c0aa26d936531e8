# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts of a few spheres with temperatures."""

import math

HEAD = """
units           si
atom_style      granular
atom_modify     map array
boundary        f f f
newton          off
communicate     single vel yes
processors      * * *
read_data       data.spheres
neighbor        3e-4 bin
neigh_modify    delay 0
fix             kn all property/global kn peratomtypepair 2 {kn} {kn} {kn} {kn}
fix             kt all property/global kt peratomtypepair 2 {kt} {kt} {kt} {kt}
fix             gn all property/global gamman_abs peratomtypepair 2 {gn} {gn} {gn} {gn}
fix             gt all property/global gammat_abs peratomtypepair 2 {gt} {gt} {gt} {gt}
fix             cf all property/global coefficientFriction peratomtypepair 2 {mu} {mu} {mu} {mu}
fix             yo all property/global youngsModulusOriginal peratomtype 193.05e9 193.05e9
fix             pr all property/global poissonsRatio peratomtype 0.3 0.3
fix             tk all property/global thermalConductivity peratomtype {k1} {k2}
fix             tc all property/global thermalCapacity peratomtype {capacity} {capacity}
pair_style      gran model hooke/stiffness tangential {tangential} absolute_damping on
pair_coeff      * *
timestep        {dt}
"""

WALL = "fix {name} all wall/gran model hooke/stiffness tangential {tangential} primitive type {type} {place} {more} absolute_damping on\n"

DEFAULTS = dict(kn=1e4, kt=8e3, gn=0, gt=0, mu=0.3, k1=36, k2=36, capacity=875, tangential="history", dt=1e-7)


def data_file(spheres, low=(-1e-2, -1e-2, -1e-2), high=(2e-2, 1e-2, 1e-2)):
    """spheres: (type, diameter, density, (x, y, z)[, (vx, vy, vz), (wx, wy, wz)])."""
    atoms, velocities = [], []
    for number, (kind, diameter, density, place, *motion) in enumerate(spheres, 1):
        v, w = motion if motion else ((0, 0, 0), (0, 0, 0))
        atoms.append(" ".join(map(repr, [number, kind, diameter, density, *place])))
        velocities.append(" ".join(map(repr, [number, *v, *w])))
    box = "".join(f"{a!r} {b!r} {d}lo {d}hi\n" for a, b, d in zip(low, high, "xyz"))
    return (
        f"spheres\n\n{len(spheres)} atoms\n2 atom types\n\n{box}\nAtoms\n\n"
        + "\n".join(atoms)
        + "\n\nVelocities\n\n"
        + "\n".join(velocities)
        + "\n"
    )


def head(**changes):
    return HEAD.format(**{**DEFAULTS, **changes})


def wall(name, place, kind=1, more="", tangential="history"):
    return WALL.format(name=name, place=place, type=kind, more=more, tangential=tangential)


def thermo(columns, every):
    return (
        f"thermo_style custom step atoms {columns}\n"
        f"thermo_modify lost error norm no format float %.17g\nthermo {every}\n"
    )


def mass(diameter, density):
    return density * math.pi / 6 * diameter**3
