#!/usr/bin/env python3
"""Draws the tables of `polder bench`: bench_figures.py FILE.csv, a PNG beside it.

throughput: particle-steps per second of every run, with one thread and with all; scaling: cost and memory of a point
against the number of points; precision: error against seconds; stability: maps, a figure each.
"""
import csv
import os
import sys

import matplotlib

matplotlib.use("Agg")
import figure_style
import matplotlib.pyplot as plt
import numpy as np
from bench_fronts import draw_precision
from bench_maps import draw_stability


def read(path):
    """Comment lines (the machine) and rows as dictionaries."""
    with open(path, newline="") as file:
        lines = file.read().splitlines()
    machine = [line[2:] for line in lines if line.startswith("# ")]
    return machine, list(csv.DictReader(line for line in lines if not line.startswith("# ")))


def draw_throughput(rows, figure):
    every = [name for name in rows[0] if name.endswith("[M/s]")]
    groups = [[r for r in rows if r["run"].startswith(d)] for d in ("2D", "3D")]
    groups = [g for g in groups if g]
    figure.set_size_inches(figure_style.WIDTH, 0.2 * len(rows) + 1.6)
    axes = figure.subplots(len(groups), 1, squeeze=False, gridspec_kw={"height_ratios": [len(g) for g in groups]})[:, 0]
    for ax, group in zip(axes, groups):
        at = np.arange(len(group))
        for i, column in enumerate(every):
            values = [float(r[column] or "nan") for r in group]
            ax.barh(at + (i - 0.5) * 0.38, values, height=0.36, label=column.replace(" [M/s]", ""))
        ax.set_yticks(at, [r["run"] for r in group])
        ax.invert_yaxis()
        ax.set_xlabel("million particle-steps per second")
        ax.legend(loc="lower right")


def draw_scaling(rows, figure):
    figure.set_size_inches(figure_style.WIDTH, 2.8)
    cost, memory = figure.subplots(1, 2)
    threads = [name for name in rows[0] if "thread" in name]
    for d, marker in (("2", "o"), ("3", "s")):
        group = [r for r in rows if r["dimension"] == d]
        points = [float(r["points"]) for r in group]
        for column in threads:
            values = [float(r[column]) for r in group]
            cost.loglog(points, values, marker=marker, markersize=3, label=f"{d}D, {column.split(' [')[0]}")
        for column, line in (("bytes per point", "-"), ("with a frame", "--"), ("with all fields", ":")):
            values = [float(r[column]) for r in group]
            memory.semilogx(points, values, line, marker=marker, markersize=3, label=f"{d}D, {column}")
    cost.set_ylabel("ns per point and step")
    memory.set_ylabel("bytes per point")
    memory.set_ylim(bottom=0)
    for ax in (cost, memory):
        ax.set_xlabel("points")
        ax.grid(alpha=0.3, which="both", linewidth=0.4)
        ax.legend()


def main(argv):
    if len(argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    machine, rows = read(argv[1])
    kind = os.path.splitext(os.path.basename(argv[1]))[0]
    if kind == "stability" and rows:
        draw_stability(rows, machine, os.path.dirname(argv[1]))
        return 0
    draw = {"throughput": draw_throughput, "scaling": draw_scaling, "precision": draw_precision}.get(kind)
    if draw is None or not rows:
        print(f"error: {argv[1]} is no table of a benchmark with a figure", file=sys.stderr)
        return 2
    figure = plt.figure(layout="constrained")
    draw(rows, figure)
    figure.suptitle("; ".join(machine), fontsize=6)
    path = os.path.splitext(argv[1])[0] + ".png"
    figure.savefig(path)
    print(path)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
