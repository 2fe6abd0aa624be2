#!/usr/bin/env python3
"""Kernels compiled for a vector level above the baseline must export only names of that level's namespace; otherwise an
inline function compiled with, say, AVX-512 can become the program's only copy and stop it on an older processor.

Usage: vector_levels.py NM ARCHIVE...
"""

import re
import subprocess
import sys

LEVELS = ("avx2", "avx512")


def exports(nm, archive):
    """Yields (member, symbol) of every symbol that the archive's members define and export."""
    text = subprocess.run([nm, "--defined-only", "--extern-only", archive], capture_output=True, text=True, check=True)
    member = ""
    for line in text.stdout.splitlines():
        if line.endswith(":"):
            member = line[:-1]
        elif line.strip():
            yield member, line.split()[-1]


def main():
    nm, archives = sys.argv[1], sys.argv[2:]
    counts = dict.fromkeys(LEVELS, 0)
    problems = []
    for archive in archives:
        for member, symbol in exports(nm, archive):
            level = re.fullmatch(r"kernels_(\w+)\.o", member)
            for name in LEVELS:
                if level and level[1] == name:
                    counts[name] += 1
                    if f"simd_{name}" not in symbol:
                        problems.append(f"{archive}({member}) exports {symbol}")
                elif f"simd_{name}" in symbol:
                    problems.append(f"{archive}({member}) defines {symbol}, which belongs to kernels_{name}.o")
    for name, count in counts.items():
        if count == 0:
            problems.append(f"no kernels of level {name} found")
    print("\n".join(problems) or f"exported names by level: {counts}")
    return 1 if problems else 0


sys.exit(main())
