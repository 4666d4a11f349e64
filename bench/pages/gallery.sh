#!/usr/bin/env bash
# Pictures of large scenes, ours on the left and the path tracer's on the right, as both are with the commands' defaults but for what stands below, at
# the exposure of the reference's log-average: docs/gallery/NAME.jpg. Prints the rows of bench/results/gallery.json, and writes it where no scene is given.
# gallery.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of a picture [1280x720],
# SPP=paths a pixel [128], RESOLUTION=texels [256], OUT=folder, whose fields and pictures are kept [out/gallery].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source bench/pages/views.sh
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/gallery} size=${SIZE:-1280x720} spp=${SPP:-128} resolution=${RESOLUTION:-256}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(sponza/Sponza.gltf=54 hall=24 town=64 country_kitchen/country_kitchen.glb=48 gas_station/GasStation.gltf=64 temple=16 map_zdm2/zdm2.glb=96 modern_hall/modern_hall.glb=50)
# What is worth a picture, an argument of the command each.
view_of() {
    case $1 in
        modern_hall) echo --eye=3.6,1.6,2.9 --target=3,1.6,1.2 --fov=70 ;;
        temple) echo --camera=1 ;; # its colonnade
        *) views_of "$1" | head -n 1 ;;
    esac
}
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    read -ra camera <<< "$(view_of "$name")"
    read -ra light <<< "$(light_of "$name")"
    read -ra inside <<< "$(inside_of "$name")"
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" "${inside[@]}" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    [[ -f $at.sconce ]] || "$sconce" bake "$scene" "${light[@]}" --probes "$at.probes.json" --resolution "$resolution" -o "$at.sconce" --quiet > /dev/null
    [[ -f $at.ref.exr ]] || # edges as a rasteriser's, one look a pixel
        "$sconce" reference "$scene" "${light[@]}" "${camera[@]}" --size "$size" --spp "$spp" --pixel-centre --png "$at.ref.png" -o "$at.ref.exr" --json --quiet > "$at.ref.json"
    exposure=$(python3 -c 'import json, sys; print(json.load(open(sys.argv[1]))["exposure"])' "$at.ref.json")
    "$sconce" render "$scene" "${light[@]}" "${camera[@]}" --field "$at.sconce" --size "$size" --temporal --frames 16 --png "$at.png" --exposure "$exposure" -o "$at.exr" --quiet > /dev/null
    "$sconce" compare "$at.exr" "$at.ref.exr" --same-surface --metric relmse,flip,mean -o "$at.error.png" --json > "$at.error.json"
    mkdir -p docs/gallery
    /usr/bin/python3 - "$at" "docs/gallery/$(tr A-Z a-z <<< "$name").jpg" << 'P'
import sys
from PIL import Image
at, to = sys.argv[1:]
ours, truth = (Image.open(f"{at}{end}.png").convert("RGB") for end in ("", ".ref"))
pair = Image.new("RGB", (2 * ours.width, ours.height))
pair.paste(ours, (0, 0))
pair.paste(truth, (ours.width, 0))
pair.save(to, quality=85, optimize=True)
P
    python3 - "$at" "$name" "$count" << 'P'
import json, sys
at, name, count = sys.argv[1:]
load = lambda end: json.load(open(f"{at}.{end}.json"))
error, truth = load("error"), load("ref")
row = {"label": f"{name}, {count}", "relmse": f"{error['relmse']:.4f}", "flip": f"{error['flip']:.3f}", "mean": f"{error['mean']:.3f}", "truths_own": f"{truth['estimated_relmse']:.4f}"}
print(f'  "{name.lower().replace("-", "_")}": {json.dumps(row)},', flush=True)
P
done | tee "$out/rows.txt"
[[ $# -gt 0 ]] || python3 bench/pages/bench_rows.py gallery "$out/rows.txt"
