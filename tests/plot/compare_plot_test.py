"""polder plot on the folder of a comparison: two variants, one with a coarser run and one that began later.

usage: compare_plot_test.py MAKE_RUN_FOLDER POLDER_PLOT   (paths of the two programs; see CMakeLists.txt)
"""
import csv
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import h5py
import numpy as np

from plot_support import MAKE, PictureTest, columns, plot

import compare_fields  # found beside polder_plot.py, whose folder plot_support puts into the path

DELAY = 2.0  # [s], of the run that searched longer for equilibrium


def entry(folder, variant, cell, **more):
    run = {
        "label": f"{variant}, cell {cell} m", "variant": variant, "status": "completed", "folder": folder, "start": 0.0,
        "time": 10.0, "cell": cell, "courant": 0.5, "time_step": None, "steps": 10000, "particle_steps_per_second": 2e6,
        "dt": {"min": 6e-4, "mean": 8e-4, "max": 1e-3, "limited_by": "skeleton wave"},
        "wall_seconds": {"mechanics": 2.0, "water": 1.0, "audit": 0.1, "output": 0.2, "other": 0.1, "total": 3.4},
    }
    run.update(more)
    return run


def difference(l2, error, beyond):
    return {"first": 1, "second": 2, "l2": l2, "max": 2 * l2, "max_at": 1.0, "error_l2": error, "beyond": beyond,
            "cells": [0.1], "l2_of_cells": [l2]}


def measure(name, quantity, unit, differences, kind="particle", asked=True):
    return {"name": name, "kind": kind, "quantity": quantity, "unit": unit, "asked": asked, "scale": 1.0, "errors": [],
            "differences": differences}


def later(folder):
    """Moves all times of a run by DELAY, doubles its pore pressures, and takes a field from its soil."""
    for name in ("history.csv", "probes.csv", "phreatic.csv"):
        path = os.path.join(folder, name)
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(file))
        for row in rows[1:]:
            row[0] = repr(float(row[0]) + DELAY)
        with open(path, "w", newline="", encoding="utf-8") as file:
            csv.writer(file, lineterminator="\n").writerows(rows)
    for path in glob.glob(os.path.join(folder, "*.series")):
        with open(path, encoding="utf-8") as file:
            index = json.load(file)
        for item in index["files"]:
            item["time"] += DELAY
        with open(path, "w", encoding="utf-8") as file:
            json.dump(index, file)
    for path in glob.glob(os.path.join(folder, "*.hdf")):
        with h5py.File(path, "r+") as file:
            if "CellData/pore_pressure" in file["VTKHDF"]:
                file["VTKHDF/CellData/pore_pressure"][...] *= 2
            elif "PointData/deviatoric_strain" in file["VTKHDF"]:
                del file["VTKHDF/PointData/deviatoric_strain"]


