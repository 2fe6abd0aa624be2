"""Seepage (`polder seepage`): flow net over the heads, degree of saturation or pore pressure, and discharges in time.

flow.json, stream_function.csv, the frames of the set fluid, phreatic.csv and history.csv are read; a run's folder has no
flow.json. Equipotentials: contours of the head through the centres of the cells; streamlines: contours of the stream
function through the nodes, each tube carrying the same discharge.
"""
import os

import matplotlib.patheffects as patheffects
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.lines import Line2D

import figure_style as style
from field_figures import NAMED
from results import read_json

DROPS, TUBES = 12, 8  # of head and of discharge between the lines drawn
HEAD, STREAM, SURFACE = "0.25", "#D55E00", "#0072B2"


def lattice(x, y, values):
    """Values at the points of a square lattice as a masked array over its rows and columns."""
    xs, ys = np.unique(np.round(x, 9)), np.unique(np.round(y, 9))
    field = np.full((len(ys), len(xs)), np.nan)
    field[np.searchsorted(ys, np.round(y, 9)), np.searchsorted(xs, np.round(x, 9))] = values
    return xs, ys, np.ma.masked_invalid(field)


def contours(axis, x, y, values, count, colour, width):
    """`count` intervals between the least and the largest value; nothing where there is no difference."""
    low, high = float(np.min(values)), float(np.max(values))
    if not high - low > 1e-9 * max(abs(low), abs(high)) or len(np.unique(x)) < 2 or len(np.unique(y)) < 2:
        return
    levels = np.linspace(low, high, count + 1)[1:-1]
    axis.contour(*lattice(x, y, values), levels=levels, colors=colour, linewidths=width, linestyles="solid")


def draw_cells(axis, shapes, values, colours, limits):
    drawn = PolyCollection(shapes, array=values, cmap=colours, linewidths=0, antialiaseds=False)
    drawn.set_clim(*limits)
    axis.add_collection(drawn)
    return drawn


