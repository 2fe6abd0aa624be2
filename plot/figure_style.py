"""What all figures share: type, colours, units of time, and how a figure and its tables are saved."""
import csv
import os

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

WIDTH = 7.2  # inches: a page's text width
# Okabe & Ito (2008): colours that stay apart for colour-blind readers and in grey.
CYCLE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]

plt.rcParams.update(
    {
        "font.size": 8,
        "axes.titlesize": 8,
        "axes.labelsize": 8,
        "legend.fontsize": 7,
        "xtick.labelsize": 7,
        "ytick.labelsize": 7,
        "axes.linewidth": 0.6,
        "lines.linewidth": 1.1,
        "axes.prop_cycle": plt.cycler(color=CYCLE),
        "axes.formatter.limits": (-3, 4),
        "axes.formatter.use_mathtext": True,
        "legend.framealpha": 0.8,
        "legend.edgecolor": "none",
        "legend.fancybox": False,
        "image.cmap": "viridis",
        "savefig.dpi": 200,
    }
)


def straight_map(name, first, last):
    """Colours along a straight line in OKLab (Ottosson 2020), a space in which equal distances look equal."""
    lab = np.linspace(first, last, 256)
    cone = lab @ np.array([[1, 1, 1], [0.3963377774, -0.1055613458, -0.0894841775],
                           [0.2158037573, -0.0638541728, -1.2914855480]])
    linear = cone**3 @ np.array([[4.0767416621, -1.2684380046, -0.0041960863],
                                 [-3.3077115913, 2.6097574011, -0.7034186147],
                                 [0.2309699292, -0.3413193965, 1.7076147010]])
    linear = np.clip(linear, 0.0, 1.0)
    return ListedColormap(np.where(linear > 0.0031308, 1.055 * linear ** (1 / 2.4) - 0.055, 12.92 * linear), name)


WATER = straight_map("water", (0.94, -0.025, -0.02), (0.33, -0.025, -0.09))  # pale to deep blue


def time_unit(span):
    """Divisor and name for times up to `span` seconds."""
    for seconds, name in ((86400.0, "d"), (3600.0, "h"), (60.0, "min")):
        if span >= 3 * seconds:
            return seconds, name
    return 1.0, "s"


def time_text(time, span):
    divisor, name = time_unit(span)
    return f"t = {time / divisor:.4g} {name}"


def letter(number):
    """(a), (b), ... (z), (aa)"""
    text = ""
    number += 1
    while number > 0:
        number, rest = divmod(number - 1, 26)
        text = chr(ord("a") + rest) + text
    return f"({text})"


def grid_of_panels(count, columns=2, height=1.7):
    """A figure with `count` axes in rows of `columns`."""
    rows = -(-count // columns)
    columns = min(columns, count)
    figure, axes = plt.subplots(
        rows, columns, figsize=(WIDTH if columns > 1 else 0.6 * WIDTH, height * rows + 0.3),
        squeeze=False, constrained_layout=True,
    )
    for spare in axes.flat[count:]:
        spare.remove()
    return figure, list(axes.flat[:count])


def save_table(path, columns):
    """columns: {name[unit]: values}, all of one length."""
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in zip(*columns.values()):
            writer.writerow([cell if isinstance(cell, str) else f"{cell:.8g}" for cell in row])


def save_figure(figure, path):
    """Under a temporary name first, so that a viewer never sees half a picture."""
    temporary = path + ".tmp"
    figure.savefig(temporary, format="png")
    plt.close(figure)
    os.replace(temporary, path)
    return path


def robust_limits(values):
    """Low and high colour limit and the colour bar's `extend`. From 0 if no value is negative; the extremes if they are
    near 0.5 and 99.5 % of the values, otherwise these, so that a few outliers do not use up the colours."""
    values = np.concatenate([v[np.isfinite(v)] for v in values]) if values else np.array([])
    if values.size == 0:
        return 0.0, 1.0, "neither"
    low, high = np.percentile(values, [0.5, 99.5])
    least, most = values.min(), values.max()
    reach = 0.25 * (high - low)
    low = least if least >= low - reach else low
    high = most if most <= high + reach else high
    low = 0.0 if low > 0 else low
    high = 0.0 if high < 0 else high
    if high - low <= 1e-12 * max(abs(high), abs(low)):
        low, high = min(least, 0.0), max(most, 0.0)
    if high <= low:
        high = low + 1.0
    below, above = least < low, most > high
    return low, high, {(0, 0): "neither", (1, 0): "min", (0, 1): "max", (1, 1): "both"}[(int(below), int(above))]
