# SPDX-FileCopyrightText: 2026 The GranFlux developers
# SPDX-License-Identifier: BSD-3-Clause
"""The report: one HTML file with its figures inside, and the figures as PNG files beside it."""

import html
import io
import re

import matplotlib
import matplotlib.pyplot as plt

from granflux_study.errors import CERTAIN
from granflux_study.figures import front_figure, quantity_figure
from granflux_study.settings import named, setting_of, unit_of

STYLE = """body{font:15px/1.5 system-ui,sans-serif;max-width:70em;margin:2em auto;padding:0 1em;color:#222}
table{border-collapse:collapse;margin:1em 0}td,th{padding:.2em .8em;border-bottom:1px solid #ddd;text-align:right}
td:first-child,th:first-child{text-align:left}.chance{color:#888}.failed{color:#b00}svg{max-width:100%;height:auto}
.told{background:#f3f6f9;padding:.6em 1em;border-left:4px solid #0072B2}"""


def write_report(folder, study, errors, settings, front, advice):
    """report.html and figures/*.png in `folder`. `advice`: sentences on wanted errors."""
    (folder / "figures").mkdir(exist_ok=True)
    drawn = [("front", "Every setting that was run: the largest error of the judged quantities",
              front_figure(study, errors, settings, front))]
    drawn += [(_file_name(q.name), f"Error of {q.name}: one knob at a time", quantity_figure(study, errors, q))
              for q in study.quantities]
    parts = [f"<h1>{html.escape(study.title)}</h1>", _introduction(study, errors)]
    parts += [f'<p class="told">{html.escape(line)}</p>' for line in advice]
    for name, heading, figure in drawn:
        figure.savefig(folder / "figures" / f"{name}.png", dpi=110)
        parts += [f"<h2>{html.escape(heading)}</h2>", _svg(figure, name)]
        plt.close(figure)
    parts += ["<h2>The front</h2>", _table(study, errors, front), "<h2>Every setting</h2>", _table(study, errors, settings)]
    versions = sorted({v for s in settings for v in errors.measured[s].versions})
    parts.append(f"<p>Made by {html.escape('; '.join(versions))}.</p>")
    text = (f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(study.title)}</title>'
            f"<style>{STYLE}</style></head><body>\n" + "\n".join(parts) + "\n</body></html>\n")
    (folder / "report.html").write_text(text)


def _introduction(study, errors):
    base = errors.measured[setting_of(study, {})]
    levels = ", ".join(f"{k.name} {k.base}{unit_of(study, k.name)}" for k in study.knobs)
    words = [f"Base: {levels}; {base.cost:.3g} processor seconds for each simulated second, {study.simulated_time:g} s simulated.",
             "Errors are relative."]
    if any(run.at_most for run in errors.measured.values()):
        words.append("Costs with < are upper bounds: these runs take hardly longer than their start-up.")
    if study.chaotic:
        words.append(f"Bars reach {CERTAIN:g} standard errors, from block averages. An open mark is a difference within "
                     "them: it is not called an error.")
        if not all(v.trusted for s in errors.measured.values() for v in s.values.values()):
            words.append("In some runs the window is too short for the block averages to settle: those errors are "
                         "likely larger than shown.")
    return f"<p>{html.escape(' '.join(words))}</p>"


def _svg(figure, salt):
    with matplotlib.rc_context({"svg.fonttype": "none", "svg.hashsalt": salt}):
        out = io.StringIO()
        figure.savefig(out, format="svg", metadata={"Date": None})
    text = out.getvalue()
    return text[text.index("<svg"):]


def _table(study, errors, settings):
    heads = ["setting", "cost", "times quicker than the base", *(q.name + (f", {q.unit}" if q.unit else "") for q in study.quantities),
             *(f"error of {q.name}" for q in study.quantities)]
    base = errors.measured[setting_of(study, {})].cost
    rows = ["<tr>" + "".join(f"<th>{html.escape(h)}</th>" for h in heads) + "</tr>"]
    for setting in settings:
        run = errors.measured[setting]
        cells = [html.escape(named(study, setting))]
        if run.failure:
            rows.append(f'<tr><td>{cells[0]}</td><td colspan="{len(heads) - 1}" class="failed">{html.escape(run.failure)}</td></tr>')
            continue
        cells += [("&lt; " if run.at_most else "") + f"{run.cost:.3g}", f"{base / run.cost:.3g}"]
        cells += [f"{run.values[q.name].value.mean():.6g}" if len(run.values[q.name].value) == 1 else "profile"
                  for q in study.quantities]
        cells += [_error(errors.of(setting, q)) for q in study.quantities]
        rows.append("<tr>" + "".join(f"<td>{cell}</td>" for cell in cells) + "</tr>")
    return "<table>" + "\n".join(rows) + "</table>"


def _error(error):
    text = html.escape(error.words())
    return text if error.told or error.chance == 0 else f'<span class="chance">{text}</span>'


def _file_name(name):
    return re.sub(r"[^a-z0-9]+", "_", name.lower()).strip("_")