class ComparePlotTest(PictureTest):
    @classmethod
    def setUpClass(cls):
        cls.root = tempfile.mkdtemp(prefix="polder_compare_plot_")
        for name in ("a_coarse", "a_fine", "b_fine"):
            subprocess.run([MAKE, os.path.join(cls.root, name)], check=True)
        later(os.path.join(cls.root, "b_fine"))
        for name, shift in (("a_coarse", 0.0), ("a_fine", 0.0), ("b_fine", DELAY)):
            with open(os.path.join(cls.root, name, "profile_depth.csv"), "w", encoding="utf-8") as file:
                file.write("time[s],y[m],pore_pressure[Pa]\n")
                for time in (0, 4, 8) if name == "b_fine" else (0, 5, 8):
                    for y in (0.0, 1.0, 2.0):  # linear in place and time, so that what is in between is known
                        file.write(f"{time + shift},{y},{1000 * time * (2 - y)}\n")
            with open(os.path.join(cls.root, name, "case.toml"), "w", encoding="utf-8") as file:
                file.write('[[expect]]\nmeasure = "depth"\nreference = "reference_depth.csv"\ntime = 8.0\n')
            with open(os.path.join(cls.root, name, "reference_depth.csv"), "w", encoding="utf-8") as file:
                file.write("y[m],p[Pa]\n0,16000\n2,0\n")
        depth = measure("depth", "pore_pressure", "Pa", [], "cells")
        depth["times"] = [0.0, 4.0, 5.0, 8.0]
        cls.json = {
            "case": "levee.toml", "title": "", "variants": ["one-layer", "two-layer", "broken"],
            "runs": [entry("a_coarse", "one-layer", 0.2), entry("a_fine", "one-layer", 0.1),
                     entry("b_fine", "two-layer", 0.1, start=DELAY, time=10.0 + DELAY, status="failed", reason="why"),
                     {"label": "broken", "variant": "broken", "status": "failed", "reason": "bad"}],
            "measures": [measure("toe", "displacement_x", "m", [difference(0.02, 0.01, "yes")]),
                         measure("crest", "pore_pressure", "Pa", [difference(0.005, 0.01, "no")]),
                         measure("max_speed", "max_speed", "m/s", [difference(0.1, None, "not known")], "history", False), depth],
        }
        cls.write(cls.json)
        cls.result = plot(cls.root)
        cls.plots = os.path.join(cls.root, "plots")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    @classmethod
    def write(cls, root):
        with open(os.path.join(cls.root, "compare.json"), "w", encoding="utf-8") as file:
            json.dump(root, file)

    def table(self, name):
        return columns(os.path.join(self.plots, name))

    def test_all_pictures(self):
        self.assertEqual(self.result.returncode, 0, self.result.stderr)
        pictures = [os.path.basename(path) for path in self.result.stdout.split()]
        for name in ("compare_soil_displacement.png", "compare_soil_deviatoric_strain.png",
                     "compare_fluid_pore_pressure.png", "compare_measures.png", "compare_history.png",
                     "compare_cost.png", "compare_differences.png", "compare_profiles.png"):
            self.assertIn(name, pictures)
        for name in pictures:
            path = os.path.join(self.plots, name)
            if name != "compare_cost.png":  # which is low for three runs
                self.check_picture(path)
            self.assertGreater(os.path.getsize(path), 10000)

    def test_times_count_from_where_the_comparison_begins(self):
        table = self.table("compare_measure_toe.csv")
        for folder, label in (("a_fine", "one-layer, cell 0.1 m"), ("b_fine", "two-layer, cell 0.1 m")):
            rows = [i for i, run in enumerate(table["run"]) if run == label]
            probes = columns(os.path.join(self.root, folder, "probes.csv"))
            np.testing.assert_allclose([float(table["time[s]"][i]) for i in rows], np.linspace(0, 10, 201), atol=1e-6)
            np.testing.assert_allclose([float(table["displacement_x[m]"][i]) for i in rows],
                                       np.array(probes["toe:ux[m]"], float), rtol=1e-6)

    def test_profiles_are_those_of_the_same_times(self):
        table = self.table("compare_profile_depth.csv")
        for run in ("one-layer, cell 0.1 m", "two-layer, cell 0.1 m"):
            for time in (0.0, 4.0, 5.0, 8.0):
                values = [float(p) for p, r, t in zip(table["pore_pressure[kPa]"], table["run"], table["time[s]"])
                          if r == run and float(t) == time]
                np.testing.assert_allclose(values, [2 * time, time, 0.0])

    def test_pressures_are_drawn_in_kilopascals(self):
        self.assertEqual(set(self.table("compare_measure_crest.csv")["pore_pressure[kPa]"]), {"-1"})

    def test_panels_of_a_field_share_colours_and_axes(self):
        seen = []

        def record(figure, axis, shapes, values, field, limits, box, section):
            seen.append((limits, box, values.max()))
            return original(figure, axis, shapes, values, field, limits, box, section)

        original = compare_fields.draw_panel
        with mock.patch.object(compare_fields, "draw_panel", record):
            result = plot(self.root, "--field", "pore_pressure", "--time", "0", "10", "--output",
                          os.path.join(self.root, "shared"))
        self.assertEqual(result.returncode, 0, result.stderr)
        figures = [seen[i:i + 4] for i in range(0, len(seen), 4)]  # two variants at two times, of soil and of water
        self.assertEqual(len(figures), 2)
        for panels in figures:
            self.assertEqual(len({(limits, box) for limits, box, _ in panels}), 1)
        # Those of the cells differ by the factor that was put in, so the limits are those of all.
        water = figures[1]
        self.assertAlmostEqual(water[1][2], 2 * water[0][2], places=4)
        self.assertGreaterEqual(water[0][0][1], 0.99 * water[3][2])

    def test_frames_are_those_of_the_same_time(self):
        with open(os.path.join(self.root, "b_fine", "fluid.hdf.series"), encoding="utf-8") as file:
            numbers = {item["name"].split("_")[1][:6] for item in json.load(file)["files"]
                       if item["time"] - DELAY in (0, 2.5, 5, 10)}
        drawn = {os.path.basename(path).split("_")[-1][:6]
                 for path in glob.glob(os.path.join(self.plots, "compare_fluid_pore_pressure_3_*.csv"))}
        self.assertEqual(drawn, numbers)
        # The coarser run of a variant is not drawn.
        self.assertFalse(glob.glob(os.path.join(self.plots, "compare_fluid_pore_pressure_1_*.csv")))

    def test_cost_and_differences(self):
        cost = self.table("compare_cost.csv")
        self.assertEqual(len(cost["run"]), 3)
        self.assertAlmostEqual(float(cost["time_per_particle_step[us]"][0]), 0.5)
        self.assertAlmostEqual(float(cost["balances[s]"][0]), 0.1)
        table = self.table("compare_differences.csv")
        self.assertEqual(table["quantity"], ("toe", "crest", "max_speed"))
        self.assertEqual(table["beyond"], ("yes", "no", "not known"))

    def test_one_variant_is_drawn_in_all_its_sizes(self):
        alone = os.path.join(self.root, "alone")
        os.makedirs(alone)
        runs = [dict(run, folder=os.path.join("..", run["folder"])) for run in self.json["runs"][:2]]
        with open(os.path.join(alone, "compare.json"), "w", encoding="utf-8") as file:
            json.dump(dict(self.json, runs=runs, measures=[]), file)
        result = plot(alone, "--field", "displacement", "--time", "10")
        self.assertEqual(result.returncode, 0, result.stderr)
        drawn = sorted(os.path.basename(path) for path in glob.glob(os.path.join(alone, "plots", "*.csv")))
        self.assertEqual(drawn, ["compare_soil_displacement_1_000004.csv", "compare_soil_displacement_2_000004.csv"])

    def test_stages_of_far_different_durations_are_drawn_apart(self):
        staged = os.path.join(self.root, "staged")
        os.makedirs(staged)
        runs = [dict(run, folder=os.path.join("..", run["folder"]), time=10.0,
                     stages=[{"name": "rain", "start": 0.0, "time": 9.6}, {"name": "slide", "start": 9.6, "time": 0.4}])
                for run in self.json["runs"][:2]]
        with open(os.path.join(staged, "compare.json"), "w", encoding="utf-8") as file:
            measures = [dict(m, differences=[]) for m in self.json["measures"]]  # of runs that are not here
            json.dump(dict(self.json, runs=runs, measures=measures), file)
        result = plot(staged)
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("compare_measures_rain.png", "compare_measures_slide.png", "compare_history_slide.png"):
            self.check_picture(os.path.join(staged, "plots", name))
        slide = columns(os.path.join(staged, "plots", "compare_measure_toe_slide.csv"))
        seconds = [float(t) for t in slide["time[s]"]]
        self.assertAlmostEqual(min(seconds), 0.0)
        self.assertAlmostEqual(max(seconds), 0.4)

    def test_errors(self):
        self.check_error(plot(self.root, "--field", "porosty"), 2, "porosty", "such a field")
        broken = os.path.join(self.root, "broken")
        os.makedirs(broken)
        with open(os.path.join(broken, "compare.json"), "w", encoding="utf-8") as file:
            file.write("{")
        self.check_error(plot(broken), 4, "compare.json: is damaged")
        with open(os.path.join(broken, "compare.json"), "w", encoding="utf-8") as file:
            json.dump(self.json, file)
        self.check_error(plot(broken), 2, "a_coarse: there is no such folder")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
