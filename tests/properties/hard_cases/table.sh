#!/usr/bin/env bash
# Takes bench/results/hard_cases.csv anew, from one run of the tests that print its rows; a test that fails stops it.
# bench/pages/tables.py then puts what docs/limits.md shows of it there.
# Usage: [SCONCE_SCENES=<folder of real scenes>] tests/properties/hard_cases/table.sh <build folder>
set -euo pipefail
build=${1:?give the build folder}
root=$(cd "$(dirname "$0")/../../.." && pwd)
file=$root/bench/results/hard_cases.csv
rows=$(mktemp) fresh=$(mktemp)
trap 'rm -f "$rows" "$fresh"' EXIT

run() # program, filter
{
    "$build/tests/properties/$1" --gtest_filter="$2" | tee /dev/stderr | { grep '^| ' || true; } >>"$rows"
}
run sconce_hard_cases_tests '*'
run sconce_frame_tests 'TemporalTest.AMovingPicture*:FurnaceTest.*:Streaming.*:SurfaceLightFrames.*'
run sconce_command_properties_tests 'Independence.*'

{
    sed -n '/^# what:/p' "$file"
    echo "# command: SCONCE_SCENES=<folder of real scenes> tests/properties/hard_cases/table.sh $1"
    echo "# commit: $(git -C "$root" rev-parse --short=12 HEAD)"
    sed -n '/^# machine:/p' "$file"
    echo case,inputs,worst,bound
    sed -E 's/^\| //; s/ \|$//' "$rows" | awk -F ' [|] ' '{ printf "\"%s\",%s,%s,%s\n", $1, $2, $3, ($4 ~ /;/ ? "\"" $4 "\"" : $4) }'
} >"$fresh"
cat "$fresh" >"$file"
echo "$(wc -l <"$rows") rows written to $file" >&2
