#!/usr/bin/env python3
"""A test that is skipped tests nothing, so each that may be is named in a list with its reason.

skips.py LIST LOG OUTPUTS  prints the tests that were skipped, by ctest's log and by what the tests printed; exits 1 where one is not in the list
skips.py LIST --of BUILD   exits 1 where a line of the list matches none of the build's tests, or a suite is none of ctest's; 77 where not all are built

A line of the list: NAME REASON; the name is a regular expression that matches the whole name of a test: a GoogleTest program's or ctest's own.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = re.compile(r"Test +#\d+: (\S+) \.*\*\*\*Skipped")
SKIPPED_IN_SUITE = re.compile(r"^\[  SKIPPED \] ([\w/]+\.[\w/]+)", re.MULTILINE)
FILTER = "--gtest_filter="


def lines_of(path):
    with open(path, encoding="utf-8") as text:
        rows = [line.split(None, 1) for line in text if line.strip() and not line.startswith("#")]
    for row in rows:
        if len(row) != 2:
            sys.exit(f"{path}: {row[0]} has no reason")
    return [(re.compile(name), reason.strip()) for name, reason in rows]


def suite_of(test):
    """Scenes/Grazing.Walls/3 -> Grazing: what ctest knows the test by."""
    return test.partition(".")[0].split("/")[-1]


def skipped_in(log, outputs):
    """Every test once: a suite that is skipped whole counts as its tests."""
    tests = sorted(set(SKIPPED_IN_SUITE.findall(outputs)))
    suites = {suite_of(test) for test in tests}
    return [test for test in SKIPPED.findall(log) if test not in suites] + tests


def tests_of(build):
    """(names of all tests, those whose program isn't built, suites that ctest doesn't run)"""
    with tempfile.TemporaryDirectory() as folder: # of its own: in the build's, ctest would take the place of the outputs of a run
        pathlib.Path(folder, "CTestTestfile.cmake").write_text(f'subdirs("{pathlib.Path(build).resolve()}")\n', encoding="utf-8")
        listing = subprocess.run(["ctest", "--test-dir", folder, "--show-only=json-v1"], capture_output=True, text=True, check=True).stdout
    names, suites, unbuilt = [], {}, []
    for test in json.loads(listing)["tests"]:
        if "command" not in test:
            unbuilt.append(test["name"])
            continue
        program, *arguments = test["command"]
        if any(argument.startswith(FILTER) for argument in arguments):
            suites.setdefault(program, set()).add(test["name"])
        else:
            names.append(test["name"])
    unknown = []
    for program in suites:
        suite = ""
        for line in subprocess.run([program, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout.splitlines():
            if line.startswith("  "):
                names.append(suite + line.split()[0])
            elif re.match(r"[\w/]+\.", line):
                suite = line.split()[0]
                if suite_of(suite) not in suites[program]:
                    unknown.append(f"{program}: {suite_of(suite)} is no test of ctest's: TEST must begin its line")
    return names, unbuilt, unknown


def main():
    path = sys.argv[1]
    may_skip = lines_of(path)
    if sys.argv[2] == "--of":
        tests, unbuilt, unknown = tests_of(sys.argv[3])
        if unbuilt:
            print("not built:", *unbuilt)
            return 77
        gone = [f"{path}: {name.pattern} is no test" for name, _ in may_skip if not any(map(name.fullmatch, tests))]
        print(*gone, *unknown, sep="\n")
        return 1 if gone or unknown or not tests else 0

    log, outputs = (pathlib.Path(file).read_text(encoding="utf-8", errors="replace") for file in sys.argv[2:4])
    skipped = skipped_in(log, outputs)
    unnamed = 0
    print(f"Skipped tests: {len(skipped)}")
    for test in skipped:
        reason = next((reason for name, reason in may_skip if name.fullmatch(test)), None)
        unnamed += reason is None
        print(f"  {test}: {reason or f'NOT IN {path}: a test may only be skipped for a reason that is written there'}")
    return 1 if unnamed else 0


if __name__ == "__main__":
    sys.exit(main())
