#!/usr/bin/env bash
# A light field whose maps come from its file while a camera flies through it, with room for 1/2 to 1/8 of its probes and at three speeds, against the
# whole field, and a picture that has settled: writes bench/results/streaming.json.
# stream_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, FLY=the command and sconce_fly_through, built when not given,
# SHARES=one of so many probes ["2 4 8"], SPEEDS=m/s ["10 40 100"], FRAMES=n [100], RESOLUTION=texels [256], OUT=folder, whose fields are kept [out/stream].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source bench/pages/views.sh
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/stream} frames=${FRAMES:-100} resolution=${RESOLUTION:-256}
[[ -n ${SCONCE:-} && -n ${FLY:-} ]] || tools/build.sh release sconce_command sconce_fly_through >&2
sconce=${SCONCE:-build/release/tools/sconce} fly=${FLY:-build/release/bench/race/sconce_fly_through}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(town=64 map_zdm2/zdm2.glb=128)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    read -ra light <<< "$(light_of "$name")"
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    [[ -f $at.sconce ]] || "$sconce" bake "$scene" "${light[@]}" --probes "$at.probes.json" --resolution "$resolution" -o "$at.sconce" --quiet > /dev/null
    mapfile -t views < <(views_of "$name")
    read -ra camera <<< "${views[0]}"
    drawn=("$scene" "${light[@]}" "${camera[@]}" --field "$at.sconce" --size 320x180 --quiet)
    "$sconce" render "${drawn[@]}" -o "$at.whole.exr" > /dev/null
    for share in ${SHARES:-2 4 8}; do
        "$sconce" render "${drawn[@]}" --resident $((count / share)) -o "$at.exr" > /dev/null
        "$sconce" compare "$at.exr" "$at.whole.exr" --metric flip,mean --json > "$at.$share.json"
        for speed in ${SPEEDS:-10 40 100}; do
            "$fly" "$scene" --field "$at.sconce" --resident $((count / share)) --speed "$speed" --frames "$frames" > "$at.$share.$speed.json"
            python3 bench/pages/bench_rows.py fly "$at.$share.$speed.json" "$at.$share.json" "$name"
        done
    done
done | tee "$out/rows.txt"
[[ $# -gt 0 ]] || python3 bench/pages/bench_rows.py flights "$out/rows.txt"
