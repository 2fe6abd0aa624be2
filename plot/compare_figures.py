"""Runs beside each other (`polder compare`): measures and balances on the same axes, cost, and what differs by how much.

compare.json is read, and the folders of the runs it names. Colour tells the variant (the formulation), line style the size
of cells and steps, the finest drawn solid. Times count from where the comparison begins, the end of the search for
equilibrium. Fields side by side are in compare_fields.py, profiles in
compare_profiles.py.
"""
import os

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

import figure_style as style
from expectation_figures import measured_over_time, reference_curve, stage_start
from history_figures import finish_panel, label_axis, readable, split_unit
from results import Results, read_json

LINES = ["-", "--", ":", "-.", (0, (6, 1, 1, 1, 1, 1)), (0, (1, 4))]
REFERENCE = (0, (3, 2))
FAR_APART = 20  # durations of stages
PARTS = [("mechanics", "mechanics"), ("water", "water"), ("audit", "balances"), ("output", "output"), ("other", "other")]
# Columns of the history, and whether on a logarithmic axis.
HISTORY = [("dt", False), ("kinetic_energy", False), ("max_speed", False), ("runout", False), ("height", False),
           ("max_pore_pressure", False), ("water_outflow", False), ("transfer_loss", False),
           ("pressure_roughness", True), ("solid_mass_error", True), ("water_mass_error", True),
           ("momentum_error", True)]


class Run:
    """One run of compare.json with the results in its folder."""

    def __init__(self, folder, entry):
        self.entry = entry
        self.label, self.variant = entry["label"], entry["variant"]
        self.failed = entry["status"] == "failed"
        self.results = Results(os.path.join(folder, entry["folder"]))
        self.start = entry["start"]
        self.stages = entry.get("stages", [])
        self.size = (entry["cell"], entry["courant"] or 0.0, entry["time_step"] or 0.0)

    def size_text(self, cells, steps):
        parts = [f"cell {self.size[0]:.4g} m"] if cells else []
        if steps:
            parts.append(f"courant {self.size[1]:.4g}" if self.size[1] else f"step {self.size[2]:.4g} s")
        return ", ".join(parts)


class Comparison:
    def __init__(self, folder):
        self.json = read_json(os.path.join(folder, "compare.json"))
        self.folder = folder
        self.runs = [Run(folder, entry) for entry in self.json["runs"] if "folder" in entry]
        self.variants = [v for v in self.json["variants"] if any(run.variant == v for run in self.runs)]
        self.sizes = sorted({run.size for run in self.runs})
        self.expects = False  # a reference has been drawn

    def colour(self, run):
        return style.CYCLE[self.variants.index(run.variant) % len(style.CYCLE)]

    def width(self, run):
        """Wider below, so that a curve under another one still shows."""
        return max(0.7, 1.7 - 0.7 * self.variants.index(run.variant))

    def line(self, run):
        return LINES[min(self.sizes.index(run.size), len(LINES) - 1)]

    def windows(self):
        """What is drawn in one picture: (suffix of its name, {run: (start, end)}). All of the time compared, or each
        stage for itself where their durations lie so far apart that the short ones would not be seen."""
        names = [stage["name"] for stage in max((run.stages for run in self.runs), key=len, default=[])]
        durations = [stage["time"] for run in self.runs for stage in run.stages if stage["time"] > 0]
        if len(names) < 2 or max(durations) < FAR_APART * min(durations):
            return [("", {run: (run.start, run.entry["time"]) for run in self.runs})]
        return [(f"_{name}", {run: (stage["start"], stage["start"] + stage["time"])
                              for run in self.runs for stage in run.stages[number:number + 1]})
                for number, name in enumerate(names)]

    def end(self):
        """The last time compared [s]."""
        return max((run.entry["time"] - run.start for run in self.runs), default=0.0)

    def legend(self):
        """Handles: colours of the variants, then lines of the sizes."""
        handles = [Line2D([], [], color=style.CYCLE[i % len(style.CYCLE)], label=v) for i, v in enumerate(self.variants)]
        if len(self.sizes) > 1:
            cells, steps = (len({size[i] for size in self.sizes}) > 1 for i in (0, slice(1, 3)))
            for size in self.sizes:
                run = next(r for r in self.runs if r.size == size)
                handles.append(Line2D([], [], color="0.4", linestyle=self.line(run), label=run.size_text(cells, steps)))
        if self.expects:
            handles.append(Line2D([], [], color="black", linewidth=0.7, linestyle=REFERENCE, label="reference of the case"))
        if any(run.failed for run in self.runs):
            handles.append(Line2D([], [], color="0.4", marker="x", linestyle="", markersize=5, label="failed here"))
        return handles


