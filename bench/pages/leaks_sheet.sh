#!/usr/bin/env bash
# Walls of 1 to 20 cm and a curtain without thickness between a bright room and one a hundred times darker (bench/pages/divided_room.py): prints how
# much light the dark room has against the path tracer, as a Markdown table; writes OUT/leaks.png, a row each: ours, reference, error in false
# colours, shown so that the dark room is bright.
# Environment: SCONCE=the command, built when not given, SIZE=WxH [192x96], SPP=paths a pixel [512], EXPOSURE=of the pictures [12], OUT=folder
# [out/leaks].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/leaks} size=${SIZE:-192x96} spp=${SPP:-512} exposure=${EXPOSURE:-12}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
pictures=()
echo "| between the rooms | relMSE | FLIP | right half alone: relMSE | FLIP |"
echo "|---|---|---|---|---|"
for wall in 1 2 5 10 20 curtain; do
    at=$out/$wall
    bench/pages/divided_room.py "$wall" > "$at.gltf"
    "$sconce" place "$at.gltf" --count 12 --inside -1.5,1.3,0 --inside 1.5,1.3,0 -o "$at.probes.json" --quiet > /dev/null
    "$sconce" bake "$at.gltf" --probes "$at.probes.json" --resolution 416 --bounces 4 -o "$at.sconce" --quiet > /dev/null
    for half in "" .right; do
        # the right half: the same eye, turned and narrowed to the dark room's back wall and floor
        view=(); [[ -n $half ]] && view=(--eye 0.8,1.3,2.6 --target 1.6,1.0,-1.5 --fov 40)
        "$sconce" reference "$at.gltf" "${view[@]}" --size "$size" --spp "$spp" --bounces 4 -o "$at$half.ref.exr" --png "$at$half.ref.png" --exposure "$exposure" --quiet > /dev/null
        "$sconce" render "$at.gltf" "${view[@]}" --field "$at.sconce" --size "$size" --samples 4 -o "$at$half.exr" --png "$at$half.png" --exposure "$exposure" --quiet > /dev/null
        "$sconce" compare "$at$half.exr" "$at$half.ref.exr" --metric relmse,flip -o "$at$half.error.png" --json > "$at$half.json"
    done
    pictures+=("$at.png" "$at.ref.png" "$at.error.png")
    python3 - "$at" "$wall" <<'P'
import json, sys
at, wall = sys.argv[1:]
both, right = (json.load(open(at + end)) for end in (".json", ".right.json"))
name = "curtain" if wall == "curtain" else f"wall of {wall} cm"
print(f"| {name} | {both['relmse']:.4f} | {both['flip']:.3f} | {right['relmse']:.6f} | {right['flip']:.3f} |")
P
done
bench/pages/sheet.py "$out/leaks.png" 3 "${pictures[@]}"
