# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The Pareto front: what nothing else beats in cost and error at once."""


def front(points):
    """Indices of the points (cost, error) that no other one equals or beats in both, the quickest first."""
    order = sorted(range(len(points)), key=lambda i: points[i])
    out, least = [], float("inf")
    for i in order:
        if points[i][1] < least:
            out.append(i)
            least = points[i][1]
    return out
