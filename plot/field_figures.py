"""Fields over the domain at a few times: one figure per set and field, panels stacked, one colour bar for all.

Soil is drawn as one square per material point, as wide as the points are apart; pore water in cells as the cells.
3D runs are drawn as a vertical section through the middle. Stresses are shown positive in compression.
"""
import os

import matplotlib.patheffects as patheffects
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

import figure_style as style
from results import PlotError

KILO = 1e-3
COMPONENTS = {"xx": 0, "yy": 1, "zz": 2, "xy": 3, "yz": 4, "zx": 5}


class Field:
    """array: name in the frame; pick(values, up): one number per point; factor: to the unit shown."""

    def __init__(self, array, label, unit, factor=1.0, pick=None, colours="viridis"):
        self.array, self.label, self.unit, self.factor, self.colours = array, label, unit, factor, colours
        self.pick = pick or (lambda values, up: values)


def magnitude(values, up):
    return np.linalg.norm(values, axis=1)


NAMED = {
    "deviatoric_strain": Field("deviatoric_strain", "Deviatoric plastic strain", "-", colours="magma_r"),
    "pore_pressure": Field("pore_pressure", "Pore pressure", "kPa", KILO, colours=style.WATER),
    "vertical_effective_stress": Field(
        "effective_stress", "Vertical effective stress (compression +)", "kPa", KILO, lambda s, up: -s[:, up]
    ),
    "displacement": Field("displacement", "Displacement", "m", pick=magnitude),
    "velocity": Field("velocity", "Velocity", "m/s", pick=magnitude),
    "porosity": Field("porosity", "Porosity", "-"),
    "saturation": Field("saturation", "Degree of saturation", "-", colours=style.WATER),
    "mean_effective_stress": Field("mean_effective_stress", "Mean effective stress $p'$", "kPa", KILO),
    "deviatoric_stress": Field("deviatoric_stress", "Deviatoric stress $q$", "kPa", KILO),
    "volume": Field("volume", "Volume of a material point", "m$^3$"),
    "head": Field("head", "Hydraulic head", "m", colours=style.WATER),
    "fill": Field("fill", "Fill of the cell", "-", colours=style.WATER),
}
SOIL_DEFAULT = ["deviatoric_strain", "pore_pressure", "vertical_effective_stress", "displacement", "velocity"]
FLUID_DEFAULT = ["pore_pressure"]


def find_field(name, series):
    """The field of that name in the series, None if its frames do not hold it."""
    present = series.names()
    if name in NAMED:
        return NAMED[name] if NAMED[name].array in present else None
    base, _, component = name.rpartition("_")
    if base in present and component in COMPONENTS:  # tension +, as stored
        stress = base.endswith("stress")
        label = base.replace("_", " ").capitalize() + f" {component}" + (" (tension +)" if stress else "")
        return Field(base, label, "kPa" if stress else "-", KILO if stress else 1.0,
                     lambda values, up, i=COMPONENTS[component]: values[:, i])
    if name not in present:
        return None
    label = name.replace("_", " ").capitalize()
    return Field(name, label, "", pick=lambda v, up: v if v.ndim == 1 else magnitude(v, up))


def point_spacing(points):
    """Median distance to the nearest neighbour of a sample of the points, in the plane drawn."""
    if len(points) < 2:
        return 1.0
    sample = points[np.linspace(0, len(points) - 1, min(len(points), 200)).astype(int)]
    nearest = []
    for point in sample:
        squared = np.sum((points - point) ** 2, axis=1)
        nearest.append(np.sqrt(np.min(squared[squared > 0])) if np.any(squared > 0) else 0.0)
    return float(np.median(nearest)) or 1.0


