"""Error against seconds of every run of `polder bench precision`, one panel a benchmark, and the curve of those that no
other run beats."""
import itertools

import figure_style

MARKERS = "osD^v<>pPX*h"


def number(text):
    try:
        return float(text)
    except ValueError:
        return float("nan")  # a run that broke down


def draw_precision(rows, figure):
    names = list(dict.fromkeys(r["benchmark"] for r in rows))
    heights = [max(2.3, 0.115 * len({r["setting"] for r in rows if r["benchmark"] == name}) + 0.5) for name in names]
    figure.set_size_inches(figure_style.WIDTH, sum(heights) + 0.3)
    panels = figure.subplots(len(names), 1, squeeze=False, gridspec_kw={"height_ratios": heights})[:, 0]
    for ax, name in zip(panels, names):
        group = [r for r in rows if r["benchmark"] == name]
        settings = list(dict.fromkeys(r["setting"] for r in group))
        styles = zip(itertools.cycle(figure_style.CYCLE), itertools.cycle(MARKERS))  # 7 and 11: 77 pairs
        for setting, (colour, marker) in zip(settings, styles):
            runs = [r for r in group if r["setting"] == setting]
            default = runs[0]["default"] == "yes"
            # Runs of one step from cell to cell are a line.
            for i, step in enumerate(dict.fromkeys(r["step"] for r in runs)):
                line = [r for r in runs if r["step"] == step]
                ax.loglog([number(r["seconds"]) for r in line], [number(r["error"]) for r in line], color=colour,
                          marker=marker, markersize=4 if default else 3, linewidth=1.1 if default else 0.5,
                          markerfacecolor=colour if i == 0 else "none", markeredgewidth=0.6,
                          label=setting + (" (default)" if default else "") if i == 0 else None)
        best = sorted((number(r["seconds"]), number(r["error"])) for r in group if r["on the curve"] == "yes")
        ax.step([b[0] for b in best], [b[1] for b in best], where="post", color="black", linewidth=2.5, alpha=0.25,
                zorder=0, label="not beaten")
        ax.set_title(name, loc="left")
        ax.set_ylabel("error")
        ax.grid(alpha=0.3, which="major", linewidth=0.4)
        ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=5.5)
    panels[-1].set_xlabel("seconds of processor time")
