# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Scripts of one or two spheres in the box of host.CASE, for both hosts."""

SCRIPT = """
units           si
atom_style      {atom_style}
atom_modify     map array
boundary        f f f
newton          off
{communicate}
region          box block 0 10e-3 0 6e-3 0 40e-3 units box
create_box      1 box
{spheres}
set             group all diameter {diameter!r} density {density!r}
{contacts}
neighbor        {skin!r} bin
neigh_modify    delay 0
fix             move all nve/sphere
timestep        {step!r}
{more}
thermo          {every}
run             {steps}
"""


def script(lammps, centres, diameter, density, contacts, skin, step, steps, every, more):
    """`centres`: along x [m], in the middle of y and z; `more`: lines before the run, thermo_style among them."""
    return SCRIPT.format(
        atom_style="sphere" if lammps else "granular",
        communicate="comm_modify vel yes" if lammps else "communicate single vel yes",
        spheres="\n".join(f"create_atoms 1 single {x!r} 3e-3 20e-3 units box" for x in centres),
        diameter=diameter, density=density, contacts=contacts, skin=skin, step=step, steps=steps, every=every, more=more)
