#!/usr/bin/env bash
# The orders in which a ray asks a voxel's probes (TraceQuality::order): right rays, reads and hand-offs of each, on the same fields. Writes
# bench/results/probe_orders.json.
# order_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, ACCURACY=the programs, built when not given, RAYS=n
# [100000], OUT=folder, whose fields are kept [out/orders].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/orders}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command sconce_ray_accuracy >&2
sconce=${SCONCE:-build/release/tools/sconce} accuracy=${ACCURACY:-build/release/bench/race/sconce_ray_accuracy}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 town=64 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50)
mkdir -p "$out"
races=()
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    [[ -f $at.sconce ]] || {
        "$sconce" place "$scene" --count "$count" -o "$at.json" -q > /dev/null
        "$sconce" bake "$scene" --probes "$at.json" -o "$at.sconce" --resolution 256 --bounces 0 --surface-texels 0 -q > /dev/null
    }
    fields=()
    for order in 0 1 2 3; do fields+=(--field "ours/order:$order=$at.sconce"); done
    "$accuracy" "$scene" "${fields[@]}" --rays "${RAYS:-100000}" --json > "$at.race.json"
    races+=("$name=$at.race.json")
done
python3 bench/pages/bench_rows.py orders "${races[@]}"