def shown_unit(unit):
    return (1e-3, "kPa") if unit == "Pa" else (1.0, unit)


def cut(window, seconds, values):
    """From start to end, times counted from the start."""
    start, end = window
    keep = (seconds >= start * (1 - 1e-9)) & (seconds <= end * (1 + 1e-9))
    return seconds[keep] - start, values[keep]


def longest(curves):
    """Of the times of curves, or of panels of them [s]."""
    return max((seconds[-1] for _, seconds, _ in curves if len(seconds)), default=0.0)


def history_curve(run, name):
    found = measured_over_time(run.results, {"kind": "history", "name": name, "quantity": name})
    return None if found is None or isinstance(found[1], list) else found


def draw_curves(comparison, axis, curves, span, title, quantity, unit, logarithmic, path):
    """curves: (run, seconds, values). Beside the picture a table with the rows of all runs one after the other."""
    factor, unit = shown_unit(unit)
    divisor, _ = style.time_unit(span)
    shown = [values * factor for _, _, values in curves]
    magnitude = np.abs(np.concatenate(shown)) if shown else np.array([])
    positive = magnitude[np.isfinite(magnitude) & (magnitude > 0)]
    logarithmic = logarithmic and positive.size > 0
    signed = logarithmic and any(np.any(values < 0) for values in shown)
    # The finest last, on top of the others.
    for (run, seconds, _), values in sorted(zip(curves, shown), key=lambda c: comparison.sizes.index(c[0][0].size), reverse=True):
        if logarithmic:
            values = np.where(values != 0, np.abs(values), np.nan)
        axis.plot(seconds / divisor, values, color=comparison.colour(run), linestyle=comparison.line(run),
                  linewidth=comparison.width(run))
        if run.failed and len(values):
            axis.plot(seconds[-1:] / divisor, values[-1:], "x", color=comparison.colour(run), markersize=5)
    if logarithmic:
        axis.set_yscale("log")
    if positive.size == 0:
        axis.text(0.5, 0.5, "exactly 0 in all runs", transform=axis.transAxes, ha="center", va="center", color="0.4",
                  backgroundcolor="white")
        axis.set_yticks([])
    label_axis(axis, title + (" (magnitude)" if signed else ""), [unit])
    if quantity:
        axis.set_ylabel(f"{quantity} {axis.get_ylabel()}")
    style.save_table(path, {
        "run": [run.label for run, seconds, _ in curves for _ in seconds],
        "time[s]": np.concatenate([seconds for _, seconds, _ in curves]),
        f"{(quantity or title).replace(' ', '_')}[{unit}]": np.concatenate(shown),
    })


