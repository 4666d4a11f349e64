#!/usr/bin/env python3
"""Tests mirror the sources: what is tested where can be found by its name.

mirror.py ROOT

A module is a .cpp, a .h or both under one name, anywhere outside tests/; its test is tests/<folder>/<module>_test.cpp. tests/without_test.txt
lists modules that have none, each with the file that tests it instead and the names in that file that do. Exits 1 and says so where

- a module has neither,
- the list names a module that isn't there or has a test by now, a file that isn't there, or a name that isn't in the file,
- a test names no module: what holds across modules belongs in tests/properties.
"""
import pathlib
import re
import sys

from sources import sources

LIST = "tests/without_test.txt"
LINE = re.compile(r"(?P<module>\S+)\s+(?P<file>\S+): (?P<names>.+)")
OF_NO_MODULE = "tests/properties/"


def test_of(module):
    """tests/shaders/chart_test.cpp for shaders/shared/chart: shaders have no other C++."""
    return f"tests/{module.replace('shaders/shared/', 'shaders/')}_test.cpp"


def holds(text, name):
    """Whether a test file has what the list calls it by: Suite.Case or Suite.* of GoogleTest, or any other word."""
    suite, dot, case = name.partition(".")
    if dot and suite.isidentifier() and (case == "*" or case.isidentifier()):
        return re.search(rf"\bTEST(_[FP])?\({suite}, {r'[A-Za-z0-9]+' if case == '*' else case}\)", text) is not None
    return name in text


def faults_of(root):
    files = sources(root, ".cpp", ".h")
    modules = {path.rpartition(".")[0] for path in files if not path.startswith("tests/")}
    tests = {path for path in files if path.startswith("tests/") and path.endswith("_test.cpp")}

    excused = set()
    for number, line in enumerate((root / LIST).read_text(encoding="utf-8").splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        row = LINE.fullmatch(line)
        if not row:
            yield f"{LIST}:{number}: write MODULE  FILE: NAME, NAME"
            continue
        module, file = row["module"], row["file"]
        excused.add(module)
        if module not in modules:
            yield f"{LIST}:{number}: {module} isn't there"
        elif test_of(module) in tests:
            yield f"{LIST}:{number}: {module} has {test_of(module)}"
        if not (root / file).is_file():
            yield f"{LIST}:{number}: {file} isn't there"
            continue
        text = (root / file).read_text(encoding="utf-8")
        for name in row["names"].split(", "):
            if not holds(text, name):
                yield f"{LIST}:{number}: {file} has no {name}"

    known = {test_of(module): module for module in modules}
    for test, module in sorted(known.items()):
        if test not in tests and module not in excused:
            yield f"{module} has no {test}; write it, or name in {LIST} what tests it"
    for test in sorted(tests - known.keys()):
        if not test.startswith(OF_NO_MODULE):
            yield f"{test} names no module; rename it, or move it to {OF_NO_MODULE}"
    print(f"{len(modules)} modules: {len(known.keys() & tests)} with a test of their name, {len(excused)} in {LIST}")


def main():
    faults = list(faults_of(pathlib.Path(sys.argv[1])))
    print(*faults, sep="\n")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
