#!/usr/bin/env python3
"""Draws the pictures of a run's folder: polder plot DIR [--field NAME] [--time T ...] [--output DIR].

Each figure is a PNG; beside it lies the CSV behind each of its panels. Exit codes are those of polder: 0 done,
2 bad input (no such folder, no results in it, unknown field), 4 environment (a package is missing, the disk refuses,
a result file is damaged).
"""
import argparse
import os
import sys

BAD_INPUT, ENVIRONMENT = 2, 4

try:
    import matplotlib

    matplotlib.use("Agg")  # no display needed
    import h5py  # noqa: F401
    import numpy  # noqa: F401
except ImportError as missing:
    # Another Python may shadow the distribution's, which has the packages.
    system_python = "/usr/bin/python3"
    if os.access(system_python, os.X_OK) and "POLDER_PLOT_PYTHON" not in os.environ:
        os.environ["POLDER_PLOT_PYTHON"] = system_python
        os.execv(system_python, [system_python] + sys.argv)
    print(f"error: {missing}; polder plot needs python3-numpy, python3-h5py and python3-matplotlib", file=sys.stderr)
    sys.exit(ENVIRONMENT)

import compare_fields
import compare_figures
import compare_profiles
import expectation_figures
import field_figures
import history_figures
import probe_figures
import seepage_figures
import stability_figures
from results import PlotError, Results


def arguments(argv):
    parser = argparse.ArgumentParser(
        prog="polder plot", description="Pictures (PNG) of a run's folder, with the CSV behind each panel."
    )
    parser.add_argument("folder", metavar="DIR", help="folder with the results of a run, or of polder compare")
    parser.add_argument(
        "--field",
        action="append",
        metavar="NAME",
        help="draw only this field; may be repeated. Names: those of the frames, effective_stress_xx ..., and "
        + ", ".join(field_figures.NAMED),
    )
    parser.add_argument(
        "--time",
        nargs="+",
        type=float,
        metavar="T",
        help="draw the frames nearest to these times [s]; default: first, middle and last",
    )
    parser.add_argument("--output", metavar="DIR", help="folder for the pictures; default: DIR/plots")
    return parser.parse_args(argv)


def draw(options):
    output = options.output or os.path.join(options.folder, "plots")
    if os.path.exists(os.path.join(options.folder, "compare.json")):
        return draw_comparison(options, output)
    results = Results(options.folder)
    os.makedirs(output, exist_ok=True)
    written = field_figures.draw(results, output, options.field, options.time)
    if not options.field:  # a chosen field means: this picture and nothing else
        written += history_figures.draw(results, output)
        written += probe_figures.draw(results, output)
        written += expectation_figures.draw(results, output)
        written += stability_figures.draw(results, output)
        written += seepage_figures.draw(results, output)
    return written


def draw_comparison(options, output):
    comparison = compare_figures.Comparison(options.folder)
    os.makedirs(output, exist_ok=True)
    written = compare_fields.draw(comparison, output, options.field, options.time)
    if not options.field:
        written += compare_figures.draw(comparison, output)
        written += compare_profiles.draw(comparison, output)
    return written


def main(argv):
    options = arguments(argv)
    try:
        for picture in draw(options):
            print(picture)
    except PlotError as error:
        print(f"error: {error}", file=sys.stderr)
        return error.exit_code
    except OSError as error:
        print(f"error: {error.filename or options.folder}: {error.strerror or error}", file=sys.stderr)
        return ENVIRONMENT
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
