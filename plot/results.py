"""Reads what a run leaves in its folder: series of VTKHDF frames, and tables.

Tables: history.csv (time[s], step, dt[s], dt_limit, ...), probes.csv (time[s], then NAME:quantity[unit]) and
phreatic.csv (time[s],x[m],y[m]; one row for each point of the line, in order along it).
"""
import csv
import functools
import glob
import json
import os
import re
import tomllib

import h5py
import numpy as np


class PlotError(Exception):
    """A problem to be told in one line."""

    def __init__(self, message, exit_code=2):
        super().__init__(message)
        self.exit_code = exit_code


def read_json(path):
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except ValueError as error:
        raise PlotError(f"{path}: is damaged ({error})", 4) from None


class Frame:
    """One VTKHDF file. Arrays are read when asked for."""

    def __init__(self, path, time):
        self.path = path
        self.time = time
        self.number = re.search(r"(\d+)\.hdf$", path).group(1)

    def _open(self):
        try:
            return h5py.File(self.path, "r")["VTKHDF"]
        except (OSError, KeyError) as error:
            raise PlotError(f"{self.path}: is not a readable frame ({error})", 4) from None

    def points(self):
        return self.read("Points")

    def read(self, name):
        group = self._open()
        try:
            return group[name][()]
        except (KeyError, OSError) as error:
            raise PlotError(f"{self.path}: {name}: cannot be read ({error})", 4) from None
        finally:
            group.file.close()

    def names(self, kind):
        """Names of the arrays in PointData or CellData."""
        group = self._open()
        try:
            return sorted(group.get(kind, {}).keys())
        finally:
            group.file.close()

    def cells(self):
        """Corner numbers of the cells, one row each (all cells of a frame have the same shape)."""
        offsets = self.read("Offsets")
        corners = int(offsets[1] - offsets[0]) if len(offsets) > 1 else 0
        return self.read("Connectivity").reshape(-1, max(corners, 1))


class Series:
    """All frames of one set, in order of time."""

    def __init__(self, name, frames):
        self.name = name
        self.frames = frames
        self.kind = "CellData" if name.split("_")[0] == "fluid" else "PointData"

    def times(self):
        return np.array([frame.time for frame in self.frames])

    def names(self):
        return self.frames[-1].names(self.kind)

    def nearest(self, times):
        """The frames nearest to the given times, without repeats; first, middle and last if none are given."""
        all_times = self.times()
        if times is None:
            times = [all_times[0], 0.5 * (all_times[0] + all_times[-1]), all_times[-1]]
        chosen = sorted({int(np.argmin(np.abs(all_times - time))) for time in times})
        return [self.frames[i] for i in chosen]


class Results:
    def __init__(self, folder):
        if not os.path.isdir(folder):
            raise PlotError(f"{folder}: there is no such folder")
        self.folder = folder
        self.series = [s for s in map(self._series, self._names()) if s.frames]
        if not self.series and not any(os.path.exists(self.path(n)) for n in ("history.csv", "probes.csv")):
            raise PlotError(f"{folder}: holds no results of a run (no frames, no history.csv, no probes.csv)")

    def path(self, name):
        return os.path.join(self.folder, name)

    def _names(self):
        found = set()
        for path in glob.glob(os.path.join(glob.escape(self.folder), "*.hdf")):
            match = re.fullmatch(r"((?:soil|fluid)(?:_.+)?)_\d{6,}\.hdf", os.path.basename(path))
            if match:
                found.add(match.group(1))
        return sorted(found, key=lambda name: (name.startswith("fluid"), name))

    def _series(self, name):
        """Through the index; from the frames themselves where it is missing."""
        frames = []
        index = self.path(name + ".hdf.series")
        if os.path.exists(index):
            try:
                with open(index, encoding="utf-8") as file:
                    for entry in json.load(file)["files"]:
                        path = self.path(entry["name"])
                        if os.path.exists(path):
                            frames.append(Frame(path, float(entry["time"])))
            except (ValueError, KeyError, TypeError) as error:
                raise PlotError(f"{index}: is damaged ({error})", 4) from None
        else:
            for path in glob.glob(os.path.join(glob.escape(self.folder), name + "_*.hdf")):
                if re.fullmatch(re.escape(name) + r"_\d{6,}\.hdf", os.path.basename(path)):
                    frame = Frame(path, 0.0)
                    frame.time = float(frame.read("FieldData/TimeValue")[0])
                    frames.append(frame)
        return Series(name, sorted(frames, key=lambda frame: frame.time))

    @functools.cache
    def case(self):
        """The resolved case; empty if the folder has none."""
        path = self.path("case.toml")
        if not os.path.exists(path):
            return {}
        try:
            with open(path, "rb") as file:
                return tomllib.load(file)
        except tomllib.TOMLDecodeError as error:
            raise PlotError(f"{path}: is damaged ({error})", 4) from None

    def vertical(self):
        return "z" if self.case().get("grid", {}).get("space") == "3d" else "y"

    @functools.cache
    def table(self, name, needs_time=True):
        """Columns by name: numbers as arrays, words as lists; None if there is no such file or no row in it."""
        path = self.path(name)
        if not os.path.exists(path):
            return None
        with open(path, newline="", encoding="utf-8") as file:
            rows = [row for row in csv.reader(line for line in file if not line.startswith("#")) if row]
        if not rows:
            raise PlotError(f"{path}: is empty", 4)
        header, rows = rows[0], [row for row in rows[1:] if len(row) == len(rows[0])]  # a run may still be writing
        if not rows:
            return None
        table = {}
        for i, column in enumerate(header):
            cells = [row[i] for row in rows]
            try:
                table[column] = np.array([float(cell) if cell else np.nan for cell in cells])
            except ValueError:
                table[column] = cells
        if not needs_time:
            return table
        if "time[s]" not in table or isinstance(table["time[s]"], list):
            raise PlotError(f"{path}: has no column time[s]", 4)
        return table

    @functools.cache
    def phreatic(self):
        """A function of time that gives the phreatic line nearest to it as (x, y), or None."""
        table = self.table("phreatic.csv")
        if table is None or "x[m]" not in table:
            return lambda time: None
        height = table.get("y[m]", table.get("z[m]"))
        times = np.unique(table["time[s]"])

        def line(time):
            at = table["time[s]"] == times[np.argmin(np.abs(times - time))]
            return table["x[m]"][at], height[at]

        return line
