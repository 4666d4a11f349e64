#!/usr/bin/env bash
# docs/symptoms.png: what README names under "When it looks wrong", drawn on purpose: as it should be, unfiltered reflections, diffuse light read at probes, a capsule
# that indirect light isn't told of, the same told, maps of one probe alone on the device.
# Environment: SCONCE=the command, built when not given, SIZE=WxH [256x256], EXPOSURE [1.5], OUT=folder [out/symptoms].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/symptoms} view=(--size "${SIZE:-256x256}" --exposure "${EXPOSURE:-1.5}" --quiet)
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
echo '{"shapes": [{"kind": "capsule", "centre": [0.35, 0.85, 0.55], "half": [0.12, 0.25, 0], "albedo": [0.6, 0.6, 0.6]}]}' > "$out/shapes.json"
"$sconce" place cornell-glossy --count 8 -o "$out/probes.json" --quiet > /dev/null
"$sconce" bake cornell-glossy --probes "$out/probes.json" -o "$out/field.sconce" --quiet > /dev/null
"$sconce" bake cornell-glossy --probes "$out/probes.json" --surface-texels 0 -o "$out/flat.sconce" --quiet > /dev/null

draw() { "$sconce" render cornell-glossy --field "$out/$2.sconce" "${view[@]}" "${@:3}" -o "$out/$1.exr" --png "$out/$1.png" > /dev/null; }
draw right field
draw grain field --no-denoise
draw flat flat
draw untold field --shapes "$out/shapes.json" --drawn-only
draw told field --shapes "$out/shapes.json"
draw missing field --resident 1
bench/pages/sheet.py docs/symptoms.png 3 "$out"/{right,grain,flat,untold,told,missing}.png
