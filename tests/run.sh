#!/usr/bin/env bash
# The whole test suite: installs what is missing, builds, runs. tests/run.sh [ctest options, e.g. -R Field: suites of that name]; PRESET=debug for
# sanitizers. One test of a suite: its program, in build/release/tests, with --gtest_filter=SUITE.TEST.
# Fails, too, where a test was skipped that tests/may_skip.txt doesn't name.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${PRESET:-release}
tools/install_packages.sh
tools/install_packages.sh tests/packages.txt || echo "Without these neither the report's page nor the viewer nor the sources' format is tested." >&2
tools/build.sh "$preset"

# Every Vulkan device that a test makes has the validation layer on; a message fails the test that caused it.
export SCONCE_VALIDATION=1
log=build/$preset-tests.log
status=0
ctest --preset "$preset" -j "${JOBS:-2}" "$@" 2>&1 | tee "$log" || status=$?
echo
tests/tree/skips.py tests/may_skip.txt "$log" "build/$preset/Testing/Temporary/LastTest.log" || [[ $status -ne 0 ]] || status=1
exit "$status"
