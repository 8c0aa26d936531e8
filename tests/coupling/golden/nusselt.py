#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Writes nusselt.csv: Nu of every Nusselt law in 60 digits (mpmath), each as its source writes it.

Gunn is written through its terms (7 - 10 eps + 5 eps^2) = 2 + 5 (1 - eps)^2 and
(1.33 - 2.4 eps + 1.2 eps^2) = 0.13 + 1.2 (1 - eps)^2, from which a slip of a coefficient shows.
"""
import csv
import pathlib

from mpmath import cbrt, mp, mpf, sqrt

mp.dps = 60


def gunn(re, pr, eps):
    solid = 1 - eps
    laminar = (2 + 5 * solid**2) * (1 + mpf(7) / 10 * re ** mpf("0.2") * cbrt(pr))
    return laminar + (mpf("0.13") + mpf("1.2") * solid**2) * re ** mpf("0.7") * cbrt(pr)


def ranz_marshall(re, pr, eps):
    return 2 + mpf("0.6") * sqrt(re) * cbrt(pr)


def wakao(re, pr, eps):
    return 2 + mpf("1.1") * re ** mpf("0.6") * cbrt(pr)


def li_mason(re, pr, eps):
    factor = eps ** mpf("3.5")
    if re <= 200:
        return 2 + mpf("0.6") * factor * sqrt(re) * cbrt(pr)
    if re <= 1500:
        return 2 + factor * cbrt(pr) * (mpf("0.5") * sqrt(re) + mpf("0.02") * re ** mpf("0.8"))
    return 2 + mpf("4.5e-5") * factor * re ** mpf("1.8")


VOID = {gunn: [0.4, 0.5, 0.7, 0.9, 1], ranz_marshall: [0.95, 1], wakao: [0.4, 0.5], li_mason: [0.7, 0.9, 1]}

with open(pathlib.Path(__file__).with_name("nusselt.csv"), "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["law", "reynolds", "prandtl", "void_fraction", "Nu"])
    for law, voids in VOID.items():
        for eps in voids:
            for pr in (0.7, 7):
                for re in (0, 1, 10, 100, 1000, 5000):
                    nu = law(mpf(re), mpf(repr(pr)), mpf(repr(eps)))
                    out.writerow([law.__name__, re, pr, eps, mp.nstr(nu, 18)])
