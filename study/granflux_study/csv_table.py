# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Every run of a study as a line of comma-separated values."""

import csv

import numpy as np

from granflux_study.settings import named


def write_csv(path, study, errors, settings, front):
    """One line a setting; errors and their standard errors are relative, empty where a run failed."""
    heads = ["setting", *(knob.name for knob in study.knobs), "processor_s_per_s", "wall_s_per_s", "spread_of_runs", "pareto"]
    for quantity in study.quantities:
        unit = f"_{quantity.unit}" if quantity.unit else ""
        heads += [f"{quantity.name}{unit}", "standard_error", "error", "error_standard_error", "beyond_chance"]
    with open(path, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow([*heads, "failure", "program"])
        for setting in settings:
            run = errors.measured[setting]
            row = [named(study, setting), *setting.labels]
            row += ["", "", ""] if run.failure else [f"{run.cost:.5g}", f"{run.wall:.5g}", f"{run.spread:.3f}"]
            row.append("yes" if setting in front else "no")
            for quantity in study.quantities:
                if run.failure:
                    row += [""] * 5
                    continue
                value, error = run.values[quantity.name], errors.of(setting, quantity)
                row += [f"{np.mean(value.value):.8g}", f"{np.sqrt(np.mean(value.error**2)):.3g}", f"{error.size:.4g}",
                        f"{error.chance:.3g}", "yes" if error.told else "no"]
            out.writerow([*row, run.failure, " ".join(run.versions)])
