#!/usr/bin/env bash
# Takes the table of docs/hard_cases.md anew, from one run of the tests that print its rows; a test that fails stops it.
# Usage: [SCONCE_SCENES=<folder of real scenes>] tests/properties/hard_cases/table.sh <build folder>
set -euo pipefail
build=${1:?give the build folder}
document=$(cd "$(dirname "$0")/../../.." && pwd)/docs/hard_cases.md
rows=$(mktemp) fresh=$(mktemp)
trap 'rm -f "$rows" "$fresh"' EXIT

run() # area, filter
{
    "$build/tests/$1/sconce_$1_tests" --gtest_filter="$2" | tee /dev/stderr | { grep '^| ' || true; } >>"$rows"
}
run hard_cases '*'
run frame 'TemporalTest.AMovingPicture*:FurnaceTest.*'
run tools 'Independence.*'

awk -v rows="$rows" '
    /^\| case \| inputs \| worst \| bound \|$/ { print; getline; print; while ((getline line < rows) > 0) print line; skipping = 1; next }
    skipping && /^\| / { next }
    { skipping = 0; print }' "$document" >"$fresh"
cat "$fresh" >"$document"
echo "$(wc -l <"$rows") rows written to $document" >&2
