#!/usr/bin/env bash
# Walls of 0.5 to 20 cm and a curtain without thickness between a bright room and one a hundred times darker (bench/pages/divided_room.py): how
# much light the dark room has against the path tracer, bench/results/walls.json; OUT/leaks.png has a row each: ours, reference, error in false
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
for wall in 0.5 1 2 5 10 20 curtain; do
    at=$out/$wall
    bench/pages/divided_room.py "$wall" > "$at.gltf"
    "$sconce" place "$at.gltf" --count 12 --inside -1.5,1.3,0 --inside 1.5,1.3,0 -o "$at.probes.json" --quiet > /dev/null
    "$sconce" bake "$at.gltf" --probes "$at.probes.json" --resolution 416 --bounces 4 -o "$at.sconce" --quiet > /dev/null
    for half in "" .right; do
        # the right half: the same eye, turned and narrowed to the dark room's back wall and floor
        view=(); [[ -n $half ]] && view=(--eye 0.8,1.3,2.6 --target 1.6,1.0,-1.5 --fov 40)
        "$sconce" reference "$at.gltf" "${view[@]}" --size "$size" --spp "$spp" --bounces 4 -o "$at$half.ref.exr" --png "$at$half.ref.png" --exposure "$exposure" --quiet > /dev/null
        "$sconce" render "$at.gltf" "${view[@]}" --field "$at.sconce" --size "$size" -o "$at$half.exr" --png "$at$half.png" --exposure "$exposure" --quiet > /dev/null
        "$sconce" compare "$at$half.exr" "$at$half.ref.exr" --metric relmse,flip,mean -o "$at$half.error.png" --json > "$at$half.json"
    done
    pictures+=("$at.png" "$at.ref.png" "$at.error.png")
done
python3 bench/pages/bench_rows.py walls "$out"
bench/pages/sheet.py "$out/leaks.png" 3 "${pictures[@]}"
