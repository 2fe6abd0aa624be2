"""Profiles of compared runs at the same times on the same axes (`polder compare`), beside the references of the case.

Between two times at which a run recorded one a profile is linear in time, as in the table of differences.
"""
import os

import numpy as np

import figure_style as style
from compare_figures import draw_references, legend_below, shown_unit
from history_figures import finish_panel, readable, split_unit

MOST_TIMES = 5  # of one profile
SAME_TIME = 1e-6  # share of the run


class Profile:
    """What one run recorded: rows by the time since the comparison begins."""

    def __init__(self, run, measure):
        table = run.results.table(f"profile_{measure['name']}.csv")
        self.times, self.rows, self.coordinate, self.upwards = [], {}, "", False
        if table is None:
            return
        coordinate, quantity = list(table)[1:3]
        self.coordinate = split_unit(coordinate)[0]
        self.upwards = self.coordinate.endswith(run.results.vertical())
        for seconds in np.unique(table["time[s]"]):
            at = np.flatnonzero(table["time[s]"] == seconds)
            at = at[np.argsort(table[coordinate][at], kind="stable")]
            self.rows[seconds - run.start] = (table[coordinate][at], table[quantity][at])
        self.times = sorted(self.rows)

    def at(self, time, slack):
        """(coordinate, value), None outside the times recorded."""
        after = next((t for t in self.times if t >= time - slack), None)
        if after is None:
            return None
        x, y = self.rows[after]
        if after <= time + slack:
            return x, y
        before = max((t for t in self.times if t < time), default=None)
        if before is None:
            return None
        later_x, later_y = x, y
        x, y = self.rows[before]
        return x, y + (time - before) / (after - before) * (np.interp(x, later_x, later_y) - y)


def draw_profile(comparison, axis, measure, path):
    """At some of the times compared, all in the same colours."""
    factor, unit = shown_unit(measure["unit"])
    times = measure["times"]
    chosen = [times[i] for i in sorted({int(i) for i in np.linspace(0, len(times) - 1, MOST_TIMES)})]
    quantity = readable(split_unit(measure["quantity"])[0])
    table = {"run": [], "time[s]": [], "coordinate[m]": [], f"{measure['quantity']}[{unit}]": []}
    upwards, name = False, ""
    for run in sorted(comparison.runs, key=lambda r: r.size, reverse=True):
        profile = Profile(run, measure)
        if not profile.times:
            continue
        upwards, name = profile.upwards, readable(profile.coordinate)
        for time in chosen:
            found = profile.at(time, SAME_TIME * comparison.end())
            if found is None:
                continue
            x, y = found[0], found[1] * factor
            axis.plot(*((y, x) if upwards else (x, y)), color=comparison.colour(run), linestyle=comparison.line(run),
                      linewidth=comparison.width(run))
            for key, values in zip(table, ([run.label] * len(x), [time] * len(x), x, y)):
                table[key].extend(values)
    draw_references(axis, comparison, measure, upwards)
    labels = (f"{quantity} [{unit}]", f"{name} [m]")
    axis.set_xlabel(labels[0] if upwards else labels[1])
    axis.set_ylabel(labels[1] if upwards else labels[0])
    divisor, time_unit = style.time_unit(comparison.end())
    axis.set_title(f"{measure['name']}, $t$ = {', '.join(f'{t / divisor:.3g}' for t in chosen)} {time_unit}", loc="left")
    style.save_table(path, table)


def draw(comparison, output):
    comparison.expects = False
    measures = [m for m in comparison.json["measures"]
                if m.get("times") and any(Profile(run, m).times for run in comparison.runs)]
    if not measures:
        return []
    figure, axes = style.grid_of_panels(len(measures), height=2.6)
    for number, (axis, measure) in enumerate(zip(axes, measures)):
        draw_profile(comparison, axis, measure, os.path.join(output, f"compare_profile_{measure['name']}.csv"))
        axis.set_title(f"{style.letter(number)}  {axis.get_title(loc='left')}", loc="left")
        finish_panel(axis)
    legend_below(comparison, figure)
    return [style.save_figure(figure, os.path.join(output, "compare_profiles.png"))]
