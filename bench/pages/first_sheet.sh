#!/usr/bin/env bash
# README's first picture, docs/sponza.png: Sponza as it is drawn by default, filtered over 16 frames, beside the path tracer's.
# Environment: SCONCE=the command, built when not given, SPP=paths a pixel [256], SIZE=WxH [640x360], EXPOSURE [0.6], OUT=folder, whose field and reference are
# kept [out/first].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scene=${SCONCE_SCENES:-../shared/scenes}/sponza/Sponza.gltf out=${OUT:-out/first} view=(--size "${SIZE:-640x360}" --exposure "${EXPOSURE:-0.6}")
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
[[ -f $out/probes.json ]] || "$sconce" place "$scene" --count 54 -o "$out/probes.json" --quiet > /dev/null
[[ -f $out/field.sconce ]] || "$sconce" bake "$scene" --probes "$out/probes.json" -o "$out/field.sconce" --quiet > /dev/null
[[ -f $out/truth.exr ]] || "$sconce" reference "$scene" "${view[@]}" --spp "${SPP:-256}" --pixel-centre -o "$out/truth.exr" --png "$out/truth.png" --quiet > /dev/null
"$sconce" render "$scene" "${view[@]}" --field "$out/field.sconce" --temporal --frames 16 -o "$out/ours.exr" --png "$out/ours.png" --quiet > /dev/null
bench/pages/sheet.py docs/sponza.png 2 "$out/ours.png" "$out/truth.png"