def legend_below(comparison, figure):
    handles = comparison.legend()
    across = min(len(handles), 6 if figure.get_figwidth() > 6 else 3)
    band = (0.1 + 0.16 * -(-len(handles) // across)) / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, band, 1, 1 - band))
    figure.legend(handles=handles, loc="lower center", ncol=across)


def panels_with_legend(comparison, panels, picture, window):
    """panels: (title, quantity, unit, logarithmic, curves, table, measure or None)."""
    if not panels:
        return []
    span = max(longest(curves) for *_, curves, _, _ in panels)
    _, unit = style.time_unit(span)
    columns = 2 if len(panels) < 7 else 3
    figure, axes = style.grid_of_panels(len(panels), columns=columns, height=1.7)
    for number, (axis, (title, quantity, of, logarithmic, curves, path, measure)) in enumerate(zip(axes, panels)):
        draw_curves(comparison, axis, curves, span, title, quantity, of, logarithmic, path)
        if measure is not None:
            draw_references(axis, comparison, measure, window=window, span=span)
        axis.set_title(f"{style.letter(number)}  {axis.get_title()}", loc="left")
        axis.set_title("")
        axis.set_xlabel(f"$t$ [{unit}]" if number + columns >= len(axes) else "")
        finish_panel(axis)
        axis.margins(x=0.01)
    legend_below(comparison, figure)
    figure.align_ylabels(axes)
    return [style.save_figure(figure, picture)]


def draw_measures(comparison, output):
    written = []
    for suffix, window in comparison.windows():
        comparison.expects = False
        panels = []
        for measure in comparison.json["measures"]:
            if not measure["asked"] or measure["kind"] in ("stability", "particles", "cells"):
                continue
            curves = []
            for run in window:
                found = measured_over_time(run.results, measure)
                if found is not None:
                    curves.append((run, *cut(window[run], found[0], found[1])))
            if curves:
                name, quantity = measure["name"], readable(split_unit(measure["quantity"])[0])
                panels.append((name, quantity, measure["unit"], False, curves,
                               os.path.join(output, f"compare_measure_{name}{suffix}.csv"), measure))
        written += panels_with_legend(comparison, panels, os.path.join(output, f"compare_measures{suffix}.png"), window)
    return written


def own_steps(run, seconds, values):
    """Without steps that were cut short to end at a time asked for, and the state before the first."""
    limits = run.results.table("history.csv").get("dt_limit")
    keep = values > 0
    if isinstance(limits, list):
        limits = np.array(limits)
        keep &= (limits != "end of stage") & (limits != "time of an expectation")
    return seconds[keep], values[keep]


def draw_references(axis, comparison, measure, upwards=None, window=None, span=0.0):
    """What the case expects of the measure, thin and black: over time from where the comparison begins, or, where
    `upwards` says how it is drawn, over the coordinate of a profile."""
    for run in comparison.runs[:1]:
        for expectation in run.results.case().get("expect", []):
            if expectation["measure"] != measure["name"] or "reference" not in expectation:
                continue
            curve = reference_curve(run.results, expectation, over_time=upwards is None)
            if curve is None:
                continue
            x, y = curve[0], curve[1] * shown_unit(measure["unit"])[0]
            if upwards is None:
                if run not in window:
                    continue
                x, y = cut(window[run], x + stage_start(run.results, expectation), y)
                x = x / style.time_unit(span)[0]
            elif upwards:
                x, y = y, x
            axis.plot(x, y, color="black", linewidth=0.7, linestyle=REFERENCE, zorder=3)
            comparison.expects = True


def draw_history(comparison, output):
    written = []
    for suffix, window in comparison.windows():
        comparison.expects = False
        panels = []
        for name, logarithmic in HISTORY:
            curves, unit = [], ""
            for run in window:
                found = history_curve(run, name)
                if found is not None:
                    seconds, values, unit = found
                    if name == "dt":
                        seconds, values = own_steps(run, seconds, values)
                    seconds, values = cut(window[run], seconds, values)
                    if len(values):
                        curves.append((run, seconds, values))
            if curves and (logarithmic or name == "dt" or any(np.ptp(values) > 0 for _, _, values in curves)):
                title = "step" if name == "dt" else readable(name)
                panels.append((title, "", unit, logarithmic, curves,
                               os.path.join(output, f"compare_history_{name}{suffix}.csv"), None))
        written += panels_with_legend(comparison, panels, os.path.join(output, f"compare_history{suffix}.png"), window)
    return written


def short_time_unit(seconds):
    """Divisor and name for steps up to that long."""
    for divisor, name in ((1.0, "s"), (1e-3, "ms")):
        if seconds >= divisor:
            return divisor, name
    return 1e-6, "µs"


def draw_cost(comparison, output):
    """Wall time by part, step, and time per particle and step: one bar for each run."""
    runs = comparison.runs
    if not runs:
        return []
    figure, axes = plt.subplots(1, 3, figsize=(style.WIDTH, 0.9 + 0.22 * len(runs)), sharey=True, constrained_layout=True,
                                width_ratios=[2, 1, 1])
    place = np.arange(len(runs))[::-1]
    columns = {"run": [run.label for run in runs]}
    left = np.zeros(len(runs))
    for number, (key, name) in enumerate(PARTS):
        seconds = np.array([max(run.entry["wall_seconds"][key], 0.0) for run in runs])
        axes[0].barh(place, seconds, left=left, color=style.CYCLE[number] if key != "other" else "0.8", height=0.7)
        left += seconds
        columns[f"{name}[s]"] = seconds
    mean = np.array([run.entry["dt"]["mean"] for run in runs])
    least = np.array([run.entry["dt"]["min"] for run in runs])
    scale, unit = short_time_unit(mean.max())
    axes[1].barh(place, mean / scale, color="0.75", height=0.7)
    axes[1].plot(least / scale, place, "|", color="black", markersize=7)
    each = np.array([1e6 / run.entry["particle_steps_per_second"] if run.entry["particle_steps_per_second"] else np.nan
                     for run in runs])
    axes[2].barh(place, each, color="0.75", height=0.7)
    columns.update({"mean_step[s]": mean, "smallest_step[s]": least, "time_per_particle_step[us]": each,
                    "limited_by": [run.entry["dt"]["limited_by"] for run in runs]})
    axes[0].set_yticks(place, [run.label + (" (failed)" if run.failed else "") for run in runs])
    for number, (axis, label) in enumerate(zip(axes, ("wall time [s]", f"step [{unit}]: mean, smallest |",
                                                      "per particle and step [µs]"))):
        axis.set_title(style.letter(number), loc="left")
        axis.set_xlabel(label)
        axis.set_xlim(left=0)
        axis.set_axisbelow(True)
        finish_panel(axis)
    handles = [Patch(color=style.CYCLE[i] if key != "other" else "0.8", label=name) for i, (key, name) in enumerate(PARTS)]
    band = 0.26 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, band, 1, 1 - band))
    figure.legend(handles=handles, loc="lower center", ncol=len(PARTS))
    style.save_table(os.path.join(output, "compare_cost.csv"), columns)
    return [style.save_figure(figure, os.path.join(output, "compare_cost.png"))]


