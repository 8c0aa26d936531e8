# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""What a comparison by particles found, as text."""

SHOWN = 20  # messages and failures; more are counted


def report(comparison, verbose, out):
    """Prints; returns whether the dumps are equal."""
    for message in comparison.messages[:SHOWN]:
        print(message, file=out)
    failed = [d for d in comparison.differences if d.failed]
    for difference in comparison.differences if verbose else failed[:SHOWN]:
        print(_line(difference), file=out)
    hidden = len(comparison.messages[SHOWN:]) + (0 if verbose else len(failed[SHOWN:]))
    if hidden:
        print(f"and {hidden} more", file=out)
    steps = sorted({d.step for d in comparison.differences})
    compared = f"{len(steps)} snapshots, {comparison.rows} rows"
    worst = max(comparison.differences, key=lambda d: (d.failed, d.excess), default=None)
    if worst:
        compared += (f"; worst: {worst.quantity} of {worst.row} at step {worst.step}, "
                     f"{worst.relative:.2g} relative, {worst.distance:.2g} absolute "
                     f"(allowed {worst.allowed:.2g})")
    print(f"{'equal' if comparison.equal else 'DIFFERENT'}: {compared}", file=out)
    return comparison.equal


def _line(d):
    verdict = f"{d.count} further than allowed, worst" if d.failed else "largest difference"
    return (f"step {d.step}: {d.quantity}: {verdict} {d.row}: {_numbers(d.reference)} -> "
            f"{_numbers(d.value)}, apart {d.distance:.3g} = {d.relative:.3g} of {d.scale:.3g}; "
            f"allowed {d.allowed:.3g}")


def _numbers(values):
    text = " ".join(f"{value:.9g}" for value in values)
    return f"({text})" if len(values) > 1 else text
