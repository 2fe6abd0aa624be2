"""Maps of `polder bench stability`: what becomes of a small block of soil at every place, a figure a map and a panel a
scheme, with the limit of theory and the one that the program prints."""
import math
import os

import figure_style
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

MARKS = ["stable", "drift", "noise", "grows", "broke down"]
COLOURS = ["#DCE9F2", "#F0E442", "#E69F00", "#D55E00", "#5A1E1E"]


def number(text):
    return float(text) if text else math.nan


def places(group, column):
    return sorted({float(r[column]) for r in group})


def draw_map(name, rows, machine, path):
    schemes = list(dict.fromkeys(r["scheme"] for r in rows))
    columns = min(3, len(schemes))
    lines = math.ceil(len(schemes) / columns)
    height = 1.9 * lines + 0.6
    figure = plt.figure(figsize=(figure_style.WIDTH, height))
    figure.set_layout_engine("constrained", rect=(0, 0.25 / height, 1, 1 - 0.25 / height))  # the legend below
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    for ax in panels[len(schemes):]:
        ax.set_axis_off()
    for ax, scheme in zip(panels, schemes):
        group = [r for r in rows if r["scheme"] == scheme]
        x, y = places(group, "x"), places(group, "y")
        field = np.full((len(y), len(x)), np.nan)
        for r in group:
            field[y.index(float(r["y"])), x.index(float(r["x"]))] = MARKS.index(r["mark"])
        ax.imshow(field, origin="lower", aspect="auto", cmap=ListedColormap(COLOURS),
                  norm=BoundaryNorm(np.arange(-0.5, len(MARKS)), len(MARKS)), interpolation="nearest")
        ax.set_xticks(range(len(x)), [words(r, "x") for r in first_of(group, "x", x)], rotation=60)
        ax.set_yticks(range(len(y)), [words(r, "y") for r in first_of(group, "y", y)])
        ax.tick_params(labelsize=5, length=1.5, pad=1)
        ax.set_title(scheme, fontsize=7, pad=2)
        if any(r["printed limit over chosen"] for r in group):
            log = np.log(y)
            at = lambda value: np.interp(np.log(value), log, np.arange(len(y)), left=np.nan, right=np.nan)
            column = [next(r for r in group if float(r["x"]) == value) for value in x]
            ax.axhline(at(1.0), color="black", linewidth=0.8)
            for key, style in (("theory over chosen", ":"), ("printed limit over chosen", "--")):
                ax.plot(range(len(x)), [at(v) if (v := number(r[key])) > 0 else np.nan for r in column], style,
                        color="black", linewidth=1.1)
    for ax in panels[max(0, len(schemes) - columns):len(schemes)]:
        ax.set_xlabel(rows[0]["x axis"], fontsize=6)
    for ax in panels[:len(schemes):columns]:
        ax.set_ylabel(rows[0]["y axis"], fontsize=6)
    handles = [Patch(color=c, label=m) for m, c in zip(MARKS, COLOURS)]
    if rows[0]["y axis"].startswith("step"):
        handles += [plt.Line2D([], [], color="black", linewidth=w, linestyle=s, label=t)
                    for s, w, t in (("-", 0.8, "chosen step"), ("--", 1.1, "printed limit"), (":", 1.1, "theory"))]
    figure.legend(handles=handles, loc="lower center", ncols=len(handles), fontsize=6)
    figure.suptitle(name + "; " + "; ".join(machine), fontsize=5)
    figure.savefig(path)
    plt.close(figure)
    print(path)


def first_of(group, column, values):
    return [next(r for r in group if float(r[column]) == value) for value in values]


def words(row, column):
    return row[column + " in words"] or f"{float(row[column]):g}"


def draw_stability(rows, machine, folder):
    for name in dict.fromkeys(r["map"] for r in rows):
        draw_map(name, [r for r in rows if r["map"] == name], machine, os.path.join(folder, f"stability_{name}.png"))
