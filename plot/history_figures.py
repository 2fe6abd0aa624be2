"""Histories of a run: balances, energies, step size and what limits it, from history.csv.

history.png holds the panels that tell whether a run can be trusted; whatever other numbers the table has are drawn in
history_other.png, one panel each.
"""
import os
import re

import matplotlib.ticker as ticker
import numpy as np

import figure_style as style

# Title, pattern of the columns (without unit), logarithmic. A column belongs to the first panel it matches.
PANELS = [
    ("Energy", r"energy_(error|defect|drift)|energy_balance.*", True, "energy_error"),
    ("Energy and work", r".*(energy|dissipat|work|transfer_loss).*", False, "energy"),
    ("Out-of-balance force ratio", r".*(unbalanced|out_of_balance).*", True, "unbalanced_force"),
    ("Mass error", r".*mass.*(error|drift|defect).*|.*(error|drift|defect).*mass.*", True, "mass_error"),
    ("Momentum defect", r".*momentum.*(error|drift|defect).*|.*(error|drift|defect).*momentum.*", True, "momentum"),
    ("Largest speed", r".*speed.*", False, "speed"),
    ("Pore-pressure roughness", r".*roughness.*", True, "roughness"),
    ("Discharge", r".*discharge.*", False, "discharge"),
    ("Exit gradient", r".*exit_gradient.*", False, "exit_gradient"),
]
COUNTERS = {"time[s]", "step", "dt[s]", "stage"}


def split_unit(column):
    match = re.fullmatch(r"(.*)\[(.*)\]", column)
    return match.groups() if match else (column, "")


def readable(name):
    return name.replace("_", " ")


def label_axis(axis, title, units):
    """What is drawn stands above the panel, its unit along the axis."""
    axis.set_title(title)
    units = sorted({unit for unit in units if unit})
    axis.set_ylabel(f"[{', '.join(units)}]" if units else "[-]")


def draw_lines(axis, time, table, columns, title, logarithmic):
    drawn = np.abs(np.stack([table[column] for column in columns]))
    positive = drawn[np.isfinite(drawn) & (drawn > 0)]
    logarithmic = logarithmic and positive.size > 0 and positive.max() > 10 * positive.min()
    negative = any(np.any(table[column] < 0) for column in columns)
    # What is exactly 0 is told by one line of the legend, it needs no curve.
    zero = [column for column in columns if not np.any(table[column] != 0)]
    for number, column in enumerate([column for column in columns if column not in zero] or zero):
        name, values = readable(split_unit(column)[0]), table[column]
        if len(zero) == len(columns):
            name += " (exactly 0)"
        if logarithmic:
            values = np.where(values != 0, np.abs(values), np.nan)  # zero has no place on this axis
        axis.plot(time, values, "-" if number < len(style.CYCLE) else "--", label=name)  # colours come round
    if logarithmic:
        axis.set_yscale("log")
        axis.yaxis.set_major_locator(ticker.LogLocator(numticks=6))
        axis.yaxis.set_minor_locator(ticker.NullLocator())
    label_axis(axis, title + (" (magnitude)" if logarithmic and negative else ""),
               [split_unit(column)[1] for column in columns])
    if zero and len(zero) < len(columns):
        axis.plot([], [], " ", label="exactly 0: " + ",\n".join(readable(split_unit(column)[0]) for column in zero))
    if len(columns) > 3 and not logarithmic:  # headroom, so that the legend covers no curve
        low, high = axis.get_ylim()
        axis.set_ylim(low, high + 0.8 * (high - low))
        axis.legend(loc="upper left", ncol=2)
    elif len(columns) > 1 or positive.size == 0:
        axis.legend(loc="best", ncol=1 if len(columns) < 5 else 2)


def draw_step(axis, time, table):
    """The step, coloured by what limits it."""
    dt = table["dt[s]"]
    limits = table.get("dt_limit")
    axis.plot(time, dt, color="0.7", linewidth=0.8)
    if isinstance(limits, list):
        for name in dict.fromkeys(limit for limit in limits if limit):  # none before the first step
            at = np.array([limit == name for limit in limits])
            axis.plot(time[at], dt[at], ".", markersize=3, label=readable(name))
        axis.legend(title="limited by", title_fontsize=7)
    if np.nanmin(dt) > 0 and np.nanmax(dt) > 20 * np.nanmin(dt):
        axis.set_yscale("log")
    else:
        axis.set_ylim(0, 1.25 * np.nanmax(dt) if np.nanmax(dt) > 0 else 1)
    label_axis(axis, "Step", ["s"])


def finish_panel(axis):
    axis.grid(True, linewidth=0.3, color="0.88")
    axis.tick_params(direction="in", which="both", top=True, right=True)


def finish(figure, axes, unit, columns=2):
    for number, axis in enumerate(axes):
        axis.set_title(f"{style.letter(number)}  {axis.get_title()}", loc="left")
        axis.set_title("")
        axis.set_xlabel(f"$t$ [{unit}]" if number + columns >= len(axes) else "")
        finish_panel(axis)
        axis.margins(x=0.01)
    figure.align_ylabels(axes)


def draw(results, output):
    table = results.table("history.csv")
    if table is None:
        return []
    seconds = table["time[s]"]
    divisor, unit = style.time_unit(np.nanmax(np.abs(seconds)))
    time = seconds / divisor
    left = [c for c, values in table.items() if c not in COUNTERS and not isinstance(values, list)]
    panels = []
    for title, pattern, logarithmic, key in PANELS:
        columns = [column for column in left if re.fullmatch(pattern, split_unit(column)[0])]
        left = [column for column in left if column not in columns]
        if columns:
            panels.append((title if key != "energy_error" else "Energy error", columns, logarithmic, key))

    written = []
    has_step = "dt[s]" in table
    if panels or has_step:
        figure, axes = style.grid_of_panels(len(panels) + has_step)
        for axis, (title, columns, logarithmic, key) in zip(axes, panels):
            draw_lines(axis, time, table, columns, title, logarithmic)
            style.save_table(os.path.join(output, f"history_{key}.csv"),
                             {"time[s]": seconds, **{column: table[column] for column in columns}})
        if has_step:
            draw_step(axes[-1], time, table)
            columns = [column for column in ("dt[s]", "dt_limit") if column in table]
            style.save_table(os.path.join(output, "history_step.csv"),
                             {"time[s]": seconds, **{column: table[column] for column in columns}})
        finish(figure, axes, unit)
        written.append(style.save_figure(figure, os.path.join(output, "history.png")))
    if left:
        figure, axes = style.grid_of_panels(len(left), columns=3, height=1.5)
        for axis, column in zip(axes, left):
            draw_lines(axis, time, table, [column], readable(split_unit(column)[0]).capitalize(), False)
        style.save_table(os.path.join(output, "history_other.csv"),
                         {"time[s]": seconds, **{column: table[column] for column in left}})
        finish(figure, axes, unit, columns=3)
        written.append(style.save_figure(figure, os.path.join(output, "history_other.png")))
    return written
