#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes drag.csv: F of every drag law, worked out from the dimensional equations of the papers.

Each law is written as its source writes it, as a momentum exchange coefficient or a force, for a
gas and a particle with units, in 60 digits (mpmath). F then follows from its definition,
beta = 18 mu eps (1-eps) F / d^2. The C++ is in another, dimensionless form.

Re = 0 stands for Re = 1e-70, whose F is that of the limit to far more digits than are printed.
"""
import csv
import pathlib

from mpmath import atan, exp, log, log10, mp, mpf, pi, sqrt

mp.dps = 60
rho, mu, d = mpf("1.2"), mpf("1.8e-5"), mpf("1.2e-3")
volume = pi * d**3 / 6


def reynolds(eps, slip):
    return rho * eps * slip * d / mu


# Each returns beta / (1 - eps) [kg/(m3 s)], which exists at eps = 1.


def stokes(eps, slip):
    force = 3 * pi * mu * d * eps * slip
    return force / (volume * slip)


def standard_cd(re):
    return 24 / re * (1 + mpf("0.15") * re ** mpf("0.687")) if re < 1000 else mpf("0.44")


def schiller_naumann(eps, slip):
    superficial = eps * slip
    force = standard_cd(reynolds(eps, slip)) * pi / 4 * d**2 * rho * superficial**2 / 2
    return force / (volume * slip)


def ergun(eps, slip):
    return 150 * (1 - eps) * mu / (eps * d**2) + mpf("1.75") * rho * slip / d


def wen_yu(eps, slip):
    cd = standard_cd(reynolds(eps, slip))
    return mpf(3) / 4 * cd * eps * rho * slip / d * eps ** mpf("-2.65")


def gidaspow(eps, slip):
    return ergun(eps, slip) if eps < mpf("0.8") else wen_yu(eps, slip)


def gidaspow_blend(eps, slip):
    solid = 1 - eps
    phi = atan(150 * mpf("1.75") * (mpf("0.2") - solid)) / pi + mpf("0.5")
    return (1 - phi) * ergun(eps, slip) + phi * wen_yu(eps, slip)


def di_felice(eps, slip):
    re = reynolds(eps, slip)
    cd = (mpf("0.63") + mpf("4.8") / sqrt(re)) ** 2
    chi = mpf("3.7") - mpf("0.65") * exp(-((mpf("1.5") - log10(re)) ** 2) / 2)
    force = cd * rho * pi * d**2 * eps**2 * slip**2 * eps**-chi / 8
    return force / (volume * slip)


def koch_hill(eps, slip):
    """beta = 18 mu eps^2 (1-eps)/d^2 (F0 + F3 Re_a), Re_a on the radius."""
    phi = 1 - eps
    re_radius = rho * eps * slip * (d / 2) / mu
    if phi < mpf("0.4"):
        log_term = phi * log(phi) if phi > 0 else mpf(0)
        f0 = (1 + 3 * sqrt(phi / 2) + mpf(135) / 64 * log_term + mpf("17.14") * phi) / (
            1 + mpf("0.681") * phi - mpf("8.48") * phi**2 + mpf("8.16") * phi**3
        )
    else:
        f0 = 10 * phi / (1 - phi) ** 3
    f3 = mpf("0.0673") + mpf("0.212") * phi + mpf("0.0232") / (1 - phi) ** 5
    return 18 * mu * eps**2 / d**2 * (f0 + f3 * re_radius)


def beetstra(eps, slip):
    """beta = 18 mu eps (1-eps)/d^2 F; F as printed, with negative powers of Re."""
    phi = 1 - eps
    re = reynolds(eps, slip)
    f = 10 * phi / (1 - phi) ** 2 + (1 - phi) ** 2 * (1 + mpf("1.5") * sqrt(phi))
    f += (
        mpf("0.413") * re / (24 * (1 - phi) ** 2)
        * (1 / (1 - phi) + 3 * phi * (1 - phi) + mpf("8.4") * re ** mpf("-0.343"))
        / (1 + mpf(10) ** (3 * phi) * re ** (-(1 + 4 * phi) / 2))
    )
    return 18 * mu * eps / d**2 * f


# law, largest Re, smallest and largest void fraction of the table
laws = [
    (stokes, 0.1, 0.95, 1),
    (schiller_naumann, 1e5, 0.95, 1),
    (wen_yu, 1e5, 0.4, 1),
    (ergun, 1500, 0.35, 0.8),
    (gidaspow, 1e5, 0.35, 1),
    (gidaspow_blend, 1e5, 0.35, 1),
    (di_felice, 1e4, 0.4, 1),
    (koch_hill, 200, 0.36, 1),
    (beetstra, 1000, 0.4, 1),
]
reynolds_numbers = [0, 1e-4, 0.1, 1, 7.5, 30, 100, 200, 999, 1001, 1500, 1e4, 1e5]
void_fractions = [0.36, 0.42, 0.5, 0.59, 0.61, 0.7, 0.79, 0.8, 0.81, 0.9, 0.97, 0.999, 1]

with open(pathlib.Path(__file__).with_name("drag.csv"), "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["law", "reynolds", "void_fraction", "F"])
    for law, largest, loose, dense in laws:
        for eps in void_fractions:
            for re in reynolds_numbers:
                if re > largest or not loose <= eps <= dense:
                    continue
                e = mpf(eps)
                slip = mpf(re or "1e-70") * mu / (rho * e * d)
                f = law(e, slip) * d**2 / (18 * mu * e)
                out.writerow([law.__name__, repr(re), repr(eps), mp.nstr(f, 18)])
