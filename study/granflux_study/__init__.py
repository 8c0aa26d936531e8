# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""granflux_study: what accuracy costs. Runs a case over ladders of settings, measures error and processor time."""
