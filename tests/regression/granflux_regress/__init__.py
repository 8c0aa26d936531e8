# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Compares two dumps of LIGGGHTS or LAMMPS: particle by particle, or by their statistics."""
