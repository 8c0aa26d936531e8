# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What remains comparable when particles have lost their memory: sums and means over the bed."""

from dataclasses import dataclass

import numpy as np

from granflux_regress.bad_input import BadInput
from granflux_regress.tolerance import Tolerance, parse_named

CONTACTS = "c_contacts"  # default name of the column of contacts a particle
DEFAULTS = {
    "particles": Tolerance(0.0),
    "mass": Tolerance(1e-9),
    "kinetic_energy": Tolerance(0.05),
    "rotational_energy": Tolerance(0.05),
    "centre_of_mass": Tolerance(0.01),
    "mean_height": Tolerance(0.01),
    "height_95": Tolerance(0.02),
    "coordination_number": Tolerance(0.05),
}
AXES = ("x", "y", "z")


@dataclass(frozen=True)
class StatisticsOptions:
    up: str = "z"
    floor: float | None = None  # m; None: the lower end of the box of the reference's snapshot
    density: float | None = None  # kg/m3, for dumps without mass
    contacts: str = CONTACTS


@dataclass
class StatisticDifference:
    step: str
    quantity: str
    reference: np.ndarray
    value: np.ndarray
    distance: float
    scale: float
    allowed: float

    @property
    def failed(self):
        return not self.distance <= self.allowed


def statistics_of(snapshot, options, floor):
    """{name: (components)} of one snapshot; what its columns do not give is left out."""
    columns = set(snapshot.columns)
    mass = _mass(snapshot, options)
    total = mass.sum()
    result = {"particles": np.array([float(len(mass))]), "mass": np.array([total])}
    if not len(mass):
        return result
    if {"vx", "vy", "vz"} <= columns:
        speed2 = (snapshot.block(("vx", "vy", "vz")) ** 2).sum(axis=1)
        result["kinetic_energy"] = np.array([0.5 * (mass * speed2).sum()])
    if {"omegax", "omegay", "omegaz", "radius"} <= columns:
        spin2 = (snapshot.block(("omegax", "omegay", "omegaz")) ** 2).sum(axis=1)
        inertia = 0.4 * mass * snapshot.column("radius") ** 2  # solid sphere
        result["rotational_energy"] = np.array([0.5 * (inertia * spin2).sum()])
    if set(AXES) <= columns:
        result["centre_of_mass"] = (mass[:, None] * snapshot.block(AXES)).sum(axis=0) / total
        height = snapshot.column(options.up) - floor
        result["mean_height"] = np.array([(mass * height).sum() / total])
        result["height_95"] = np.array([weighted_quantile(height, mass, 0.95)])
    if options.contacts in columns:
        result["coordination_number"] = np.array([snapshot.column(options.contacts).mean()])
    elif options.contacts != CONTACTS:
        raise BadInput(f"--contacts: no column '{options.contacts}'; there are "
                       f"{', '.join(snapshot.columns)}")
    return result


def weighted_quantile(values, weights, fraction):
    """Smallest value below or at which lies at least `fraction` of the weight."""
    order = np.argsort(values)
    below = np.cumsum(weights[order])
    return values[order][np.searchsorted(below, fraction * below[-1])]


def floor_of(snapshot, options):
    return snapshot.low[AXES.index(options.up)] if options.floor is None else options.floor


def compare_statistics(step, a, b, extent, texts):
    """Differences of two results of statistics_of; `extent` is the size of the reference's bed."""
    if a.keys() != b.keys():
        odd = ", ".join(sorted(a.keys() ^ b.keys()))
        raise BadInput(f"step {step}: {odd} can be had from one dump only")
    tolerances = {**DEFAULTS, **parse_named(texts, "--tolerance", list(a))}
    found = []
    for name in a:
        distance = float(np.sqrt(((b[name] - a[name]) ** 2).sum()))
        scale = extent if name == "centre_of_mass" else float(np.abs(a[name]).max())
        found.append(StatisticDifference(str(step), name, a[name], b[name], distance, scale,
                                         tolerances[name].allowed(scale)))
    return found


def extent_of(snapshot):
    """Diagonal of the box around all centres, m."""
    if not len(snapshot.values) or not set(AXES) <= set(snapshot.columns):
        return 0.0
    return float(np.linalg.norm(np.ptp(snapshot.block(AXES), axis=0)))


def _mass(snapshot, options):
    mass = _masses(snapshot, options)
    if not (np.isfinite(mass) & (mass > 0)).all():
        raise BadInput(f"step {snapshot.step}: statistics are weighted by mass, and a particle has one that is not "
                       "a number above 0")
    return mass


def _masses(snapshot, options):
    if "mass" in snapshot.columns:
        return snapshot.column("mass")
    if "radius" not in snapshot.columns:
        raise BadInput(f"step {snapshot.step}: statistics are weighted by mass, and the dump has "
                       "neither column mass nor radius")
    density = snapshot.column("density") if "density" in snapshot.columns else options.density
    if density is None:
        raise BadInput(f"step {snapshot.step}: no column mass or density: give the density of the "
                       "particles by --density")
    return 4.0 / 3.0 * np.pi * density * snapshot.column("radius") ** 3
