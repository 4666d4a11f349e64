#!/usr/bin/env python3
"""Are all sources as .clang-format says? formatted.py ROOT

Exits 1 and names the places where they aren't, 77 where there is no clang-format of the version that the sources were formatted with:
another one breaks other lines.
"""
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys

from sources import sources

VERSION = "14"
A_CALL = 12  # files


def formatter():
    for command in (f"clang-format-{VERSION}", "clang-format"):
        if shutil.which(command):
            said = subprocess.run([command, "--version"], capture_output=True, text=True, check=False).stdout
            if re.search(rf"version {VERSION}\.", said):
                return command
    print(f"no clang-format {VERSION} is installed")
    sys.exit(77)


def main():
    root = sys.argv[1]
    command = formatter()
    # Shared shader text is GLSL and has its macros where C++ has none.
    files = [path for path in sources(root, ".cpp", ".h") if not path.startswith("shaders/shared/")]

    def faults(first):
        return subprocess.run([command, "--dry-run", "-Werror", *files[first:first + A_CALL]],
                              cwd=root, capture_output=True, text=True, check=False)

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = list(pool.map(faults, range(0, len(files), A_CALL)))
    print(*(run.stderr for run in runs), sep="", end="")
    print(f"{len(files)} files" + (f"; {command} -i FILE mends one" if any(run.returncode for run in runs) else ""))
    return 1 if not files or any(run.returncode for run in runs) else 0


if __name__ == "__main__":
    sys.exit(main())
