#!/usr/bin/env bash
# The trace pass of whole frames, tracer against tracer: every surface glossy (roughness 0.15), one ray a pixel, the same picture and device, in
# turns. Prints a Markdown table; ratios, of the medians and of the least times, are to the last field's.
#   bench/pages/frame_times.sh SCENE TRACER=FIELD.sconce...       tracers as `sconce render --tracer` names them
# Environment: SCONCE=the command, built when not given, SIZE=WxH [960x540], FRAMES=N a turn [5], TURNS=N [4], OUT=folder [out/frames],
# CAMERA="--eye ... --target ... --fov ..." [the scene's own].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scene=$1; shift
out=${OUT:-out/frames} size=${SIZE:-960x540} frames=${FRAMES:-5} turns=${TURNS:-4}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
for ((turn = 0; turn < turns; ++turn)); do
    for i in $(seq $#); do
        entry=${!i}
        "$sconce" render "$scene" ${CAMERA:-} --tracer "${entry%%=*}" --field "${entry#*=}" --size "$size" --frames "$frames" --roughness 0.15 --rays-below 2 \
            --no-denoise --effects glossy -o "$out/$i.exr" --json --quiet > "$out/$i.$turn.json" 2>> "$out/log"
        echo "turn $turn: $entry" >&2
    done
done
python3 - "$out" "$turns" "$@" <<'PY'
import json, statistics, sys
out, turns, entries = sys.argv[1], int(sys.argv[2]), sys.argv[3:]
runs = [[json.load(open(f"{out}/{i + 1}.{t}.json")) for t in range(turns)] for i in range(len(entries))]
trace = [[r["passes_ms"]["glossy trace"] for r in run] for run in runs]
median, least = statistics.median(trace[-1]), min(trace[-1])
print("| tracer, field | reads a ray | hand-offs | unresolved | trace ms: median (least to most of the turns) | ratio of medians, of the least |\n|---|---|---|---|---|---|")
for entry, run, ms in zip(entries, runs, trace):
    last = run[-1]
    print(f"| {entry} | {last['fetches_per_ray']:.1f} | {last['handoffs_per_ray']:.2f} | {100 * last['unknown_share']:.2f} % "
          f"| {statistics.median(ms):.0f} ({min(ms):.0f} to {max(ms):.0f}) | {statistics.median(ms) / median:.2f}, {min(ms) / least:.2f} |")
PY
