#!/usr/bin/env bash
# Light bounce by bounce: the mean of a view's indirect light over the path tracer's, both with as many bounces. Prints the rows of
# bench/results/bounces.json, and writes it where no scene is given.
# bounces_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures
# [320x180], SPP=paths a pixel [128], RESOLUTION=texels [256], BOUNCES=counts ["1 2 4 8"], OUT=folder, whose references are kept [out/bounces].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/bounces} size=${SIZE:-320x180} spp=${SPP:-128} resolution=${RESOLUTION:-256} bounces=${BOUNCES:-1 2 4 8}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 veach_ajar/veach_ajar.glb=24 town=64)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=} camera=()
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    [[ $name != modern_hall ]] || camera=(--eye=5.59993,1.5,3.76821 --target=4.69671,1.50938,3.34018 --fov=75) # it has none of its own
    at=$out/$name
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    for b in $bounces; do
        [[ -f $at.$b.ref.exr ]] || "$sconce" reference "$scene" "${camera[@]}" --size "$size" --spp "$spp" --bounces "$b" --pixel-centre -o "$at.$b.ref.exr" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --bounces "$b" --converged 0 -o "$at.sconce" --quiet > /dev/null
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$size" -o "$at.$b.exr" --quiet > /dev/null
        for layer in diffuse_indirect glossy_indirect beauty; do
            "$sconce" compare "$at.$b.exr" "$at.$b.ref.exr" --layer $layer --same-surface --metric mean --json > "$at.$b.$layer.json"
        done
        rm "$at.sconce"
    done
    python3 - "$at" "$name" "$count" "$bounces" << 'P'
import json, sys
at, name, count, bounces = sys.argv[1:]
mean = lambda b, layer: f"{json.load(open(f'{at}.{b}.{layer}.json')).get('mean') or float('nan'):.3f}"
row = {"label": f"{name}, {count}"} | {f"{key}_{b}": mean(b, layer) for key, layer in
       (("diffuse", "diffuse_indirect"), ("glossy", "glossy_indirect"), ("picture", "beauty")) for b in bounces.split()}
print(f'  "{name.lower().replace("-", "_")}": {json.dumps(row)},', flush=True)
P
done | tee "$out/rows.txt"
[[ $# -gt 0 ]] || python3 bench/pages/bench_rows.py bounces "$out/rows.txt"
