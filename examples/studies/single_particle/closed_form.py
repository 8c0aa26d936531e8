#!/usr/bin/python3
# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Speed and way of a sphere that falls from rest through air of unlimited extent: the numbers of study.toml.

m dv/dt = (m - rho V) g - 3 pi mu d v (1 + 0.15 Re^0.687), Re = rho v d/mu (Schiller, Naumann 1933).
"""

import math

D, SOLID, RHO, MU, G = 1e-4, 1000.0, 1.2, 1.8e-5, 9.81
VOLUME = math.pi / 6 * D**3


def acceleration(v):
    drag = 3 * math.pi * MU * D * v * (1 + 0.15 * (RHO * abs(v) * D / MU) ** 0.687)
    return (1 - RHO / SOLID) * G - drag / (SOLID * VOLUME)


def fall(end=0.12, steps=120_000):
    """Speed and way at the time `end`, and the mean of the speeds at 0.1, 0.101 ... 0.12 s, by Runge and Kutta."""
    h, v, way, speeds = end / steps, 0.0, 0.0, []
    for step in range(1, steps + 1):
        a = acceleration(v)
        b = acceleration(v + h / 2 * a)
        c = acceleration(v + h / 2 * b)
        d = acceleration(v + h * c)
        way += h * v + h * h / 6 * (a + b + c)
        v += h / 6 * (a + 2 * b + 2 * c + d)
        if step >= steps * 5 // 6 and step % (steps // 120) == 0:
            speeds.append(v)
    return v, way, sum(speeds) / len(speeds)


def terminal():
    low, high = 0.0, 1.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if acceleration(middle) > 0 else (low, middle)
    return low


if __name__ == "__main__":
    v, way, mean = fall()
    print(f"terminal {terminal():.8g} m/s; at 0.12 s {v:.8g} m/s, {1e3 * way:.8g} mm; mean from 0.1 s {mean:.8g} m/s")
