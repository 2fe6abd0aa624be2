"""Fields of compared runs at the same times next to each other, with the same colours and axes (`polder compare`).

Where there are several variants each is shown by its finest run, else all sizes of the one. Times count from where the
comparison begins; the frame nearest to each is drawn, with its own time.
"""
import os

import numpy as np

import figure_style as style
from field_figures import (FLUID_DEFAULT, SOIL_DEFAULT, Section, box_around, colour_label, draw_panel, draw_phreatic,
                           find_field, layout, save_panel)
from results import PlotError

SHARES = [0.0, 0.25, 0.5, 1.0]  # of the time that all have
SHARES_OF_STAGES = [0.5, 1.0]  # where stages are drawn for themselves
MOST = 4  # runs in one figure
TALL = 1.5  # height over width beyond which everything stands in one row


def shown_runs(comparison):
    """Finest of each variant, or all of the only one from coarse to fine; None for those without a frame."""
    runs = [run for run in comparison.runs if run.results.series]
    if len(comparison.variants) == 1:
        return sorted(runs, key=lambda run: run.size, reverse=True)[-MOST:]
    finest = [min((run for run in runs if run.variant == v), key=lambda run: run.size, default=None)
              for v in comparison.variants]
    return [run for run in finest if run is not None][:MOST]


def short_label(comparison, run):
    return run.variant if len(comparison.variants) > 1 else run.size_text(True, len({r.size[1:] for r in comparison.runs}) > 1)


def series_of(run, name):
    return next((s for s in run.results.series if s.name == name), None)


class Moment:
    """A time of every run, counted from where the comparison or the stage of that name begins."""

    def __init__(self, stage, starts, since, span):
        self.stage, self.starts, self.span = stage, starts, span
        self.time = {run: start + since for run, start in starts.items()}

    def text(self, run, time):
        text = style.time_text(time - self.starts[run], self.span)
        return text.replace("t = ", f"{self.stage} ") if self.stage else text


class Panel:
    def __init__(self, run, frame, shapes, values, section):
        self.run, self.frame, self.shapes, self.values, self.section = run, frame, shapes, values, section


def read_panel(run, series_name, name, time):
    """None if the run has no such field; a panel without shapes where the set is empty at that time."""
    series = series_of(run, series_name)
    field = find_field(name, series) if series else None
    if field is None:
        return None
    frame = series.nearest([time])[0]
    full = next((f for f in series.frames if len(f.points()) > 0), frame)
    section = Section(full, series.kind)
    shapes, keep = section.shapes(frame)
    values = field.pick(frame.read(f"{series.kind}/{field.array}"), section.up)[keep] * field.factor
    return Panel(run, frame, shapes, values.astype(float), section)


def draw_field(comparison, runs, series_name, name, moments, output):
    """One figure; returns its path, None if there is nothing to see."""
    rows = [[read_panel(run, series_name, name, moment.time[run]) for run in runs] for moment in moments]
    panels = [panel for row in rows for panel in row if panel is not None and len(panel.shapes)]
    if not panels or not any(np.any(panel.values) for panel in panels):
        return None
    field = find_field(name, series_of(panels[0].run, series_name))
    section = max((panel.section for panel in panels), key=lambda s: s.spacing)
    box = box_around(np.concatenate([panel.shapes.reshape(-1, 2) for panel in panels]), section)
    aspect = box[3] / box[2]
    tall = aspect > TALL
    columns = len(runs) * (len(moments) if tall else 1)
    figure, axes, colour_axis = layout(len(runs) * len(moments), aspect, columns, title_lines=2 if tall else 1)
    low, high, extend = style.robust_limits([panel.values for panel in panels])
    drawn = None
    for number, (axis, panel) in enumerate(zip(axes, (panel for row in rows for panel in row))):
        run = runs[number % len(runs)]
        label = f"{style.letter(number)}  {short_label(comparison, run)}"
        axis.set_xlim(box[0], box[0] + box[2])
        axis.set_ylim(box[1], box[1] + box[3])
        if panel is None or len(panel.shapes) == 0:
            axis.set_title(label, loc="left")
            axis.text(0.5, 0.5, "no such field" if panel is None else "empty", transform=axis.transAxes, ha="center",
                      va="center", color="0.4", rotation=90 if tall else 0)
            continue
        drawn = draw_panel(figure, axis, panel.shapes, panel.values, field, (low, high), box, panel.section)
        draw_phreatic(axis, run.results.phreatic()(panel.frame.time), panel.section)
        time = moments[number // len(runs)].text(run, panel.frame.time)
        axis.set_title(label + ("\n" if tall else ", ") + time + (" (failed)" if run.failed else ""), loc="left")
        save_panel(os.path.join(output, f"compare_{series_name}_{name}_{comparison.runs.index(run) + 1}_"
                                        f"{panel.frame.number}.csv"),
                   panel.shapes, panel.values, name, field, panel.section)
    figure.colorbar(drawn, cax=colour_axis, label=colour_label(field, section), extend=extend)
    return style.save_figure(figure, os.path.join(output, f"compare_{series_name}_{name}.png"))


def draw(comparison, output, names, times):
    """names None: the usual fields; times [s], if given, count from where the comparison begins."""
    runs = shown_runs(comparison)
    if not runs:
        return []
    moments = []
    if times is not None:
        starts = {run: run.start for run in runs}
        moments = [Moment("", starts, time, comparison.end()) for time in times]
    else:
        windows = [(suffix, window) for suffix, window in comparison.windows() if all(run in window for run in runs)]
        for suffix, window in windows:
            both = min(window[run][1] - window[run][0] for run in runs)
            starts = {run: window[run][0] for run in runs}
            moments += [Moment(suffix.lstrip("_"), starts, share * both, both)
                        for share in (SHARES_OF_STAGES if suffix else SHARES)]
    written = []
    for series_name in dict.fromkeys(s.name for run in runs for s in run.results.series):
        fluid = series_name.split("_")[0] == "fluid"
        for name in names or (FLUID_DEFAULT if fluid else SOIL_DEFAULT):
            path = draw_field(comparison, runs, series_name, name, moments, output)
            written += [path] if path else []
    for name in names or []:
        if not any(find_field(name, s) for run in runs for s in run.results.series):
            raise PlotError(f"{name}: no frame of the runs in {comparison.folder} has such a field")
    return written
