"""For the tests of `polder plot`: the program as a function, and what every picture must hold.

Each test is called as TEST.py MAKE_RUN_FOLDER POLDER_PLOT (paths of the two programs; see CMakeLists.txt).
"""
import contextlib
import csv
import io
import os
import subprocess
import sys
import unittest

import matplotlib.image
import numpy as np

MAKE, PLOT = sys.argv[1:3]

sys.path.insert(0, os.path.dirname(PLOT))
import polder_plot  # noqa: E402


def plot(*arguments):
    """As from the command line, without starting Python again."""
    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            code = polder_plot.main(arguments)
        except SystemExit as exit:
            code = exit.code
    return subprocess.CompletedProcess(arguments, code, output.getvalue(), errors.getvalue())


def columns(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], zip(*rows[1:])))


class PictureTest(unittest.TestCase):
    def check_picture(self, path):
        """A picture of some size with drawing on it: many colours or at least lines, not one colour."""
        image = matplotlib.image.imread(path)
        self.assertGreater(min(image.shape[:2]), 300, path)
        background = np.all(image[:, :, :3] > 0.999, axis=2)
        self.assertGreater(np.mean(~background), 0.005, path)
        self.assertGreater(np.mean(background), 0.05, path)

    def check_error(self, result, code, *parts):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(len(result.stderr.strip().splitlines()), 1, result.stderr)
        for part in ("error: ",) + parts:
            self.assertIn(part, result.stderr)
