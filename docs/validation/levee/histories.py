#!/usr/bin/python3
"""Draws histories.png and locking.png of this page from the folders of four runs: histories.py RUN RUN RUN RUN.

In this order: cells of 0.1 m, of 0.05 m, and the same two with numerics.locking = none. Times count from the end of the
initial equilibrium. Stresses are effective, positive in compression; p' and q are the three-dimensional invariants.
"""
import json
import os
import sys

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "..", "..", "plot"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")  # no display needed

import figure_style as style  # noqa: E402
from history_figures import finish_panel  # noqa: E402
from probe_figures import length, read_probes  # noqa: E402
from results import Results  # noqa: E402

KILO = 1e-3
ROUNDING = 1e-6  # [s] of times in tables, so that the state at the start counts
COARSE, FINE = "cells of 0.1 m", "cells of 0.05 m"


class Run:
    def __init__(self, folder, label, line_style):
        table = Results(folder).table("probes.csv")
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as file:
            start = json.load(file)["stages"][0]["time"]
        moving = table["time[s]"] > start - ROUNDING
        self.time = table["time[s]"][moving] - start
        self.probes = {
            name: {quantity: values[moving] for quantity, values in probe.items()}
            for name, probe in read_probes(table).items()
        }
        self.label, self.line_style = label, line_style


def pore_pressure(probe):
    return probe["pore_pressure"] * KILO


def vertical_effective_stress(probe):
    return -probe["syy"] * KILO


def displacement(probe):
    return length(probe, "u")


def draw_panel(axis, runs, names, pick, title, unit):
    for number, name in enumerate(names):
        for run in runs:
            axis.plot(run.time, pick(run.probes[name]), run.line_style, color=style.CYCLE[number], linewidth=0.9)
    axis.set_title(title, loc="left")
    axis.set_ylabel(f"[{unit}]")
    axis.set_xlabel("$t$ [s]")
    axis.margins(x=0.01)


def draw_path(axis, runs, name):
    for number, run in enumerate(runs):
        p, q = run.probes[name]["p"] * KILO, run.probes[name]["q"] * KILO
        colour = style.CYCLE[number]
        axis.plot(p, q, run.line_style, color=colour, linewidth=0.6, label=run.label)
        axis.plot(p[:1], q[:1], "o", color=colour, markerfacecolor="white", markersize=5, zorder=3)
        axis.plot(p[-1:], q[-1:], "s", color=colour, markersize=5, zorder=3)
    axis.set_title(f"(d)  Stress path of {name}; circle: start, square: end", loc="left")
    axis.set_xlabel("$p'$ [kPa]")
    axis.set_ylabel("$q$ [kPa]")


def draw_histories(runs, path):
    figure, axes = style.grid_of_panels(4, height=2.3)
    draw_panel(axes[0], runs, ["P1", "P2", "P3"], pore_pressure, "(a)  Pore pressure", "kPa")
    draw_panel(axes[1], runs, ["P1", "P2", "P3"], vertical_effective_stress, "(b)  Vertical effective stress", "kPa")
    draw_panel(axes[2], runs, ["C1", "C2", "C3", "C4"], displacement, "(c)  Displacement", "m")
    draw_path(axes[3], runs, "P3")
    styles = [axes[0].plot([], [], run.line_style, color="0.4", label=run.label)[0] for run in runs]
    panels = (["P1", "P2", "P3"], 0.44), (["P1", "P2", "P3"], 0.5), (["C1", "C2", "C3", "C4"], 0.16)
    for axis, (names, free_height) in zip(axes, panels):
        low, high = axis.get_ylim()
        axis.set_ylim(low, high + 0.15 * (high - low))  # headroom, so that the legend covers no curve
        axis.add_artist(axis.legend(handles=styles, loc="center right", bbox_to_anchor=(1.0, free_height)))
        colours = [axis.plot([], [], color=style.CYCLE[i], label=name)[0] for i, name in enumerate(names)]
        axis.legend(handles=colours, loc="upper right", ncol=len(names))
    axes[3].legend(loc="lower right")
    for axis in axes:
        finish_panel(axis)
    return style.save_figure(figure, path)


def draw_locking(averaged, single, path):
    figure, axes = style.grid_of_panels(2, height=2.3)
    for axis, name, pick, title, unit in (
        (axes[0], "C1", displacement, "(a)  Displacement of the crest, C1", "m"),
        (axes[1], "P3", pore_pressure, "(b)  Pore pressure at P3", "kPa"),
    ):
        for number, runs in enumerate((averaged, single)):
            for run in runs:
                label = f"{('cell average', 'none')[number]}, {run.label}"
                axis.plot(run.time, pick(run.probes[name]), run.line_style, color=style.CYCLE[number], label=label)
        axis.set_title(title, loc="left")
        axis.set_ylabel(f"[{unit}]")
        axis.set_xlabel("$t$ [s]")
        axis.margins(x=0.01)
        finish_panel(axis)
    axes[1].legend(loc="upper right")
    return style.save_figure(figure, path)


def main(folders):
    if len(folders) != 4:
        sys.exit(__doc__)
    labels = [(COARSE, "-"), (FINE, "--")] * 2
    runs = [Run(folder, *label) for folder, label in zip(folders, labels)]
    print(draw_histories(runs[:2], os.path.join(HERE, "histories.png")))
    print(draw_locking(runs[:2], runs[2:], os.path.join(HERE, "locking.png")))


if __name__ == "__main__":
    main(sys.argv[1:])