def draw_differences(comparison, output):
    """Difference of each pair of variants beside the discretisation error of both, for every quantity."""
    runs = comparison.json["runs"]
    pairs = {}
    for measure in comparison.json["measures"]:
        for d in measure["differences"]:
            names = (runs[d["first"]]["variant"], runs[d["second"]]["variant"])
            pairs.setdefault(names, []).append((measure["name"], d))
    if not pairs:
        return []
    rows = max(len(list_) for list_ in pairs.values())
    figure, axes = plt.subplots(len(pairs), 1, figsize=(0.8 * style.WIDTH, len(pairs) * (0.75 + 0.17 * rows) + 0.3),
                                squeeze=False, constrained_layout=True, sharex=True)
    table = {name: [] for name in ("first", "second", "quantity", "mean_square[-]", "largest[-]",
                                   "discretisation_error[-]", "beyond")}
    for number, (axis, ((first, second), list_)) in enumerate(zip(axes.flat, pairs.items())):
        place = np.arange(len(list_))[::-1]
        for at, (name, d) in zip(place, list_):
            if d["error_l2"] is not None:
                axis.barh(at, 100 * d["error_l2"], color="0.85", height=0.8)
            known = d["beyond"] != "not known"
            colour = style.CYCLE[1] if d["beyond"] == "yes" else style.CYCLE[0]
            for i, coarse in enumerate(d["l2_of_cells"][:-1]):
                axis.plot(100 * coarse, at, ".", color=colour, markersize=2.5 + i, alpha=0.5)
            axis.plot(100 * d["l2"], at, "o", color=colour, markersize=5, markerfacecolor=colour if known else "white")
            for key, value in zip(table, (first, second, name, d["l2"], d["max"],
                                          np.nan if d["error_l2"] is None else d["error_l2"], d["beyond"])):
                table[key].append(value)
        axis.set_yticks(place, [name for name, _ in list_])
        axis.set_title(f"{style.letter(number)}  {first} and {second}", loc="left")
        axis.set_xlim(left=0)
        finish_panel(axis)
    axes.flat[-1].set_xlabel("difference, root mean square over time [% of the scale]")
    handles = [Line2D([], [], color=style.CYCLE[1], marker="o", linestyle="", markersize=5, label="beyond the error"),
               Line2D([], [], color=style.CYCLE[0], marker="o", linestyle="", markersize=5, label="within"),
               Line2D([], [], color=style.CYCLE[0], marker="o", linestyle="", markersize=5, markerfacecolor="white",
                      label="error not known"),
               Line2D([], [], color="0.4", marker=".", linestyle="", markersize=3, label="in coarser cells"),
               Patch(color="0.85", label="discretisation error of both")]
    band = 0.42 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0, band, 1, 1 - band))
    figure.legend(handles=handles, loc="lower center", ncol=3)
    style.save_table(os.path.join(output, "compare_differences.csv"), table)
    return [style.save_figure(figure, os.path.join(output, "compare_differences.png"))]


def draw(comparison, output):
    written = []
    for draw_figure in (draw_measures, draw_history, draw_cost, draw_differences):
        written += draw_figure(comparison, output)
    return written
