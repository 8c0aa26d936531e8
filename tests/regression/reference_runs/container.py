# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Where the particles are."""

from dataclasses import dataclass

MARGIN = 1e-3  # m, from a wall to the end of the box


@dataclass(frozen=True)
class Container:
    kind: str
    width: float  # m, in x and y; diameter of the cylinder
    height: float  # m
    is_open: bool  # periodic in z as well: no wall, no gravity

    @property
    def boundary(self):
        if self.kind != "periodic":
            return "f f f"
        return "p p p" if self.is_open else "p p f"

    @property
    def box(self):
        """((low, high) in x, y, z), m."""
        half = 0.5 * self.width
        side = MARGIN if self.kind != "periodic" else 0.0
        end = 0.0 if self.is_open else MARGIN
        return ((-half - side, half + side),) * 2 + ((-end, self.height + end),)


def container_of(case):
    """Dense: a bed some 13 mm high below empty space. Dilute: 15 % solids."""
    dense = case.density == "dense"
    width = 10e-3 if dense else 16e-3
    if case.container == "cylinder":
        width *= 1.12838  # equal cross-section: 2/sqrt(pi)
    return Container(case.container, width, 24e-3 if dense else 22e-3,
                     case.container == "periodic" and not dense)
