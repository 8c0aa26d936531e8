# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Snapshots of two dumps that belong to the same time step."""

from granflux_regress.bad_input import BadInput


def matched(reference, other, missing_steps):
    """Yields pairs of snapshots; what has no partner goes into `missing_steps` as a message. Holds
    one snapshot of each dump at a time."""
    a, b = next(reference, None), next(other, None)
    pairs = 0
    while a or b:
        if a and b and a.step == b.step:
            pairs += 1
            yield a, b
            a, b = next(reference, None), next(other, None)
        elif not b or (a and a.step < b.step):
            missing_steps.append(f"step {a.step}: missing snapshot")
            a = next(reference, None)
        else:
            missing_steps.append(f"step {b.step}: extra snapshot")
            b = next(other, None)
    if not pairs and not missing_steps:
        raise BadInput("neither dump has one of the steps of --step")
