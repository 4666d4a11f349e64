#!/usr/bin/env bash
# The whole test suite: installs what is missing, builds, runs. tests/run.sh [ctest options, e.g. -R field]; PRESET=debug for sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=${PRESET:-release}
tools/install_packages.sh
tools/install_packages.sh tests/packages.txt || echo "Without these the report's page is not tried in a browser: its tests are skipped." >&2
tools/build.sh "$preset"

# Every Vulkan device that a test makes has the validation layer on; a message fails the test that caused it.
export SCONCE_VALIDATION=1
log=build/$preset-tests.log
status=0
ctest --preset "$preset" -j "${JOBS:-2}" "$@" 2>&1 | tee "$log" || status=$?

skipped=$(grep -E '\*\*\*Skipped' "$log" || true)
echo
echo "Skipped tests: $(grep -c . <<< "$skipped" || true)"
sed -nE 's/.*Test +#[0-9]+: ([^ ]+) .*/  \1/p' <<< "$skipped"
exit "$status"
