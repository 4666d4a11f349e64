#!/usr/bin/env bash
# Places, bakes, renders, references and compares: bench/run.sh [SCENE...], each a built-in name or a .gltf/.glb file
# [default: cornell-glossy]. Results: out/SCENE/{report.md,index.html,results.json,*.png,*.exr}.
# Environment: SIZE=WxH [480x270], SPP=N of the reference [64], RESOLUTION=texels [512], BOUNCES=N [2], COUNT=probes [by coverage],
# FRAMES=N timed, the median counts [5], ROUGHNESS=0..1 of every surface [the materials' own], CAMERA=name [the first], OUT=folder [out].
set -euo pipefail
start=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD

size=${SIZE:-480x270} spp=${SPP:-64} resolution=${RESOLUTION:-512} bounces=${BOUNCES:-2} frames=${FRAMES:-5}
out=${OUT:-$root/out}
[[ $out = /* ]] || out=$start/$out
scenes=("$@")
[[ ${#scenes[@]} -eq 0 ]] && scenes=(cornell-glossy)

tools/install_packages.sh
tools/build.sh release sconce_command sconce_ray_accuracy
sconce=$root/build/release/tools/sconce

value() { python3 -c 'import json, sys; v = json.load(open(sys.argv[1]))
for k in sys.argv[2].split("."): v = v[k]
print(v)' "$1" "$2"; }
step() { # step NAME.json COMMAND...: runs the command, its JSON goes to the file
    local json=$1
    shift
    echo "--- $2${3:+ $3}" >&2
    "$@" --json > "$json.part"
    mv "$json.part" "$json"
}

for scene in "${scenes[@]}"; do
    [[ -f $start/$scene ]] && scene=$start/$scene
    name=$(basename "$scene")
    name=${name%.gl*}
    folder=$out/$name
    mkdir -p "$folder"
    echo "=== $name -> $folder" >&2
    picture=("--size" "$size")
    [[ -n ${CAMERA:-} ]] && picture+=("--camera" "$CAMERA")
    [[ -n ${ROUGHNESS:-} ]] && picture+=("--roughness" "$ROUGHNESS")
    count=()
    [[ -n ${COUNT:-} ]] && count=("--count" "$COUNT")
    began=$SECONDS

    step "$folder/place_ours.json" "$sconce" place "$scene" -o "$folder/probes_ours.json" "${count[@]}"
    probes=$(value "$folder/place_ours.json" probes)
    step "$folder/place_grid.json" "$sconce" place "$scene" -o "$folder/probes_grid.json" --method grid --count "$probes"
    step "$folder/bake_ours.json" "$sconce" bake "$scene" --probes "$folder/probes_ours.json" -o "$folder/ours.sconce" --resolution "$resolution" --bounces "$bounces"
    step "$folder/bake_grid.json" "$sconce" bake "$scene" --probes "$folder/probes_grid.json" -o "$folder/grid.sconce" --resolution "$resolution" --bounces "$bounces" --chart octahedral
    step "$folder/reference.json" "$sconce" reference "$scene" "${picture[@]}" --spp "$spp" --bounces "$bounces" --pixel-centre -o "$folder/reference.exr" --png "$folder/reference.png"
    exposure=$(value "$folder/reference.json" exposure)
    step "$folder/render_ours.json" "$sconce" render "$scene" --frames "$frames" --field "$folder/ours.sconce" "${picture[@]}" -o "$folder/ours.exr" --png "$folder/ours.png" --exposure "$exposure"
    step "$folder/render_b0plus.json" "$sconce" render "$scene" --frames "$frames" --field "$folder/grid.sconce" --tracer b0plus "${picture[@]}" -o "$folder/b0plus.exr" --png "$folder/b0plus.png" --exposure "$exposure"
    for tracer in ours b0plus; do
        step "$folder/compare_$tracer.json" "$sconce" compare "$folder/$tracer.exr" "$folder/reference.exr" -o "$folder/error_$tracer.png"
    done
    step "$folder/rays.json" "$root/build/release/bench/sconce_ray_accuracy" "$scene" --field "$folder/ours.sconce" --field "$folder/grid.sconce" --runs "$frames"
    python3 bench/report/report.py "$folder" "$name" "$((SECONDS - began))"
done
