# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The script of a case, for liggghts and granflux alike."""

from particles import COUNT, FROZEN_EVERY
from walls import wall_commands

FIRST, HUNDRED, THOUSAND, LATE = 1, 100, 1000, 10000  # that are dumped
ATOM_COLUMNS = "id type x y z vx vy vz fx fy fz omegax omegay omegaz tqx tqy tqz radius c_contacts"
# Of one type; (i, j) of several types vary by 10 % each, see pair_values.
PAIR_PROPERTIES = {
    "coefficientRestitution": 0.6,
    "coefficientFriction": 0.4,
    "coefficientRollingFriction": 0.05,
    "cohesionEnergyDensity": 1e4,  # J/m3
}
STIFFNESS = {  # of the laws 'hooke/stiffness' and 'hertz/stiffness'; collisions of some 40 steps
    "hooke/stiffness": {"kn": 1e3, "kt": 7e2, "gamman": 4e3, "gammat": 2e3},
    "hertz/stiffness": {"kn": 3e6, "kt": 2e6, "gamman": 5e7, "gammat": 2e7},
}
YOUNG, POISSON = (5e6, 6.5e6, 8e6), (0.3, 0.35, 0.4)


def pair_values(value, types):
    return " ".join(f"{value * (1 + 0.1 * (i + j)):.9g}" for i in range(types) for j in range(types))


def properties(case):
    types = case.type_count
    pairs = {**PAIR_PROPERTIES, **STIFFNESS.get(case.normal, {})}
    lines = [f"fix m_{name} all property/global {name} peratomtypepair {types} {pair_values(value, types)}"
             for name, value in pairs.items()]
    for name, values in (("youngsModulus", YOUNG), ("poissonsRatio", POISSON)):
        lines.append(f"fix m_{name} all property/global {name} peratomtype "
                     + " ".join(str(value) for value in values[:types]))
    return [*lines, "fix m_velocity all property/global characteristicVelocity scalar 1"]


def script_of(case, container, steps, grid="* * *", skin=5e-4):
    """Text; reads particles.data, writes atoms.dump and, if contacts remember, contacts.dump."""
    lines = [
        f"# {case.name}: {case.density}, gran model {case.model}, {case.types} types, sizes {case.sizes},",
        f"# frozen {case.frozen}, {case.container}",
        "units si",
        "atom_style granular",
        "atom_modify map array",
        f"boundary {container.boundary}",
        "newton off",
        "communicate single vel yes",
        f"processors {grid}",
        "read_data particles.data",
        *properties(case),
        f"pair_style gran model {case.model}",
        "pair_coeff * *",
        f"neighbor {skin} bin",
        "neigh_modify delay 0",
        "timestep 5e-6",
        *wall_commands(container, case.model),
    ]
    if not container.is_open:
        lines.append("fix gravity all gravity 9.81 vector 0 0 -1")
    if case.frozen == "yes":
        lines += [f"group frozen id 1:{COUNT}:{FROZEN_EVERY}", "group moving subtract all frozen",
                  "fix held frozen freeze", "fix move moving nve/sphere"]
    else:
        lines.append("fix move all nve/sphere")
    lines += [
        "compute contacts all contact/atom",
        "variable when equal 10*step+90*(step==1)+(step==0)",
        f"dump atoms all custom 1 atoms.dump {ATOM_COLUMNS}",
        'dump_modify atoms every v_when sort id format "%d %d' + " %.17g" * 17 + '"',
    ]
    if case.history_size:
        columns = ["c_pair[1]", "c_pair[2]", *history_columns(case)]
        lines += [
            "compute pair all pair/gran/local id history",
            f"dump contacts all local 1 contacts.dump {' '.join(columns)}",
            'dump_modify contacts every v_when format "%.0f %.0f' + " %.17g" * case.history_size + '"',
        ]
    lines += ["thermo 1000", "thermo_modify lost error norm no", f"run {steps}"]
    return "\n".join(lines) + "\n"


def history_columns(case):
    """Columns 1 to 3 are the two ids and whether the contact crosses a periodic boundary."""
    return [f"c_pair[{4 + k}]" for k in range(case.history_size)]
