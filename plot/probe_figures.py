"""What the probes saw: histories (probes.png) and stress paths (stress_paths.png) from probes.csv.

Columns are NAME:quantity[unit]. Stresses in the table are effective and positive in tension; they are drawn positive in
compression. Stress paths use the invariants of the three-dimensional stress, p' = -tr(sigma')/3 and q = sqrt(3 J2).
"""
import os
import re

import numpy as np

import figure_style as style
from history_figures import finish, label_axis

KILO = 1e-3


def read_probes(table):
    """{probe: {quantity: values}} in the order of the table."""
    probes = {}
    for column, values in table.items():
        match = re.fullmatch(r"(.+):([^:\[]+)(?:\[.*\])?", column)
        if match and not isinstance(values, list):
            probes.setdefault(match.group(1), {})[match.group(2)] = values
    return probes


def different(probes):
    """Without those that follow a particle which another follows already, for another quantity."""
    kept = {}
    for name, probe in probes.items():
        same = [k for k in kept.values() if all(q in k and np.array_equal(k[q], probe.get(q), equal_nan=True)
                                                for q in ("x", "y"))]
        if "x" not in probe or not same:
            kept[name] = probe
    return kept


def length(probe, prefix):
    """Magnitude of a vector from its components, None if the table has none of them."""
    parts = [probe[prefix + axis] for axis in "xyz" if prefix + axis in probe]
    return np.sqrt(sum(part**2 for part in parts)) if parts else None


def vertical(probe):
    return "z" if "uz" in probe or "z" in probe else "y"


# Key, label, unit; each gives a list of (suffix, values, line style) for one probe.
def displacement(probe):
    lines = [("horizontal", probe.get("ux"), "-"), ("vertical", probe.get("u" + vertical(probe)), "--")]
    return [line for line in lines if line[1] is not None]


def one(values):
    return [("", values, "-")] if values is not None else []


def scaled(probe, name, factor):
    return probe[name] * factor if name in probe else None


HISTORIES = [
    ("displacement", "Displacement", "m", displacement),
    ("speed", "Speed", "m/s", lambda probe: one(length(probe, "v"))),
    ("pore_pressure", "Pore pressure", "kPa", lambda probe: one(scaled(probe, "pore_pressure", KILO))),
    ("vertical_effective_stress", "Vertical effective stress (compression +)", "kPa",
     lambda probe: one(scaled(probe, "s" + 2 * vertical(probe), -KILO))),
    ("deviatoric_strain", "Deviatoric plastic strain", "-",
     lambda probe: one(scaled(probe, "deviatoric_strain", 1.0))),
]


def draw_histories(seconds, probes, output):
    divisor, unit = style.time_unit(np.nanmax(np.abs(seconds)))
    panels = []
    for key, label, quantity_unit, pick in HISTORIES:
        lines = [(name, *line) for name, probe in probes.items() for line in pick(probe)]
        # Plastic strain of what stays elastic is no news.
        if lines and (key != "deviatoric_strain" or any(np.any(values > 0) for _, _, values, _ in lines)):
            panels.append((key, label, quantity_unit, lines))
    if not panels:
        return []
    figure, axes = style.grid_of_panels(len(panels) + 1)  # the last holds the legend of all
    legend = axes.pop()
    colour = {name: style.CYCLE[i % len(style.CYCLE)] for i, name in enumerate(probes)}
    for axis, (key, label, quantity_unit, lines) in zip(axes, panels):
        columns = {"time[s]": seconds}
        for name, suffix, values, line_style in lines:
            axis.plot(seconds / divisor, values, line_style, color=colour[name])
            columns[f"{name}:{suffix or key}[{quantity_unit}]"] = values
        label_axis(axis, label, [quantity_unit])
        style.save_table(os.path.join(output, f"probes_{key}.csv"), columns)
    finish(figure, axes, unit)
    for axis in axes[-2:]:
        axis.set_xlabel(f"$t$ [{unit}]")
    legend.axis("off")
    for name in probes:
        legend.plot([], [], color=colour[name], label=name)
    styles = {suffix: line_style for *_, lines in panels for _, suffix, _, line_style in lines if suffix}
    for suffix, line_style in styles.items():
        legend.plot([], [], line_style, color="0.4", label=suffix)
    legend.legend(loc="center", ncol=2)
    return [style.save_figure(figure, os.path.join(output, "probes.png"))]


def draw_stress_paths(seconds, probes, output):
    paths = {name: (probe["p"] * KILO, probe["q"] * KILO) for name, probe in probes.items()
             if "p" in probe and "q" in probe}
    if not paths:
        return []
    figure, (axis,) = style.grid_of_panels(1, columns=1, height=3.2)
    columns = {"time[s]": seconds}
    for i, (name, (p, q)) in enumerate(paths.items()):
        colour = style.CYCLE[i % len(style.CYCLE)]
        axis.plot(p, q, color=colour, label=name)
        axis.plot(p[:1], q[:1], "o", color=colour, markerfacecolor="white", markersize=4)
        axis.plot(p[-1:], q[-1:], "s", color=colour, markersize=4)
        columns[f"{name}:p[kPa]"], columns[f"{name}:q[kPa]"] = p, q
    axis.set_xlabel(r"$p' = -\mathrm{tr}(\sigma')/3$ [kPa]")
    axis.set_ylabel(r"$q = \sqrt{3 J_2}$ [kPa]")
    axis.set_xlim(left=min(0.0, axis.get_xlim()[0]))
    axis.set_ylim(bottom=0.0)
    axis.set_title("three-dimensional invariants; circle: start, square: end", loc="left", color="0.3")
    axis.grid(True, linewidth=0.3, color="0.88")
    axis.tick_params(direction="in", top=True, right=True)
    axis.legend()
    style.save_table(os.path.join(output, "stress_paths.csv"), columns)
    return [style.save_figure(figure, os.path.join(output, "stress_paths.png"))]


def draw(results, output):
    table = results.table("probes.csv")
    if table is None:
        return []
    probes = different(read_probes(table))
    return draw_histories(table["time[s]"], probes, output) + draw_stress_paths(table["time[s]"], probes, output)
