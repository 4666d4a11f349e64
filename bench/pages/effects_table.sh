#!/usr/bin/env bash
# What each effect costs, and what a scene without it saves: `--effects auto` (what the scene calls for, on its tiles) against `--effects all`
# (everything, over the whole picture), for the same pixels. Writes bench/results/effects.json and effects_passes.json.
# effects_table.sh [SCENE[=COUNT]...], each a built-in name, a file under SCONCE_SCENES, or `small-glossy` (bench/pages/emitter_room.py: one glossy object,
# small on screen), with its number of probes.
# Environment: SCONCE=the command, built when not given, SIZE=WxH [960x540], FRAMES=N timed, the median counts [5], TURNS=N of both in
# turn, the least time of each pass counts, which is what a machine with other work leaves of it [3], RESOLUTION=texels [416], OUT=folder [out/effects].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/effects} size=${SIZE:-960x540} frames=${FRAMES:-5} turns=${TURNS:-3} resolution=${RESOLUTION:-416}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell=8 small-glossy=12 cornell-glossy=8 temple=16 hall=24 town=54 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50)
mkdir -p "$out"
names=()
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    [[ $count == "$entry" ]] && count=32
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name camera=()
    if [[ $scene == small-glossy ]]; then
        scene=$at.gltf
        bench/pages/emitter_room.py 4 --glossy > "$scene"
    elif [[ $name == modern_hall ]]; then # has no camera: the first of its suggested views
        camera=(--eye 5.59993,1.5,3.76821 --target 4.69671,1.50938,3.34018 --fov 75)
    fi
    echo "--- $name" >&2
    [[ -f $at.sconce ]] || {
        "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" -o "$at.sconce" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --effects all -o "$at.all.sconce" --quiet > /dev/null
    }
    for ((turn = 0; turn < turns; ++turn)); do
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$size" --frames "$frames" -o "$at.auto.exr" --png "$at.png" --json --quiet > "$at.auto.$turn.json"
        "$sconce" render "$scene" "${camera[@]}" --field "$at.all.sconce" --size "$size" --frames "$frames" --effects all -o "$at.all.exr" --json --quiet > "$at.all.$turn.json"
    done
    "$sconce" compare "$at.auto.exr" "$at.all.exr" --metric mse --json > "$at.same.json"
    names+=("$name")
done
python3 bench/pages/bench_rows.py effects "$out" "$turns" "${names[@]}"
