"""polder plot on synthetic folders, and the frames of those folders as h5py sees them.

usage: plot_test.py MAKE_RUN_FOLDER POLDER_PLOT   (paths of the two programs; see CMakeLists.txt)
"""
import glob
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

from plot_support import MAKE, PLOT, PictureTest, columns, plot


class PlotTest(PictureTest):
    @classmethod
    def setUpClass(cls):
        cls.root = tempfile.mkdtemp(prefix="polder_plot_")
        cls.folder = os.path.join(cls.root, "run")
        subprocess.run([MAKE, cls.folder], check=True)
        cls.result = subprocess.run([sys.executable, PLOT, cls.folder], capture_output=True, text=True)
        cls.plots = os.path.join(cls.folder, "plots")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.root)

    def write(self, name, text):
        with open(os.path.join(self.root, "expected", name), "w", encoding="utf-8") as file:
            file.write(text)

    def test_profiles_and_histories_stand_beside_their_references(self):
        os.makedirs(os.path.join(self.root, "expected"), exist_ok=True)
        self.write("case.toml", """
[[stage]]
name = "first"
[[stage]]
name = "second"
[[measure]]
name = "pressure"
kind = "cells"
quantity = "pore_pressure"
along = "y"
[[measure]]
name = "top"
quantity = "displacement_y"
[[measure]]
name = "alone"
quantity = "displacement_y"
[[expect]]
measure = "pressure"
reference = "reference_a.csv"
column = "late"
time = 1.0
[[expect]]
measure = "top"
reference = "reference_b.csv"
from_stage = "second"
""")
        self.write("reference_a.csv", "# exact\ny[m],early[Pa],late[Pa]\n0,20,10\n1,0,0\n")
        self.write("reference_b.csv", "t[s],u[m]\n0,0\n1,-1\n")
        self.write("profile_pressure.csv", "time[s],y[m],pore_pressure[Pa]\n" + "".join(
            f"{t},{0.1 * i},{10 - i}\n" for t in (0, 1, 2) for i in range(11)))
        self.write("probes.csv", "time[s],top:uy[m],alone:uy[m]\n0,0,0\n1,0,1\n2,-1,2\n")
        self.write("history.csv", "time[s],step,stage\n0,0,0\n1,1,1\n2,2,1\n")
        result = plot(os.path.join(self.root, "expected"))
        self.assertEqual(result.returncode, 0, result.stderr)
        plots = os.path.join(self.root, "expected", "plots")
        self.check_picture(os.path.join(plots, "expectations.png"))
        self.assertEqual(len(columns(os.path.join(plots, "expectations_pressure.csv"))["y[m]"]), 33)
        self.assertEqual(columns(os.path.join(plots, "expectations_top.csv"))["top[m]"], ("0", "0", "-1"))
        self.assertFalse(os.path.exists(os.path.join(plots, "expectations_alone.csv")))
        self.write("case.toml", "no toml")
        self.check_error(plot(os.path.join(self.root, "expected")), 4, "case.toml", "damaged")

    def test_frames_follow_the_vtkhdf_layout(self):
        with h5py.File(os.path.join(self.folder, "soil_000002.hdf"), "r") as file:
            group = file["VTKHDF"]
            self.assertEqual(list(group.attrs["Version"]), [1, 0])
            self.assertEqual(group.attrs["Type"], b"UnstructuredGrid")
            n = group["NumberOfPoints"][0]
            self.assertEqual(group["NumberOfCells"][0], n)
            self.assertEqual(group["Points"].shape, (n, 3))
            self.assertEqual(group["Points"].dtype, np.dtype("<f4"))
            self.assertEqual(group["Offsets"].shape, (n + 1,))
            self.assertTrue(np.all(group["Types"][()] == 1))
            self.assertEqual(group["PointData/effective_stress"].shape, (n, 6))
            self.assertEqual(group["PointData/effective_stress"].dtype, np.dtype("<f4"))
            self.assertEqual(group["PointData/id"].dtype, np.dtype("<i8"))
            self.assertEqual(group["FieldData/TimeValue"][0], 5.0)
        with h5py.File(os.path.join(self.folder, "fluid_000000.hdf"), "r") as file:
            group = file["VTKHDF"]
            n = group["NumberOfCells"][0]
            self.assertEqual(group["Connectivity"].shape, (4 * n,))
            self.assertTrue(np.all(group["Types"][()] == 9))
            self.assertEqual(group["CellData/pore_pressure"].shape, (n,))
            corners = group["Points"][()][group["Connectivity"][()].reshape(-1, 4)]
            low, high = corners.min(axis=1), corners.max(axis=1)
            np.testing.assert_allclose((high - low)[:, :2], 0.1, atol=1e-5)
        with open(os.path.join(self.folder, "soil.hdf.series"), encoding="utf-8") as file:
            index = json.load(file)
        self.assertEqual(index["file-series-version"], "1.0")
        self.assertEqual([entry["time"] for entry in index["files"]], [0, 2.5, 5, 7.5, 10])

    def test_pictures_and_their_tables(self):
        self.assertEqual(self.result.returncode, 0, self.result.stderr)
        self.assertEqual(self.result.stderr, "")
        written = self.result.stdout.split()
        expected = ["deviatoric_strain", "pore_pressure", "vertical_effective_stress", "displacement", "velocity"]
        names = [f"soil_{name}" for name in expected] + ["fluid_pore_pressure", "history", "history_other", "probes",
                                                         "stress_paths"]
        self.assertEqual(sorted(os.path.basename(path) for path in written), sorted(name + ".png" for name in names))
        for path in written:
            self.check_picture(path)
        for name in names[:6]:  # first, middle and last frame
            tables = sorted(glob.glob(os.path.join(self.plots, name + "_0*.csv")))
            self.assertEqual([table[-10:-4] for table in tables], ["000000", "000002", "000004"], name)
        for name in ("history_energy", "history_unbalanced_force", "history_mass_error", "history_momentum",
                     "history_speed", "history_roughness", "history_step", "history_other", "probes_displacement",
                     "probes_pore_pressure", "stress_paths"):
            self.assertTrue(os.path.exists(os.path.join(self.plots, name + ".csv")), name)
        self.assertEqual(glob.glob(os.path.join(self.plots, "*.tmp")), [])

    def test_tables_hold_what_is_drawn(self):
        table = columns(os.path.join(self.plots, "soil_vertical_effective_stress_000004.csv"))
        with h5py.File(os.path.join(self.folder, "soil_000004.hdf"), "r") as file:
            stress = file["VTKHDF/PointData/effective_stress"][:, 1]
            points = file["VTKHDF/Points"][()]
        np.testing.assert_allclose(np.array(table["vertical_effective_stress[kPa]"], float), -stress / 1000, rtol=1e-6)
        np.testing.assert_allclose(np.array(table["x[m]"], float), points[:, 0], atol=1e-6)
        np.testing.assert_allclose(np.array(table["y[m]"], float), points[:, 1], atol=1e-6)
        probes = columns(os.path.join(self.plots, "stress_paths.csv"))
        self.assertAlmostEqual(float(probes["toe:p[kPa]"][0]), 2.4)
        self.assertEqual(columns(os.path.join(self.plots, "history_step.csv"))["dt_limit"][1], "skeleton wave")

    def test_chosen_fields_and_times(self):
        output = os.path.join(self.root, "chosen")
        result = plot(self.folder, "--field", "effective_stress_xy", "--field", "id", "--time", "2.6", "7.4", "7.5",
                      "--output", output)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(sorted(os.listdir(output)),
                         sorted(f"soil_{name}{end}" for name in ("effective_stress_xy", "id")
                                for end in (".png", "_000001.csv", "_000003.csv")))
        self.check_picture(os.path.join(output, "soil_effective_stress_xy.png"))

    def test_three_dimensions_are_drawn_as_a_section(self):
        run = os.path.join(self.root, "run3d")
        subprocess.run([MAKE, run, "3d"], check=True)
        result = plot(run, "--field", "vertical_effective_stress", "--time", "10")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.check_picture(os.path.join(run, "plots", "soil_vertical_effective_stress.png"))
        table = columns(os.path.join(run, "plots", "soil_vertical_effective_stress_000004.csv"))
        flat = columns(os.path.join(self.plots, "soil_vertical_effective_stress_000004.csv"))
        self.assertEqual(sorted(table["vertical_effective_stress[kPa]"]), sorted(flat["vertical_effective_stress[kPa]"]))

    def test_index_is_not_needed(self):
        run = os.path.join(self.root, "unindexed")
        shutil.copytree(self.folder, run, ignore=shutil.ignore_patterns("*.series", "plots"))
        result = plot(run, "--field", "velocity")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue(os.path.exists(os.path.join(run, "plots", "soil_velocity_000002.csv")))

    def test_stability(self):
        folder = os.path.join(self.root, "stability")
        shutil.copytree(self.folder, folder, ignore=shutil.ignore_patterns("plots", "*.csv"))
        result = {"factor_of_safety": 1.25, "mechanism": {"factor": 1.35}}
        with open(os.path.join(folder, "stability.json"), "w", encoding="utf-8") as file:
            json.dump(result, file)
        with open(os.path.join(folder, "trials.csv"), "w", encoding="utf-8") as file:
            file.write("factor[-],stands,steps,force_ratio[-],displacement[m],largest_displacement[m]\n"
                       "1,1,300,4e-4,0.01,0.02\n1.3,0,900,2e-2,0.5,0.9\n1.2,1,800,5e-4,0.03,0.05\n")
        with open(os.path.join(folder, "slip_surface.csv"), "w", encoding="utf-8") as file:
            file.write("x[m],y[m]\n1,2\n2,1\n4,0.5\n")
        drawn = plot(folder)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.check_picture(os.path.join(folder, "plots", "stability.png"))
        trials = columns(os.path.join(folder, "plots", "stability_trials.csv"))
        self.assertEqual([float(f) for f in trials["factor[-]"]], [1, 1.2, 1.3])
        mechanism = columns(os.path.join(folder, "plots", "stability_mechanism.csv"))
        self.assertGreater(max(float(d) for d in mechanism["displacement[m]"]), 0)
        os.remove(os.path.join(folder, "trials.csv"))
        self.check_error(plot(folder), 4, "stability.json lies there without trials.csv")

    def test_seepage(self):
        folder = os.path.join(self.root, "seepage")
        shutil.copytree(self.folder, folder, ignore=shutil.ignore_patterns("plots", "*.csv"))
        frames = sorted(glob.glob(os.path.join(folder, "fluid_*.hdf")))
        for path in frames:
            with h5py.File(path, "r+") as file:
                group = file["VTKHDF"]
                corners = group["Connectivity"][()].reshape(-1, 4)
                centre = group["Points"][()][corners].mean(axis=1)
                group["CellData/head"] = group["CellData/pore_pressure"][()] / 9810.0 + centre[:, 1] - 0.1 * centre[:, 0]
        result = {"largest_exit_gradient": {"gradient": 0.5, "place": [1.0, 0.5]}}
        with open(os.path.join(folder, "flow.json"), "w", encoding="utf-8") as file:
            json.dump(result, file)
        with open(os.path.join(folder, "stream_function.csv"), "w", encoding="utf-8") as file:
            file.write("x[m],y[m],stream_function[m2/s]\n")
            for x in range(3):
                for y in range(3):
                    file.write(f"{x},{y},{1e-5 * y}\n")
        with open(os.path.join(folder, "history.csv"), "w", encoding="utf-8") as file:
            file.write("time[s],discharge:drain[m3/s],discharge:wall[m3/s]\n0,0,0\n10,1e-5,0\n1e6,3e-5,0\n")
        drawn = plot(folder)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        self.check_picture(os.path.join(folder, "plots", "seepage.png"))
        self.check_picture(os.path.join(folder, "plots", "discharges.png"))
        heads = columns(os.path.join(folder, "plots", "seepage.csv"))
        with h5py.File(frames[-1], "r") as file:
            stored = file["VTKHDF/CellData/head"][()]
        np.testing.assert_allclose([float(h) for h in heads["head[m]"]], stored, rtol=1e-6)
        # What carries nothing at any time is not drawn.
        self.assertEqual(list(columns(os.path.join(folder, "plots", "discharges.csv"))),
                         ["time[s]", "discharge:drain[m3/s]"])
        with open(os.path.join(folder, "flow.json"), "w", encoding="utf-8") as file:
            file.write("{")
        self.check_error(plot(folder), 4, "flow.json: is damaged")

    def test_errors_are_one_line_with_their_exit_code(self):
        self.check_error(plot(os.path.join(self.root, "nowhere")), 2, "nowhere: there is no such folder")
        empty = os.path.join(self.root, "empty")
        os.mkdir(empty)
        self.check_error(plot(empty), 2, "empty: holds no results of a run")
        self.check_error(plot(self.folder, "--field", "porosty"), 2, "porosty", "they have ", "pore_pressure")
        self.check_error(plot(self.folder, "--output", "/dev/null/x"), 4, "/dev/null/x")
        damaged = os.path.join(self.root, "damaged")
        shutil.copytree(self.folder, damaged, ignore=shutil.ignore_patterns("plots"))
        with open(os.path.join(damaged, "soil_000000.hdf"), "wb") as file:
            file.write(b"not HDF5")
        self.check_error(plot(damaged), 4, "soil_000000.hdf: is not a readable frame")
        self.assertEqual(plot().returncode, 2)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
