"""Factor of safety (`polder stability`): the mechanism with its slip surface, and what moves at which factor.

stability.json, trials.csv, slip_surface.csv and the frame of the set soil are read; a run's folder has none of them.
"""
import os

import matplotlib.patheffects as patheffects
import matplotlib.pyplot as plt
import numpy as np

import figure_style as style
from field_figures import Section
from results import PlotError, read_json


def number_text(value):
    return "none" if value is None else f"{value:.3f}"


def draw_mechanism(figure, axis, results, series, output):
    """Displacement of the mechanism over its largest value, which is arbitrary: the motion has no end."""
    frame = series.frames[-1]
    section = Section(frame, series.kind)
    shapes, keep = section.shapes(frame)
    motion = np.linalg.norm(frame.read("PointData/displacement"), axis=1)[keep].astype(float)
    share = motion / (np.percentile(motion, 99.5) or 1.0)
    x, y = shapes[:, 0].T
    left, right, bottom, top = x.min(), x.max(), y.min(), y.max()
    margin = 0.02 * (right - left) + 0.5 * section.spacing
    axis.set_xlim(left - margin, right + margin)
    axis.set_ylim(bottom - margin, top + margin)
    axis.set_aspect("equal")
    figure.canvas.draw()  # settles the axes, whose width decides that of a point
    width = section.spacing * 72 * axis.get_window_extent().width / figure.dpi / (right - left + 2 * margin)
    for widening in (1.4, 1.04):
        drawn = axis.scatter(x, y, s=(widening * width) ** 2, c=share, marker="s", linewidths=0, cmap="magma_r",
                             vmin=0, vmax=1, antialiaseds=False)
    slip = results.table("slip_surface.csv", needs_time=False)
    if slip is not None:
        halo = [patheffects.withStroke(linewidth=3.0, foreground="white")]
        axis.plot(slip["x[m]"], slip["y[m]"], color="#0072B2", linewidth=1.6, path_effects=halo, label="slip surface")
        axis.legend(loc="upper right")
    axis.set_xlabel("$x$ [m]")
    axis.set_ylabel("$z$ [m]" if section.three_d else "$y$ [m]")
    figure.colorbar(drawn, ax=axis, label="displacement over largest [-]", shrink=0.8)
    style.save_table(os.path.join(output, "stability_mechanism.csv"),
                     {"x[m]": x, "z[m]" if section.three_d else "y[m]": y, "displacement[m]": motion})


def draw_trials(axis, result, trials, output):
    factor, moved = trials["factor[-]"], trials["largest_displacement[m]"]
    order, stands = np.argsort(factor), trials["stands"] > 0
    standing = order[stands[order]]  # where a failing trial ended says nothing
    axis.plot(factor[standing], moved[standing], color="#0072B2", linewidth=0.8, zorder=1)
    axis.scatter(factor[stands], moved[stands], s=16, color="#0072B2", label="stands", zorder=2)
    axis.scatter(factor[~stands], moved[~stands], s=16, color="#D55E00", marker="x", label="fails", zorder=2)
    if result["factor_of_safety"] is not None:
        axis.axvline(result["factor_of_safety"], color="black", linewidth=0.8, linestyle="--", label="factor of safety")
    axis.set_yscale("log")
    axis.set_xlabel("reduction factor $F$ [-]")
    axis.set_ylabel("largest displacement [m]")
    axis.legend()
    style.save_table(os.path.join(output, "stability_trials.csv"),
                     {name: column[order] for name, column in trials.items()})


def draw(results, output):
    path = results.path("stability.json")
    if not os.path.exists(path):
        return []
    result = read_json(path)
    trials = results.table("trials.csv", needs_time=False)
    if trials is None:
        raise PlotError(f"{results.folder}: stability.json lies there without trials.csv", 4)
    soil = next((s for s in results.series if s.name == "soil"), None)
    panels = 1 if soil is None else 2
    figure, axes = plt.subplots(panels, 1, figsize=(style.WIDTH, 2.3 + 2.4 * (panels - 1)), squeeze=False,
                                constrained_layout=True, height_ratios=[1.2, 1][:panels])
    axes = list(axes.flat)
    if soil is not None:
        draw_mechanism(figure, axes[0], results, soil, output)
        axes[0].set_title(f"{style.letter(0)}  mechanism at $F$ = {result['mechanism']['factor']:.3f}", loc="left")
    draw_trials(axes[-1], result, trials, output)
    axes[-1].set_title(f"{style.letter(panels - 1)}  factor of safety {number_text(result['factor_of_safety'])}",
                       loc="left")
    return [style.save_figure(figure, os.path.join(output, "stability.png"))]
