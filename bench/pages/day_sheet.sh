#!/usr/bin/env bash
# A day in Sponza: one field with live links and the sky as a group, lit by six suns and skies in turn, over what the path tracer has under the same
# light, each pair at the exposure of the truth's, to docs/day.png. Prints the rows of bench/results/day.json, and writes it where no folder was given.
# day_sheet.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of a picture [256x144], SPP=paths a pixel [192], RESOLUTION=texels [256],
# LINKS=live links a texel [16], OUT=folder, whose field and pictures are kept [out/day].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scene=${SCONCE_SCENES:-../shared/scenes}/sponza/Sponza.gltf
out=${OUT:-out/day} size=${SIZE:-256x144} spp=${SPP:-192} resolution=${RESOLUTION:-256} links=${LINKS:-16}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
# Hour, the way the sun's light travels with its irradiance, and the sky's radiance.
day=("7:00 1,-0.42,0.13,1.9,1.2,0.7 0.22,0.24,0.30"
    "9:00 0.62,-0.8,0.12,2.9,2.5,2.1 0.38,0.48,0.62"
    "11:30 0.1,-1,0.05,3.2,3.0,2.7 0.45,0.55,0.70"
    "14:00 -0.3,-1,0.1,3.2,3.0,2.7 0.45,0.55,0.70"
    "17:00 -0.9,-0.6,0.12,2.5,1.9,1.3 0.36,0.40,0.48"
    "19:30 -1,-0.12,0.1,0.9,0.4,0.2 0.16,0.13,0.16")
mkdir -p "$out"
[[ -f $out/probes.json ]] || "$sconce" place "$scene" --count 54 -o "$out/probes.json" --quiet > /dev/null
[[ -f $out/day.sconce ]] ||
    "$sconce" bake "$scene" --sky 1,1,1 --group sky --live-links "$links" --probes "$out/probes.json" --resolution "$resolution" -o "$out/day.sconce" --quiet > /dev/null
for number in "${!day[@]}"; do
    read -r hour sun sky <<< "${day[number]}"
    at=$out/$number
    [[ -f $at.ref.exr ]] || "$sconce" reference "$scene" --camera 0 --sun="$sun" --sky "$sky" --size "$size" --spp "$spp" --pixel-centre -o "$at.ref.exr" --quiet > /dev/null
    [[ -f $at.exr ]] || "$sconce" render "$scene" --camera 0 --sky 1,1,1 --field "$out/day.sconce" --sun="$sun" --dim "sky=$sky" --size "$size" -o "$at.exr" --quiet > /dev/null
    for layer in beauty diffuse_indirect glossy_indirect; do
        "$sconce" compare "$at.exr" "$at.ref.exr" --layer $layer --same-surface --metric relmse,flip,mean --json > "$at.$layer.json"
    done
    "$sconce" compare "$at.exr" "$at.ref.exr" --side-by-side "$at.png" --quiet > /dev/null
    /usr/bin/python3 - "$at" << 'P'
import sys
from PIL import Image
at = sys.argv[1]
beside = Image.open(f"{at}.png")
width = beside.width // 3
beside.crop((0, 0, width, beside.height)).save(f"{at}.ours.png")
beside.crop((width, 0, 2 * width, beside.height)).save(f"{at}.truth.png")
P
    python3 - "$at" "$hour" << 'P'
import json, sys
at, hour = sys.argv[1:]
row = {"label": hour}
for layer, called in (("beauty", "picture"), ("diffuse_indirect", "diffuse"), ("glossy_indirect", "glossy")):
    found = json.load(open(f"{at}.{layer}.json"))
    row |= {f"{called}_relmse": f"{found['relmse']:.4f}", f"{called}_flip": f"{found['flip']:.3f}", f"{called}_mean": f"{found['mean']:.3f}"}
print(f'  "at_{hour.replace(":", "_")}": {json.dumps(row)},', flush=True)
P
done | tee "$out/rows.txt"
bench/pages/sheet.py docs/day.png "${#day[@]}" "$out"/[0-9].ours.png "$out"/[0-9].truth.png
[[ -n ${OUT:-} ]] || python3 bench/pages/bench_rows.py day "$out/rows.txt"
