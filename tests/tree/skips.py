#!/usr/bin/env python3
"""A test that is skipped tests nothing, so each that may be is named in a list with its reason.

skips.py LIST LOG      prints the tests that ctest's log says were skipped; exits 1 where one is not in the list
skips.py LIST --of BUILD   exits 1 where a line of the list matches none of the build's tests, 77 where not all of them are built

A line of the list: NAME REASON; the name is a regular expression that matches the whole name of ctest's.
"""
import re
import subprocess
import sys

PARAMETER = r"(?: +# GetParam\(\) = .*?)?"  # CMake makes it a part of the name; it may hold addresses
SKIPPED = re.compile(rf"Test +#\d+: (.+?){PARAMETER} \.*\*\*\*Skipped")
LISTED = re.compile(rf"^ +Test +#\d+: (.+?){PARAMETER}$", re.MULTILINE)


def lines_of(path):
    with open(path, encoding="utf-8") as text:
        rows = [line.split(None, 1) for line in text if line.strip() and not line.startswith("#")]
    for row in rows:
        if len(row) != 2:
            sys.exit(f"{path}: {row[0]} has no reason")
    return [(re.compile(name), reason.strip()) for name, reason in rows]


def main():
    path = sys.argv[1]
    may_skip = lines_of(path)
    if sys.argv[2] == "--of":
        listing = subprocess.run(["ctest", "--test-dir", sys.argv[3], "-N"], capture_output=True, text=True, check=True).stdout
        tests = LISTED.findall(listing)
        unbuilt = [test for test in tests if test.endswith("_NOT_BUILT")]
        if unbuilt:
            print("not built:", *unbuilt)
            return 77
        gone = [name.pattern for name, _ in may_skip if not any(map(name.fullmatch, tests))]
        for name in gone:
            print(f"{path}: {name} is no test")
        return 1 if gone or not tests else 0

    with open(sys.argv[2], encoding="utf-8", errors="replace") as log:
        skipped = SKIPPED.findall(log.read())
    unnamed = 0
    print(f"Skipped tests: {len(skipped)}")
    for test in skipped:
        reason = next((reason for name, reason in may_skip if name.fullmatch(test)), None)
        unnamed += reason is None
        print(f"  {test}: {reason or f'NOT IN {path}: a test may only be skipped for a reason that is written there'}")
    return 1 if unnamed else 0


if __name__ == "__main__":
    sys.exit(main())
