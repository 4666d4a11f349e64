#!/usr/bin/env python3
"""Tests mirror the sources: what is tested where can be found by its name.

mirror.py ROOT

A module is a source or a header of a folder below; its test is tests/<folder>/<module>_test.cpp. Exits 1 and says so where a module has no
test and tests/without_test.txt doesn't name it with where it is tested instead, where that list names one that has a test or isn't there,
and where a test names no module (what holds across modules belongs in tests/properties).
"""
import pathlib
import sys

FOLDERS = ["base", "scene", "svo", "placement", "tools", "shaders/shared",
           *(f"runtime/{wing}" for wing in ("vulkan", "field", "bake", "frame", "scene")),
           *(f"bench/{wing}" for wing in ("reference", "opponents", "race", "sweep", "report"))]
OF_NO_MODULE = "tests/properties/"


def test_of(module):
    """tests/shaders/chart_test.cpp for shaders/shared/chart."""
    return f"tests/{module.replace('shaders/shared', 'shaders')}_test.cpp"


def listed(root):
    """{module: where it is tested instead}"""
    rows = (root / "tests/without_test.txt").read_text(encoding="utf-8").splitlines()
    return dict(row.split(None, 1) for row in rows if row.strip() and not row.startswith("#"))


def main():
    root = pathlib.Path(sys.argv[1])
    modules = {f"{folder}/{file.stem}" for folder in FOLDERS for file in (root / folder).iterdir() if file.suffix in (".cpp", ".h")}
    tests = {str(file.relative_to(root)) for file in (root / "tests").rglob("*_test.cpp")}
    excused = listed(root)
    faults = []
    for module in sorted(modules):
        if test_of(module) not in tests and module not in excused:
            faults.append(f"{module} has no {test_of(module)}; write it, or say in tests/without_test.txt where it is tested")
    for module in sorted(excused):
        if module not in modules:
            faults.append(f"tests/without_test.txt names {module}, which isn't there")
        elif test_of(module) in tests:
            faults.append(f"tests/without_test.txt names {module}, which has {test_of(module)}")
    known = {test_of(module) for module in modules}
    for test in sorted(tests):
        if not test.startswith(OF_NO_MODULE) and test not in known:
            faults.append(f"{test} names no module; rename it, or move it to {OF_NO_MODULE}")
    print(*faults, sep="\n")
    print(f"{len(modules)} modules: {len(modules) - len(excused)} with a test of their name, {len(excused)} tested elsewhere")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
