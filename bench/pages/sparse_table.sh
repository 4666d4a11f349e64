#!/usr/bin/env bash
# Pictures from fewer rays than pixels, after the papers on sparse sampling: edges and points (sconce_edges_and_points), and a render cache, warps,
# frameless rendering and corrective textures on a flight (sconce_cached_frames). Prints rows of bench/results/edges_and_points.json and cached_frames.json, and writes both where
# no scene is given. sparse_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, EDGES, CACHED=the command and both programs,
# built when not given, SPEEDS=m/s ["0.5 2"], RESOLUTION=texels [256], OUT=folder, whose fields are kept [out/sparse].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source bench/pages/views.sh
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/sparse} resolution=${RESOLUTION:-256} speeds=${SPEEDS:-0.5 2}
[[ -n ${SCONCE:-} && -n ${EDGES:-} && -n ${CACHED:-} ]] || tools/build.sh release sconce_command sconce_edges_and_points sconce_cached_frames >&2
sconce=${SCONCE:-build/release/tools/sconce} edges=${EDGES:-build/release/bench/sparse/sconce_edges_and_points} cached=${CACHED:-build/release/bench/sparse/sconce_cached_frames}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=} group=()
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    [[ $name != hall ]] || group=(lamp "lamp=warm panel") # nearly all of its light is that one
    at=$out/$name
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    [[ -f $at.sconce ]] || "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" ${group:+--group "${group[1]}"} -o "$at.sconce" --quiet > /dev/null
    "$edges" "$scene" --field "$at.sconce" -o "$at" > "$at.edges.json"
    for speed in $speeds; do
        "$cached" "$scene" --field "$at.sconce" --speed "$speed" ${group:+--switch "${group[0]}" --to 0.5} -o "$at.$speed" > "$at.$speed.json"
    done
    python3 bench/pages/bench_rows.py sparse "$at" "$name, $count" "$speeds"
done | tee "$out/rows.txt"
[[ $# -gt 0 ]] || python3 bench/pages/bench_rows.py sparses "$out/rows.txt"