class Section:
    """The plane that is drawn: all of a 2D run, the points next to the middle plane of a 3D run."""

    def __init__(self, frame, kind):
        points = frame.points()
        self.three_d = len(points) > 0 and np.ptp(points[:, 2]) > 0
        self.up = 2 if self.three_d else 1
        self.kind = kind
        self.middle = 0.0
        if self.three_d:  # through a layer of points, not between two
            middle = 0.5 * (points[:, 1].min() + points[:, 1].max())
            self.middle = points[np.argmin(np.abs(points[:, 1] - middle)), 1]
        self.spacing = point_spacing(points) if kind == "PointData" else 0.0

    def shapes(self, frame):
        """Corners of each cell drawn, or each point as a polygon of one corner; and a mask that tells which they are."""
        points = frame.points()
        plane = points[:, [0, self.up]]
        if self.kind == "PointData":
            keep = np.ones(len(points), bool)
            if self.three_d:
                keep = np.abs(points[:, 1] - self.middle) <= 0.5 * self.spacing
            return plane[keep][:, None, :], keep
        cells = frame.cells()
        if not self.three_d:
            return plane[cells], np.ones(len(cells), bool)
        lower, upper = points[cells][:, :, 1].min(axis=1), points[cells][:, :, 1].max(axis=1)
        keep = (lower <= self.middle) & (self.middle < upper)
        boxes = plane[cells[keep]]
        low, high = boxes.min(axis=1), boxes.max(axis=1)
        corners = [(low[:, 0], low[:, 1]), (high[:, 0], low[:, 1]), (high[:, 0], high[:, 1]), (low[:, 0], high[:, 1])]
        return np.stack([np.stack(corner, axis=1) for corner in corners], axis=1), keep


