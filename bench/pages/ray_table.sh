#!/usr/bin/env bash
# Glossy rays of Sconce and of its opponents against Embree, at equal memory. Writes bench/results/sponza_rays.json and scene_rays.json.
# ray_table.sh [SCENE=COUNT]... as bench/pages/effects_table.sh, Sponza among them. Environment: RAYS=n [200000], RUNS=timed runs of a race [12],
# OUT=folder, whose fields are kept [out/rays]. Grids stand in the better of two poses, by rays.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/rays}
tools/build.sh release sconce_command sconce_ray_accuracy >&2
sconce=build/release/tools/sconce race=build/release/bench/race/sconce_ray_accuracy
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 temple=16 cornell-glossy=7 cornell_mcguire/cornell_glossy.glb=7 map_zdm2/zdm2.glb=128 san_miguel/san_miguel.glb=256)
mkdir -p "$out"

# FILE PROBES RESOLUTION CHART: geometry alone.
bake() { [[ -f $1 ]] || "$sconce" bake "$scene" --probes "$2" -o "$1" --resolution "$3" --chart "$4" --bounces 0 --surface-texels 0 -q > /dev/null; }

rows=()
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    at=$out/$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    "$sconce" place "$scene" --count "$count" -o "$at.json" -q > /dev/null
    bake "$at.ours.sconce" "$at.json" 416 cube
    bake "$at.oct.sconce" "$at.json" 512 octahedral
    fields=("ours=$at.ours.sconce" "b0plus-octree=$at.oct.sconce")
    for pose in fit plain; do
        [[ $pose == fit ]] && fit=(--fit-grid) || fit=()
        "$sconce" place "$scene" --method grid --count "$count" "${fit[@]}" -o "$at.$pose.json" -q > /dev/null
        bake "$at.$pose.sconce" "$at.$pose.json" 512 octahedral
        fields+=("b0plus=$at.$pose.sconce")
    done
    if [[ $at == */Sponza ]]; then
        bake "$at.wang.sconce" "$at.json" 1024 cube
        fields+=("wang=$at.wang.sconce")
        for knob in opinion:0 farBounds:1 ranked:2 ranked:1; do fields+=("ours/$knob=$at.ours.sconce"); done
    fi
    arguments=()
    for field in "${fields[@]}"; do arguments+=(--field "$field"); done
    "$race" "$scene" "${arguments[@]}" --rays "${RAYS:-200000}" --runs "${RUNS:-12}" --json > "$at.race.json"
    rows+=("$count" "$at")
done
python3 bench/pages/bench_rows.py rays "${rows[@]}"
