#!/usr/bin/env python3
"""House rules that a compiler does not check. Usage: layers.py ROOT | layers.py --self-test

1. Layers look down only: a file of a layer includes and links nothing but the layers below it.
2. Quoted includes are written from the repository root, so that rule 1 sees them (tests also include their neighbours).
3. No source file is longer than 600 lines.
4. No file names a folder of the machine it was written on.
"""

import pathlib
import re
import sys
import tempfile

MAX_LINES = 600
# What a layer may use besides itself. app, tests, bench and docs may use everything.
BELOW = {
    "core": set(),
    "mpm": {"core"},
    "fdm": {"core"},
    "io": {"core"},
    "coupling": {"core", "mpm", "fdm"},
}
SKIPPED = {".git", "build", "install", "results", "__pycache__", ".cache"}
SOURCE = {".cpp", ".hpp", ".py", ".cmake", ".sh"}
TEXT = SOURCE | {".txt", ".md", ".json", ".toml", ".in", ".yml", ".yaml", ""}
INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"')
LINK = re.compile(r"\bpolder(?:::|_)(core|mpm|fdm|io|coupling|app)\b")
MACHINE_PATH = re.compile(r"(?<![\w.$}/-])/(?:%s)/\w" % "|".join(["work", "tmp", "root", "home"]))


def files(root):
    for path in sorted(root.rglob("*")):
        relative = path.relative_to(root)
        if not SKIPPED.intersection(relative.parts) and path.is_file() and not path.is_symlink():
            yield path, relative


def check_include(root, relative, name):
    layer = relative.parts[0]
    if layer == "tests" and (root / relative.parent / name).is_file():
        return None  # helpers of the tests beside it
    if not (root / name).is_file():
        return f'"{name}" is not a file from the repository root'
    target = pathlib.PurePath(name).parts[0]
    if layer in BELOW and target != layer and target not in BELOW[layer]:
        return f"{layer} must not include {name}; below it: {sorted(BELOW[layer]) or 'nothing'}"
    return None


def check_file(root, path, relative):
    """Yields (line number, problem)."""
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError:
        return
    layer = relative.parts[0]
    if (path.suffix in SOURCE or relative.name == "polder") and len(lines) > MAX_LINES:
        yield len(lines), f"longer than {MAX_LINES} lines"
    for number, line in enumerate(lines, 1):
        if path.suffix in (".cpp", ".hpp") and (found := INCLUDE.match(line)):
            # docs/ holds programs of their own: they see the installed headers.
            if layer != "docs" and (problem := check_include(root, relative, found[1])):
                yield number, problem
        if relative.name == "CMakeLists.txt" and layer in BELOW:
            for target in LINK.findall(line):
                if target != layer and target not in BELOW[layer]:
                    yield number, f"{layer} must not link {target}"
        if relative.name != "LICENSE" and MACHINE_PATH.search(line):
            yield number, "names a folder of one machine"


def check(root):
    problems = []
    for path, relative in files(root):
        if path.suffix in TEXT:
            problems += [f"{relative}:{n}: {what}" for n, what in check_file(root, path, relative)]
    return problems


def self_test():
    """Plants one breach of every rule and expects to find exactly these."""
    machine = "/" + "tmp/results"
    planted = {
        "core/a.hpp": "#include <vector>\n",
        "core/up.cpp": '#include "mpm/b.hpp"\n',
        "mpm/b.hpp": '#include "core/a.hpp"\n#include "mpm/c.hpp"\n',
        "mpm/c.hpp": "",
        "mpm/sideways.cpp": '  #  include "fdm/d.hpp"\n',
        "fdm/d.hpp": '#include "d2.hpp"\n',
        "fdm/d2.hpp": "",
        "coupling/e.cpp": '#include "io/f.hpp"\n',
        "coupling/CMakeLists.txt": "polder_module(coupling SOURCES e.cpp LINK polder::mpm polder::io)\n",
        "io/f.hpp": "x\n" * 601,
        "app/main.cpp": '#include "io/f.hpp"\n#include "coupling/g.hpp"\n#include "mpm/b.hpp"\n',
        "coupling/g.hpp": "",
        "tests/unit/t.cpp": '#include "helper.hpp"\n#include "absent.hpp"\n#include "app/main.cpp"\n',
        "tests/unit/helper.hpp": "",
        "docs/note.md": f"see {machine}\n",
        "build/generated.hpp": '#include "nowhere.hpp"\n',
    }
    expected = {"core/up.cpp", "mpm/sideways.cpp", "fdm/d.hpp", "coupling/e.cpp", "coupling/CMakeLists.txt",
                "io/f.hpp", "docs/note.md", "tests/unit/t.cpp"}
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, text in planted.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text)
        found = [problem.split(":")[0] for problem in check(root)]
    if sorted(found) != sorted(expected):
        return [f"self test: found {sorted(found)}, expected {sorted(expected)}"]
    return []


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    problems = self_test() if sys.argv[1] == "--self-test" else check(pathlib.Path(sys.argv[1]))
    for problem in problems:
        print(problem)
    return 1 if problems else 0


sys.exit(main())
