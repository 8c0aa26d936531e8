# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""A sphere that meets another at rest, for both hosts: how long they touch."""

import math
import re

from few_spheres import script
from host import CASE, couple, thermo_rows

DIAMETER, DENSITY = 1e-3, 1000.0
MASS = DENSITY * math.pi / 6 * DIAMETER**3
SPEED = 0.2
STEPS = 400  # of a contact, about

MORE = f"""
group           left id 1
velocity        left set {SPEED} 0 0 units box
variable        gap equal x[2]-x[1]
thermo_style    custom step v_gap
thermo_modify   norm no format float %.17g
{couple(100)}"""

# Next to no gas: it must not slow the spheres down.
THIN = CASE.replace("density = 1.2", "density = 1e-9").replace("viscosity = 1.8e-5", "viscosity = 1e-12")


def scene(contacts, step, lammps=False):
    return script(lammps, (4e-3, 4e-3 + DIAMETER * 1.001), DIAMETER, DENSITY, contacts, skin=3e-4, step=step,
                  steps=int(STEPS * 1.3 + 1e-3 * DIAMETER / SPEED / step), every=1, more=MORE)


def duration(output, step):
    """Seconds for which the centres are nearer than a diameter, ends by interpolation."""
    gaps = [row[1] - DIAMETER for row in thermo_rows(output) if len(row) == 2]
    first = next(i for i, gap in enumerate(gaps) if gap < 0)
    last = next(i for i in range(first, len(gaps)) if gaps[i] > 0)
    start = first - gaps[first] / (gaps[first] - gaps[first - 1])
    end = last - gaps[last] / (gaps[last] - gaps[last - 1])
    return (end - start) * step


def told(output, step):
    """Contact time by the table of the stable range."""
    number = re.search(r"DEM step / contact time of types 1-1 +(\S+)", output)
    return step / float(number.group(1))


def check(test, run, contacts, expected, lammps=False):
    """expected: contact time by closed form."""
    test.write("case.toml", THIN)
    step = expected / STEPS
    output = run(scene(contacts, step, lammps))
    lasted = duration(output, step)
    test.assertLess(abs(lasted / expected - 1), 2e-3, (lasted, expected))
    return output, lasted, step
