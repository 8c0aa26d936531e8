# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""One readable page from the figures of paper.py."""

import html
import io

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PARTS = {"gas": "tab:blue", "exchange": "tab:orange", "particles": "tab:green"}
STYLE = """body { font: 15px/1.5 sans-serif; max-width: 60em; margin: 2em auto; color: #222 }
table { border-collapse: collapse; margin: 1em 0 } td, th { padding: .2em .8em; border-bottom: 1px solid #ccc }
td { text-align: right } td:first-child, th:first-child { text-align: left } svg { max-width: 100%; height: auto }"""


def as_svg(figure):
    text = io.StringIO()
    figure.savefig(text, format="svg")
    plt.close(figure)
    return text.getvalue().partition("<svg")[1] + text.getvalue().partition("<svg")[2]


def table(heads, rows):
    def line(cells, tag):
        return "<tr>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>\n"
    return "<table>\n" + line(heads, "th") + "".join(line(row, "td") for row in rows) + "</table>\n"


def range_of(found, form="{:.2f}"):
    return f"{form} ({form} to {form})".format(found["median"], found["min"], found["max"])


def bars(by_cores):
    ways = [(f"{name}, {cores} core{'s' * (int(cores) > 1)}", found) for cores, all_ in by_cores.items()
            for name, found in all_.items()]
    figure, axis = plt.subplots(figsize=(9, 0.45 * len(ways) + 1), layout="constrained")
    left = [0.0] * len(ways)
    for part, colour in PARTS.items():
        seconds = [found["seconds"][part]["median"] for _, found in ways]
        axis.barh(range(len(ways)), seconds, left=left, color=colour, label=part)
        left = [a + b for a, b in zip(left, seconds)]
    axis.set_yticks(range(len(ways)), [name for name, _ in ways])
    axis.invert_yaxis()
    axis.set_xlabel("time of the timed steps, s")
    axis.legend(ncol=3, loc="lower right")
    return as_svg(figure)


def curves(derived):
    figure, axis = plt.subplots(figsize=(7, 4.5), layout="constrained")
    for name in dict.fromkeys(name for ways in derived.values() for name in ways):
        points = [(int(count), ways[name]["slowest"]) for count, ways in derived.items() if name in ways]
        axis.loglog(*zip(*points), "o-", label=name)
    counts = [int(count) for count in derived]
    axis.set_xticks(counts, [str(count) for count in counts])
    axis.minorticks_off()
    axis.set_xlabel("ranks, or threads, or both")
    axis.set_ylabel("processor time of the slowest, s a step")
    axis.legend()
    return as_svg(figure)


def scene_section(title, scene):
    text = f"<h2>{html.escape(title)}</h2>\n<p>{html.escape(scene['what'])}</p>\n"
    text += f"<p>The paper: {html.escape(scene['paper'])}</p>\n"
    if "by_cores" in scene:
        text += bars(scene["by_cores"])
        rows = []
        for cores, ways in scene["by_cores"].items():
            for name, found in ways.items():
                s = found["seconds"]
                rows.append([f"{cores}: {name}", found["grid"], *(f"{s[p]['median']:.3g}" for p in PARTS),
                             range_of(s["total"], "{:.3g}"), range_of(found["OpenMP_over_this"]["particles"]),
                             range_of(found["OpenMP_over_this"]["total"]), f"{found['exchange_percent']['median']:.1f}",
                             f"{found['exchange_ns_a_particle_and_gas_step']['median']:.0f}",
                             f"{found['ghosts_a_rank']:.0f}", f"{found['most_particles_over_mean']:.2f}",
                             found["peak_memory"]])
        text += table(["cores: way", "grid", "gas, s", "exchange, s", "particles, s", "total, s",
                       "OpenMP over this, particles", "the same, total", "exchange, %", "exchange, ns a particle and gas step", "ghosts a rank",
                       "most particles over mean", "peak memory"], rows)
    if "derived" in scene:
        text += ("<p>Derived: ranks and threads take turns on the cores at hand; measured is the processor time of each, "
                 "waiting in MPI taken off. The slowest bounds what as many cores would take.</p>\n")
        text += curves(scene["derived"])
        rows = [[f"{count}: {name}", found["grid"], f"{1e3 * found['slowest']:.3g}", f"{1e3 * found['mean']:.3g}",
                 found["most_particles"], found["most_ghosts"]]
                for count, ways in scene["derived"].items() for name, found in ways.items()]
        text += table(["count: way", "grid", "slowest, ms a step", "mean, ms a step", "most particles of a rank",
                       "most ghosts of a rank"], rows)
    return text


def page(result):
    """The whole page. result: what tests/bench/run writes as JSON."""
    head = (f"<p>Revision {html.escape(result['revision'])}, {html.escape(result['cpu'])}, {result['cores']} cores. Values are "
            "medians (least to most) of rounds in which the ways take turns; compare ratios, not seconds.</p>")
    sections = "".join(scene_section(title, scene) for title, scene in result["scenes"].items())
    return (f"<!DOCTYPE html><html lang='en'><meta charset='utf-8'><title>GranFlux: the paper's timings</title>"
            f"<style>{STYLE}</style><h1>The timings of Amritkar, Deb and Tafti (2014), rebuilt</h1>{head}{sections}</html>\n")