def draw_net(results, output, result):
    series = next((s for s in results.series if s.name == "fluid"), None)
    if series is None:
        return None
    frame = series.frames[-1]
    points, cells = frame.points(), frame.cells()
    if len(cells) == 0 or cells.shape[1] != 4:
        return None
    shapes = points[cells][:, :, :2]
    centre = shapes.mean(axis=1)
    head = frame.read("CellData/head").astype(float)
    pressure = frame.read("CellData/pore_pressure").astype(float)
    wet = pressure > 0 if np.any(pressure > 0) else np.ones(len(head), bool)
    second = "saturation" if "saturation" in series.names() else "pore_pressure"
    field = NAMED[second]
    shown = frame.read(f"CellData/{field.array}").astype(float) * field.factor
    (left, bottom), (right, top) = shapes.reshape(-1, 2).min(axis=0), shapes.reshape(-1, 2).max(axis=0)
    margin = 0.02 * max(right - left, top - bottom)
    side_by_side = top - bottom > 0.6 * (right - left)
    figure, axes = plt.subplots(1 if side_by_side else 2, 2 if side_by_side else 1, constrained_layout=True,
                                figsize=(style.WIDTH, 3.6 if side_by_side else 4.2), squeeze=False)
    first, other = axes.flat
    limits = (head[wet].min(), head[wet].max())
    colours = draw_cells(first, shapes, head, NAMED["head"].colours, limits if limits[1] > limits[0] else (0, limits[1] or 1))
    spacing = float(np.ptp(shapes[0, :, 0]))
    below = head - centre[:, 1] > -spacing  # to the phreatic line; little flows above it
    below = below if np.any(below) else wet
    contours(first, centre[below, 0], centre[below, 1], head[below], DROPS, HEAD, 0.6)
    stream = results.table("stream_function.csv", needs_time=False)
    if stream is not None:
        contours(first, stream["x[m]"], stream["y[m]"], stream["stream_function[m2/s]"], TUBES, STREAM, 0.8)
    figure.colorbar(colours, ax=first, label="Hydraulic head [m]", shrink=0.8, extend="neither")
    low, high, extend = (shown.min(), 1.0, "neither") if second == "saturation" else style.robust_limits([shown])
    if not high > low:
        low = high - 1.0
    colours = draw_cells(other, shapes, shown, field.colours, (low, high))
    figure.colorbar(colours, ax=other, label=f"{field.label} [{field.unit}]", shrink=0.8, extend=extend)
    line = results.phreatic()(frame.time)
    for number, (axis, title) in enumerate(((first, "flow net"), (other, field.label.lower()))):
        if line is not None and len(line[0]) > 1:
            halo = [patheffects.withStroke(linewidth=2.4, foreground="white")]
            axis.plot(*line, color=SURFACE, linewidth=1.3, path_effects=halo)
        axis.set_xlim(left - margin, right + margin)
        axis.set_ylim(bottom - margin, top + margin)
        axis.set_aspect("equal")
        axis.set_xlabel("$x$ [m]")
        axis.set_ylabel("$y$ [m]")
        axis.set_title(f"{style.letter(number)}  {title}", loc="left")
        axis.tick_params(direction="in", top=True, right=True)
    steepest = result.get("largest_exit_gradient")
    if steepest:
        first.plot(*steepest["place"], "v", color="black", markersize=4, clip_on=False, zorder=5)
    handles = [Line2D([], [], color=HEAD, linewidth=0.8, label="equipotential"),
               Line2D([], [], color=STREAM, linewidth=0.8, label="streamline"),
               Line2D([], [], color=SURFACE, linewidth=1.3, label="phreatic line")]
    if steepest:
        handles.append(Line2D([], [], color="black", marker="v", markersize=4, linestyle="",
                              label=f"largest exit gradient {steepest['gradient']:.3g}"))
    figure.get_layout_engine().set(rect=(0, 0.06, 1, 0.94))
    figure.legend(handles=handles, loc="lower center", ncol=4)
    style.save_table(os.path.join(output, "seepage.csv"),
                     {"x[m]": centre[:, 0], "y[m]": centre[:, 1], "head[m]": head,
                      f"{second}[{field.unit}]": shown})
    return style.save_figure(figure, os.path.join(output, "seepage.png"))


def draw_discharges(results, output):
    table = results.table("history.csv")
    if table is None:
        return None
    columns = [c for c in table if c.startswith("discharge:") and np.any(table[c] != 0)]
    seconds = table["time[s]"]
    after = seconds > 0
    if not columns or np.count_nonzero(after) < 2:
        return None
    figure, axis = plt.subplots(figsize=(0.7 * style.WIDTH, 2.4), constrained_layout=True)
    # Steps on the way to a steady state grow by orders of magnitude.
    logarithmic = seconds[after][-1] > 1e3 * seconds[after][0] and np.count_nonzero(after) < 200
    divisor, unit = (1.0, "s") if logarithmic else style.time_unit(seconds[-1])
    for column in columns:
        name, _, rest = column.removeprefix("discharge:").partition("[")
        axis.plot(seconds[after] / divisor, table[column][after], label=name)
    if logarithmic:
        axis.set_xscale("log")
    axis.axhline(0, color="0.6", linewidth=0.5)
    axis.set_xlabel(f"$t$ [{unit}]")
    axis.set_ylabel(f"discharge out of the soil [{rest.rstrip(']')}]")
    axis.tick_params(direction="in", top=True, right=True, which="both")
    axis.legend()
    style.save_table(os.path.join(output, "discharges.csv"),
                     {"time[s]": seconds, **{column: table[column] for column in columns}})
    return style.save_figure(figure, os.path.join(output, "discharges.png"))


def draw(results, output):
    path = results.path("flow.json")
    if not os.path.exists(path):
        return []
    result = read_json(path)
    return [p for p in (draw_net(results, output, result), draw_discharges(results, output)) if p]