def layout(panels, aspect, columns=None, title_lines=1):
    """Axes of equal size with the given aspect (height / width) and one for the colour bar, placed to the point: the
    panels keep equal scales along x and y. Wide domains are stacked, tall ones stand side by side, unless the number of
    columns is given."""
    left, between, right = 0.55, 0.2, 0.95  # inches; on the right: colour bar, its numbers and label
    below, above, gap = 0.42, 0.12 + 0.13 * title_lines, 0.17 + 0.13 * title_lines
    page = style.WIDTH
    if columns is None:
        columns = 1 if aspect < 0.6 else min(panels, 3)
    else:  # narrower ones than this show nothing
        page = max(page, left + right + columns * (1.8 if aspect < 0.6 else 1.2))
    rows = -(-panels // columns)
    width = (page - left - right - (columns - 1) * between) / columns
    height = width * aspect
    if height > 7.0:  # a column of soil: as high as a page allows
        width, height = 7.0 / aspect, 7.0
    total_width = left + columns * width + (columns - 1) * between + right
    total_height = below + rows * height + (rows - 1) * gap + above
    figure = plt.figure(figsize=(total_width, total_height))

    def place(x, y, w, h):
        return figure.add_axes([x / total_width, y / total_height, w / total_width, h / total_height])

    axes = []
    for number in range(panels):
        row, column = divmod(number, columns)
        bottom = below + (rows - 1 - row) * (height + gap)
        axis = place(left + column * (width + between), bottom, width, height)
        last_of_column = number + columns >= panels
        axis.set_xlabel("$x$ [m]" if last_of_column else "")
        axis.set_ylabel("$y$ [m]" if column == 0 else "")
        axis.tick_params(labelbottom=last_of_column, labelleft=column == 0)
        axes.append(axis)
    bar = min(rows * height + (rows - 1) * gap, 3.2)
    middle = below + 0.5 * (rows * height + (rows - 1) * gap)
    return figure, axes, place(total_width - right + 0.12, middle - 0.5 * bar, 0.12, bar)


def box_around(points, section):
    """Left, bottom, width and height of what is drawn, with a margin."""
    low, high = np.min(points, axis=0), np.max(points, axis=0)
    margin = 0.02 * max(high - low) + 0.5 * section.spacing
    return (*(low - margin), *(high - low + 2 * margin))


def draw_panel(figure, axis, shapes, values, field, limits, box, section):
    """Shapes of Section.shapes() in the colours of their values; returns what a colour bar needs."""
    left, bottom, width, height = box
    if section.kind == "PointData":
        # Squares as wide as the points are apart; wider ones below close the gaps that shear opens between them.
        spacing = section.spacing * 72 * axis.get_position().width * figure.get_figwidth() / width
        for widening in (2.0, 1.4, 1.04):
            drawn = axis.scatter(*shapes[:, 0].T, s=(widening * spacing) ** 2, c=values, marker="s", linewidths=0,
                                 cmap=field.colours, vmin=limits[0], vmax=limits[1], antialiaseds=False)
    else:
        drawn = PolyCollection(shapes, array=values, cmap=field.colours, linewidths=0, antialiaseds=False)
        drawn.set_clim(*limits)
        axis.add_collection(drawn)
    axis.set_xlim(left, left + width)
    axis.set_ylim(bottom, bottom + height)
    axis.tick_params(direction="in", top=True, right=True)
    if section.three_d and axis.get_ylabel():
        axis.set_ylabel("$z$ [m]")
    return drawn


def draw_phreatic(axis, line, section):
    if line is not None and not section.three_d:
        halo = [patheffects.withStroke(linewidth=2.2, foreground="white")]
        axis.plot(*line, color="#0072B2", linewidth=1.1, path_effects=halo)


def save_panel(path, shapes, values, name, field, section):
    centre = shapes.mean(axis=1)
    unit = field.unit.replace("$", "").replace("^", "")
    style.save_table(path, {"x[m]": centre[:, 0], "z[m]" if section.three_d else "y[m]": centre[:, 1],
                            f"{name}[{unit}]": values})


def colour_label(field, section):
    label = field.label + (f" [{field.unit}]" if field.unit else "")
    return label + (f", section $y$ = {section.middle:.4g} m" if section.three_d else "")


def draw_field(series, name, field, frames, phreatic, output):
    """One figure; returns its path, None if no frame holds anything to draw."""
    section = Section(next((f for f in frames if len(f.points()) > 0), frames[0]), series.kind)
    panels = []
    for frame in frames:
        shapes, keep = section.shapes(frame)
        if len(shapes) == 0:  # a set that is empty at this time
            continue
        values = field.pick(frame.read(f"{series.kind}/{field.array}"), section.up)[keep] * field.factor
        panels.append((frame, shapes, values.astype(float)))
    if not panels:
        return None

    corners = np.concatenate([shapes.reshape(-1, 2) for _, shapes, _ in panels])
    box = box_around(corners, section)
    figure, axes, colour_axis = layout(len(panels), box[3] / box[2])

    low, high, extend = style.robust_limits([values for _, _, values in panels])
    span = max(abs(series.times()[-1]), abs(series.times()[0]))
    for number, (axis, (frame, shapes, values)) in enumerate(zip(axes, panels)):
        drawn = draw_panel(figure, axis, shapes, values, field, (low, high), box, section)
        draw_phreatic(axis, phreatic(frame.time), section)
        axis.set_title(f"{style.letter(number)}  {style.time_text(frame.time, span)}", loc="left")
        save_panel(os.path.join(output, f"{series.name}_{name}_{frame.number}.csv"), shapes, values, name, field, section)
    figure.colorbar(drawn, cax=colour_axis, label=colour_label(field, section), extend=extend)
    return style.save_figure(figure, os.path.join(output, f"{series.name}_{name}.png"))


def is_void(series, field, frames):
    """Nothing to see: 0 everywhere in every frame to be drawn, such as the plastic strain of an elastic material."""
    return all(not np.any(frame.read(f"{series.kind}/{field.array}")) for frame in frames)


def draw(results, output, names, times):
    """All figures of fields; `names` None: the usual ones, as far as the frames hold them."""
    if names and not results.series:
        raise PlotError(f"{results.folder}: holds no frames")
    phreatic = results.phreatic()
    written = []
    for series in results.series:
        frames = series.nearest(times)
        for name in names or (FLUID_DEFAULT if series.kind == "CellData" else SOIL_DEFAULT):
            field = find_field(name, series)
            if field is not None and (names or not is_void(series, field, frames)):
                path = draw_field(series, name, field, frames, phreatic, output)
                written += [path] if path else []
    for name in names or []:
        if not any(find_field(name, series) for series in results.series):
            present = sorted({known for series in results.series for known in series.names()})
            raise PlotError(f"{name}: the frames in {results.folder} have no such field; they have {', '.join(present)}")
    return written
