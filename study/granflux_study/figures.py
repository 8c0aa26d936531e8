# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""Curves of error against cost, one for each knob, and the Pareto front."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from granflux_study.errors import CERTAIN
from granflux_study.settings import setting_of

# Told apart by all eyes (Okabe, Ito 2008), by marker as well.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000", "#8C6D31")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "*")
COST = "processor seconds for each simulated second"


def quantity_figure(study, errors, quantity):
    """Error of one quantity against cost, one curve a knob, all other knobs at their base."""
    figure, axis = _axes()
    lowest = _lowest([errors.of(_setting(study, k, level), quantity, [k]) for k in study.knobs for level in k.levels
                      if not errors.measured[_setting(study, k, level)].failure])
    for index, knob in enumerate(study.knobs):
        points = []
        for level in knob.levels:
            run = errors.measured[_setting(study, knob, level)]
            if not run.failure:
                points.append((run.cost, errors.of(run.setting, quantity, [knob]), level.label))
        _curve(axis, index, knob, points, lowest)
    base = setting_of(study, {})
    if errors.right_settings(study.knobs).get(base) != 1.0 or quantity.right is not None:
        _dots(axis, [(errors.measured[base].cost, errors.of(base, quantity).size)], lowest, "black", "*", "base, all knobs")
    else:
        axis.axvline(errors.measured[base].cost, color="0.6", linestyle=":", linewidth=1, label="base, compared with")
    if any(y <= 100 * lowest * 1.001 for line in axis.lines for y in _heights(line)):
        axis.axhline(100 * lowest, color="0.6", linestyle=":", linewidth=1, zorder=0)
        axis.text(0.005, 100 * lowest, "0, or less than can be shown", transform=axis.get_yaxis_transform(), fontsize=7,
                  color="0.4", va="bottom")
    axis.set_ylabel(f"error of {quantity.name}, %")
    return _finished(figure, axis)


def front_figure(study, errors, settings, front):
    """Worst error of all judged quantities against cost of every setting that was run, and their front."""
    figure, axis = _axes()
    points = {s: (errors.measured[s].cost, errors.worst(s)[0].bound) for s in settings if not errors.measured[s].failure}
    lowest = _lowest([errors.worst(s)[0] for s in points])
    base = setting_of(study, {})
    for index, knob in enumerate(study.knobs):
        mine = [points[s] for s in (_setting(study, knob, level) for level in knob.levels) if s in points and s != base]
        _dots(axis, mine, lowest, COLOURS[index % 8], MARKERS[index % 8], f"{knob.name} alone")
    single = {_setting(study, knob, level) for knob in study.knobs for level in knob.levels}
    _dots(axis, [p for s, p in points.items() if s not in single], lowest, "0.35", "h", "several knobs")
    _dots(axis, [points[base]], lowest, "black", "*", "base")
    steps = [points[s] for s in front]
    axis.step([c for c, _ in steps], [100 * max(e, lowest) for _, e in steps], where="post", color="0.5", linewidth=1,
              zorder=1, label="front")
    axis.set_ylabel("largest error, %")
    return _finished(figure, axis)


def _setting(study, knob, level):
    return setting_of(study, {knob.name: level.label})


def _axes():
    figure, axis = plt.subplots(figsize=(9, 5), layout="constrained")
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlabel(COST)
    axis.grid(True, which="major", color="0.9", linewidth=0.8)
    for side in ("top", "right"):
        axis.spines[side].set_visible(False)
    return figure, axis


def _lowest(errors):
    """The line on which an error of 0 is drawn, and any too small to tell: at least four decades below the largest."""
    sizes = [error.bound for error in errors if error.bound > 0] + [error.size for error in errors if error.size > 0]
    return max(min(sizes) / 3, max(sizes) * 1e-4) if sizes else 1e-6


def _curve(axis, index, knob, points, lowest):
    colour = COLOURS[index % 8]
    cost = [c for c, _, _ in points]
    size = [100 * max(e.size, lowest) for _, e, _ in points]
    reach = [100 * CERTAIN * e.chance for _, e, _ in points]
    line = [y if e.size > 0 else float("nan") for y, (_, e, _) in zip(size, points)]  # not to what it is compared with
    axis.plot(cost, line, color=colour, linewidth=1.2, label="_")
    axis.errorbar(cost, size, yerr=[[min(r, s - 100 * lowest / 2) for r, s in zip(reach, size)], reach], fmt="none",
                  ecolor=colour, elinewidth=0.8, capsize=2, alpha=0.7)
    for told in (True, False):
        chosen = [i for i, (_, e, _) in enumerate(points) if (e.told or e.size == 0) == told]
        axis.plot([cost[i] for i in chosen], [size[i] for i in chosen], linestyle="", color=colour,
                  marker=MARKERS[index % 8], markersize=6, markerfacecolor=colour if told else "white",
                  label=knob.name + (f", {knob.unit}" if knob.unit else "") if told else "_")
    for (c, _, label), y in zip(points, size):
        if label == knob.base:
            continue  # all curves pass through it
        text = axis.annotate(label, (c, y), xytext=(4, 5), textcoords="offset points", fontsize=7, color=colour)
        text.set_in_layout(False)


def _dots(axis, points, lowest, colour, marker, label):
    if points:
        axis.plot([c for c, _ in points], [100 * max(e, lowest) for _, e in points], linestyle="", color=colour,
                  marker=marker, markersize=9 if marker == "*" else 5, label=label)


def _finished(figure, axis):
    for one in (axis.xaxis, axis.yaxis):
        one.set_major_locator(LogLocator(subs=(1, 2, 5)))
        one.set_minor_locator(LogLocator(subs=range(1, 10)))
        one.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
        one.set_minor_formatter(NullFormatter())
    _thin_out(figure, axis)
    axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
    return figure


def _heights(line):
    return [float(y) for y in line.get_ydata()]


def _thin_out(figure, axis):
    """Takes away the labels that would cover earlier ones: the table has all."""
    figure.canvas.draw()
    kept = []
    for text in list(axis.texts):
        box = text.get_window_extent()
        if any(box.overlaps(other) for other in kept):
            text.remove()
        else:
            kept.append(box)
