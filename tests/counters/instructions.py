#!/usr/bin/env python3
"""Instructions of a step per point, counted by valgrind (callgrind), against the ranges below: instructions.py DRIVER.

Numbers of instructions do not depend on what else a machine does, and little on the machine: kernels run at the SSE2
level, which valgrind knows (not all of AVX2, nothing of AVX-512). Prints what it finds; exit codes: 0 within the ranges, 1 beyond one, 77 cannot count here.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
SHORT, LONG = 5, 20  # steps

# Instructions per point and step, least and most; a point of two layers is one of soil or of water. A number below its
# range is good news that the range must follow.
RANGES = {
    "dry-2d": (2040, 2550),
    "bare-2d": (2000, 2510),
    "flip-2d": (1100, 1370),
    "tpic-2d": (1170, 1470),
    "dry-3d": (4620, 5780),
    "bare-3d": (4580, 5730),
    "flip-3d": (3000, 3750),
    "tpic-3d": (3000, 3750),
    "one-layer-2d": (3120, 3890),
    "two-layer-2d": (2020, 2520),
}
# A dry step of the full program, balances and choice of the step included, over the loop of the skeleton alone.
PAIRS = {"dry-2d": "bare-2d", "dry-3d": "bare-3d"}
MOST_OVERHEAD = 1.02


def instructions(driver, scene, steps):
    with tempfile.TemporaryDirectory() as folder:
        environment = dict(os.environ, POLDER_SIMD_LEVEL="baseline", OMP_NUM_THREADS="1")
        run = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out", driver, scene, str(steps)],
            capture_output=True, text=True, env=environment, check=False,
        )
    counted = re.search(r"Collected : (\d+)", run.stderr)
    if run.returncode != 0 or counted is None:
        return None, run.stderr[-500:]
    return int(counted.group(1)), int(run.stdout)


def main(argv):
    driver = argv[1]
    if shutil.which("valgrind") is None:
        print("skipped: valgrind is not installed")
        return SKIPPED
    found, failed = {}, False
    for scene, (least, most) in RANGES.items():
        first, points = instructions(driver, scene, SHORT)
        if first is None:
            print(f"skipped: valgrind cannot run this build here (a build for one machine only?): {points}")
            return SKIPPED
        last, points = instructions(driver, scene, LONG)
        found[scene] = (last - first) / (LONG - SHORT) / points
        fits = least <= found[scene] <= most
        failed |= not fits
        print(f"{scene:14} {found[scene]:8.0f} instructions per point and step, range {least} to {most}"
              + ("" if fits else "   BEYOND"))
    for full, bare in PAIRS.items():
        ratio = found[full] / found[bare]
        fits = ratio <= MOST_OVERHEAD
        failed |= not fits
        print(f"{full} over {bare}: {ratio:.3f}, at most {MOST_OVERHEAD}" + ("" if fits else "   BEYOND"))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv))
