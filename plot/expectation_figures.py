"""What a run was compared with (expectations.png): its profiles over their coordinate at the times recorded, and measures
over time, each beside the reference curve of its expectation. The references lie in the run's folder, named by its case.
"""
import os

import numpy as np

import figure_style as style
from history_figures import finish_panel, readable, split_unit

MOST_TIMES = 6  # of one profile
# Columns of probes.csv that are not called after their quantity.
SHORT = {"displacement_": "u", "velocity_": "v", "position_": "", "stress_": "s",
         "mean_effective_stress": "p", "deviatoric_stress": "q"}


def column_of(table, name):
    """The column of this name, given with or without its unit."""
    return next((c for c in table or {} if c == name or split_unit(c)[0] == name), None)


def measured_over_time(results, measure):
    """(seconds, values, unit), None if the run has no such column."""
    if measure.get("kind", "particle") == "history":
        table, names = results.table("history.csv"), [measure["quantity"]]
    else:
        table, quantity = results.table("probes.csv"), measure["quantity"]
        short = next((s + quantity[len(q):] for q, s in SHORT.items() if quantity.startswith(q)), quantity)
        names = [f"{measure['name']}:{quantity}", f"{measure['name']}:{short}"]
    column = next((c for c in (column_of(table, name) for name in names) if c), None)
    return (table["time[s]"], table[column], split_unit(column)[1]) if column else None


def reference_curve(results, expectation, over_time):
    """(coordinate, values) of the reference, None if it is not there."""
    table = results.table(expectation["reference"], needs_time=False)
    if table is None:
        return None
    columns = list(table)
    x = columns[0]
    if over_time:
        x = column_of(table, "time") or column_of(table, "t") or x
    value = column_of(table, expectation["column"]) if expectation.get("column") else columns[1]
    return (table[x], table[value]) if value else None


def stage_start(results, expectation):
    """Start of from_stage [s]: the time of the first row of the history in that stage."""
    name, history = expectation.get("from_stage"), results.table("history.csv")
    names = [stage["name"] for stage in results.case().get("stage", [])]
    if not name or history is None or name not in names:
        return 0.0
    at = np.flatnonzero(history["stage"] >= names.index(name))
    return float(history["time[s]"][at[0]]) if at.size else 0.0


def draw_profile(axis, results, measure, expectations):
    """Coordinates that point up are drawn upwards. Returns the columns behind the panel."""
    table = results.table(f"profile_{measure['name']}.csv")
    if table is None:
        return None
    coordinate, quantity = list(table)[1:3]
    upwards = coordinate.split("[")[0].endswith(results.vertical())
    seconds = table["time[s]"]
    times = np.unique(seconds)
    wanted = [stage_start(results, e) + e["time"] for e in expectations if "time" in e]
    chosen = {int(np.argmin(np.abs(times - t))) for t in wanted} | {len(times) - 1}
    for i in np.unique(np.linspace(0, len(times) - 1, MOST_TIMES).astype(int)):
        if len(chosen) < MOST_TIMES:
            chosen.add(int(i))
    order = (lambda x, y: (y, x)) if upwards else (lambda x, y: (x, y))
    for number, i in enumerate(sorted(chosen)):
        at = seconds == times[i]
        axis.plot(*order(table[coordinate][at], table[quantity][at]), "o", markersize=2.2, markeredgewidth=0,
                  color=style.CYCLE[number % len(style.CYCLE)], label=style.time_text(times[i], times[-1]))
    labelled = False
    for expectation in expectations:
        curve = reference_curve(results, expectation, over_time=False) if "reference" in expectation else None
        if curve is not None:
            axis.plot(*order(*curve), color="black", linewidth=0.8, zorder=0,
                      label="" if labelled else "reference")
            labelled = True
    name, unit = split_unit(quantity)
    label, other = f"{readable(name)} [{unit}]", f"{readable(split_unit(coordinate)[0])} [m]"
    axis.set_xlabel(label if upwards else other)
    axis.set_ylabel(other if upwards else label)
    return table


def draw_history(axis, results, measure, expectations):
    measured = measured_over_time(results, measure)
    if measured is None:
        return None
    seconds, values, unit = measured
    axis.plot(seconds, values, label=measure["name"])
    columns = {"time[s]": seconds, f"{measure['name']}[{unit}]": values}
    for number, expectation in enumerate(expectations):
        curve = reference_curve(results, expectation, over_time=True)
        if curve is not None:
            axis.plot(curve[0] + stage_start(results, expectation), curve[1], "--", color="black", linewidth=0.8,
                      label="" if number else "reference")
    axis.set_xlabel("$t$ [s]")
    axis.set_ylabel(f"{readable(split_unit(measure['quantity'])[0])} [{unit}]")
    return columns


def draw(results, output):
    case = results.case()
    panels = []
    for measure in case.get("measure", []):
        expectations = [e for e in case.get("expect", []) if e["measure"] == measure["name"]]
        if measure.get("kind") in ("particles", "cells"):
            panels.append((draw_profile, measure, expectations))
        elif any("reference" in e for e in expectations):
            panels.append((draw_history, measure, [e for e in expectations if "reference" in e]))
    if not panels:
        return []
    figure, axes = style.grid_of_panels(len(panels), height=2.4)
    drawn = False
    for number, (axis, (draw_panel, measure, expectations)) in enumerate(zip(axes, panels)):
        columns = draw_panel(axis, results, measure, expectations)
        if columns is None:
            axis.remove()
            continue
        drawn = True
        axis.set_title(f"{style.letter(number)}  {measure['name']}", loc="left")
        axis.legend()
        finish_panel(axis)
        style.save_table(os.path.join(output, f"expectations_{measure['name']}.csv"), columns)
    if not drawn:
        return []
    return [style.save_figure(figure, os.path.join(output, "expectations.png"))]
