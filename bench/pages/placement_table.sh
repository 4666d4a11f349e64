#!/usr/bin/env bash
# What each step of placing buys, in rays and in light: plain greedy cover, the fitted grid, greedy and exchange, and that refined, with either skeleton.
# Wrong rays are the shares of RAYS glossy rays not within 1 % and within 0.2 % of the diagonal; light is diffuse relMSE over a scene's views, without
# the reference's noise, and mean. Prints rows; without arguments it writes bench/results/placement_steps.json of them.
# placement_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, TABLE, ACCURACY=the programs, built when not given, RAYS=n
# [100000], SIZE=WxH of the pictures [320x180], RESOLUTION=texels [256], SPP=paths a pixel [256], STEPS=rows, LIGHT=no judges rays alone [so of zdm2 and
# town], OUT=folder, whose references are kept [out/steps]. Without arguments over an hour on 2 cores.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source bench/pages/views.sh
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/steps} size=${SIZE:-320x180} rays=${RAYS:-100000} resolution=${RESOLUTION:-256} spp=${SPP:-256}
steps=${STEPS:-yardstick,grid,chosen,gradient,balls,balls-gradient}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command sconce_placement_table sconce_ray_accuracy >&2
sconce=${SCONCE:-build/release/tools/sconce} table=${TABLE:-build/release/tests/placement/sconce_placement_table}
accuracy=${ACCURACY:-build/release/bench/race/sconce_ray_accuracy}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 veach_ajar/veach_ajar.glb=24 map_zdm2/zdm2.glb=128 town=64)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    views=() baked=(--bounces 0 --surface-texels 0) lit=yes
    [[ $name != zdm2 && $name != town ]] || lit=no
    if [[ ${LIGHT:-$lit} == yes ]]; then
        mapfile -t views < <(views_of "$name")
        baked=(--bounces 8)
    fi
    read -ra light <<< "$(light_of "$name")"
    "$table" "$scene" "$count" --rows "$steps" --save "$at" > "$at.placed.txt"
    fields=()
    for step in ${steps//,/ }; do
        "$sconce" bake "$scene" "${light[@]}" --probes "$at-$count-$step.json" --resolution "$resolution" "${baked[@]}" -o "$at.$step.sconce" --quiet > /dev/null
        fields+=(--field "$at.$step.sconce")
        for i in "${!views[@]}"; do
            read -ra camera <<< "${views[i]}"
            [[ -f $at.$i.ref.exr ]] || "$sconce" reference "$scene" "${light[@]}" "${camera[@]}" --size "$size" --spp "$spp" --bounces 8 --pixel-centre --parts -o "$at.$i.ref.exr" --quiet > /dev/null
            "$sconce" render "$scene" "${light[@]}" "${camera[@]}" --field "$at.$step.sconce" --size "$size" -o "$at.$step.exr" --quiet > /dev/null
            "$sconce" compare "$at.$step.exr" "$at.$i.ref.exr" --layer diffuse_indirect --same-surface --metric relmse,flip,mean --json > "$at.$step.$i.json"
        done
    done
    "$accuracy" "$scene" "${fields[@]}" --rays "$rays" --runs 0 --json > "$at.race.json"
    python3 bench/pages/bench_rows.py steps "$at" "$name" "$count" "$steps" "${#views[@]}"
done | tee "$out/rows.txt"
[[ $# -gt 0 ]] || python3 bench/pages/bench_rows.py placed "$out/rows.txt"
