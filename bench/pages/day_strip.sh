#!/usr/bin/env bash
# A day in Sponza: one field with live links under suns on their way, above the path tracer's pictures of them. Writes docs/day.png, and prints the light of each
# picture over the truth's.
# Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures [240x135], SPP=paths a pixel [192], RESOLUTION=texels [256], OUT=folder
# [out/day].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scene=${SCONCE_SCENES:-../shared/scenes}/sponza/Sponza.gltf out=${OUT:-out/day} size=${SIZE:-240x135} spp=${SPP:-192}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
# The ways that the suns' light travels with its irradiance, then the sky's radiance and what the picture is exposed by.
suns=("0.9,-0.45,0.16,2.2,1.3,0.6 0.30,0.36,0.50 1.6"
    "0.6,-1,0.14,3.0,2.6,2.1 0.45,0.55,0.70 1"
    "0.15,-1,0.12,3.3,3.1,2.8 0.50,0.62,0.80 1"
    "-0.35,-1,0.1,3.2,3.0,2.7 0.50,0.60,0.78 1"
    "-0.8,-0.7,0.08,2.6,1.9,1.2 0.35,0.42,0.55 1.3"
    "-1,-0.25,0.06,1.4,0.6,0.25 0.16,0.17,0.25 2.5")
[[ -f $out/probes.json ]] || "$sconce" place "$scene" --count 54 -o "$out/probes.json" -q > /dev/null
[[ -f $out/field.sconce ]] || "$sconce" bake "$scene" --sky 1,1,1 --group sky --probes "$out/probes.json" --resolution "${RESOLUTION:-256}" --live-links 16 -o "$out/field.sconce" -q > /dev/null
ours=() truths=()
for i in "${!suns[@]}"; do
    read -r sun sky exposure <<< "${suns[$i]}"
    at=$out/$i
    "$sconce" render "$scene" --field "$out/field.sconce" --dim "sky=$sky" --sky 1,1,1 --sun="$sun" --size "$size" --exposure "$exposure" -o "$at.exr" --png "$at.png" -q > /dev/null
    [[ -f $at.ref.exr ]] || "$sconce" reference "$scene" --sky "$sky" --sun="$sun" --size "$size" --spp "$spp" --pixel-centre --exposure "$exposure" -o "$at.ref.exr" --png "$at.ref.png" -q > /dev/null
    "$sconce" compare "$at.exr" "$at.ref.exr" --same-surface --metric relmse,flip,mean
    ours+=("$at.png") truths+=("$at.ref.png")
done
bench/pages/sheet.py docs/day.png 3 "${ours[@]:0:3}" "${truths[@]:0:3}" "${ours[@]:3}" "${truths[@]:3}"
