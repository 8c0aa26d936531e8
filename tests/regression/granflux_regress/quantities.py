# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Which columns of a dump form one physical quantity."""

from dataclasses import dataclass

from granflux_regress.bad_input import BadInput

# The columns of LIGGGHTS and LAMMPS that are the components of a vector.
VECTORS = {
    "x": ("x", "y", "z"),
    "xs": ("xs", "ys", "zs"),
    "xu": ("xu", "yu", "zu"),
    "xsu": ("xsu", "ysu", "zsu"),
    "v": ("vx", "vy", "vz"),
    "f": ("fx", "fy", "fz"),
    "omega": ("omegax", "omegay", "omegaz"),
    "angmom": ("angmomx", "angmomy", "angmomz"),
    "torque": ("tqx", "tqy", "tqz"),
    "mu": ("mux", "muy", "muz"),
}
EXACT = {"id", "type", "mol", "ix", "iy", "iz", "mask", "proc"}  # whole numbers


@dataclass(frozen=True)
class Quantity:
    name: str
    columns: tuple

    @property
    def is_exact(self):
        return set(self.columns) <= EXACT


def quantities_of(columns, own_vectors):
    """Vectors whose components are all there, then each remaining column by itself."""
    found, taken = [], set()
    for name, members in {**VECTORS, **own_vectors}.items():
        if all(member in columns for member in members):
            found.append(Quantity(name, tuple(members)))
            taken.update(members)
        elif name in own_vectors:
            missing = [member for member in members if member not in columns]
            raise BadInput(f"--vector {name}: no column {', '.join(missing)}; "
                           f"there are {', '.join(columns)}")
    return found + [Quantity(column, (column,)) for column in columns if column not in taken]
