#!/usr/bin/env python3
"""Would a fresh Debian have what this build reads?

packages.py BUILD LIST... [--without PACKAGE]...

Asks apt which packages an install of the LISTs brings onto an empty system (no recommended ones), and dpkg which package owns every file
that ninja and CMake read from outside the source tree, and every program they found. Exits 1 and names file and package where such a
package is not among them, 77 where apt can't say. --without strikes a package from the lists first: the planted misses of the tests.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile

LIST_LINE = re.compile(r"^\s*([a-z0-9][a-z0-9.+-]+)")


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def wanted_packages(lists, without):
    wanted = []
    for path in lists:
        with open(path, encoding="utf-8") as lines:
            wanted += [match[1] for match in map(LIST_LINE.match, lines) if match]
    return [package for package in wanted if package not in without]


def essential_packages():
    """What every Debian has before anything is installed."""
    rows = output_of("dpkg-query", "-W", "-f", "${Package} ${Essential} ${Priority}\n").splitlines()
    return [row.split()[0] for row in rows if " yes " in row or row.endswith(" required")]


def freshly_installed(wanted):
    """Names of the packages that apt would fetch for an empty system. (Its -s also plays through the order of unpacking: three times as slow.)"""
    with tempfile.TemporaryDirectory() as nothing_fetched:
        os.mkdir(os.path.join(nothing_fetched, "partial"))
        result = subprocess.run(["apt-get", "install", "--print-uris", "-y", "-qq", "--no-install-recommends", "-o", "Dir::State::status=/dev/null",
                                 "-o", "Dir::Cache::archives=" + nothing_fetched, *essential_packages(), *wanted],
                                capture_output=True, text=True, check=False)
    names = {line.split()[1].split("_")[0] for line in result.stdout.splitlines() if line.startswith("'")}
    if not names:
        print(f"apt-get can't plan the install; run apt-get update if its lists are missing:\n{result.stderr.strip()}")
        sys.exit(77)
    return names


def files_read(build):
    """Every file outside the source tree that the build reads: of compilers (deps), of the linker (inputs), of CMake (the edge that
    makes build.ninja) and the programs that CMake found."""
    text = output_of("ninja", "-C", build, "-t", "deps") + output_of("ninja", "-C", build, "-t", "query", "build.ninja")
    paths = {word.strip("|: ") for word in text.split() if word.startswith("/")}
    paths.update(line for line in output_of("ninja", "-C", build, "-t", "inputs", "all").splitlines() if line.startswith("/"))
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as cache:
        settings = cache.read()
    paths.update(match[1] for match in re.finditer(r"^[^#/\n][^:\n]*:FILEPATH=(/[^\n;]+)$", settings, re.MULTILINE))
    source = os.path.realpath(re.search(r"^CMAKE_HOME_DIRECTORY:INTERNAL=(.*)$", settings, re.MULTILINE)[1])
    outside = {os.path.realpath(path) for path in paths if os.path.exists(path)}
    return sorted(path for path in outside if not path.startswith((source + os.sep, os.path.realpath(build) + os.sep)) and os.path.isfile(path))


def owners_of(files):
    """{file: package}; a file that no package owns is missing. dpkg may know a file of /usr/lib as one of /lib."""
    spellings = {}
    for path in files:
        spellings[path] = path
        if path.startswith(("/usr/lib", "/usr/bin", "/usr/sbin")):
            spellings[path.removeprefix("/usr")] = path
    owners = {}
    for row in output_of("dpkg", "-S", *spellings).splitlines():
        packages, _, path = row.partition(": ")
        if path in spellings:
            owners[spellings[path]] = [package.strip().split(":")[0] for package in packages.split(",")]
    return owners


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("lists", nargs="+")
    parser.add_argument("--without", action="append", default=[])
    arguments = parser.parse_args()

    fresh = freshly_installed(wanted_packages(arguments.lists, arguments.without))
    files = files_read(arguments.build)
    if len(files) < 100:
        print(f"only {len(files)} files outside the tree are read by {arguments.build}: build it with Ninja first")
        return 2
    owners = owners_of(files)
    missing = 0
    for path in files:
        packages = owners.get(path)
        if packages is None:
            print(f"{path}: no package owns it; a fresh machine has none")
        elif not fresh.intersection(packages):
            print(f"{path}: {', '.join(packages)} is not installed by {' and '.join(arguments.lists)}")
        else:
            continue
        missing += 1
    print(f"{len(files)} files of {len({name for names in owners.values() for name in names})} packages are read, "
          f"{missing} of them would be missing on a fresh machine ({len(fresh)} packages)")
    return 1 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
