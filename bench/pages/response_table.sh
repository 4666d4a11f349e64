#!/usr/bin/env bash
# How light follows a lamp of hall that is switched on: live light, with the whole field and a sixteenth of its probes a frame, beside what an irradiance
# volume of the same rays leaves after blending (Majercik et al. 2021, hysteresis 0.97, gamma 1 and 5, and with changes detected as its SDK does). Prints bench/results/light_response.json.
# Environment: SCONCE, RESPONSE=the programs, built when not given, COUNT=probes [32], RESOLUTION=texels [192], LINKS=live links a texel [16],
# LAMP=its place [10,5,0], FRAMES=that are followed [300], OUT=folder, whose field is kept [out/response].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/response} lamp=${LAMP:-10,5,0} frames=${FRAMES:-300}
[[ -n ${SCONCE:-} && -n ${RESPONSE:-} ]] || tools/build.sh release sconce_command sconce_light_response >&2
sconce=${SCONCE:-build/release/tools/sconce} response=${RESPONSE:-build/release/bench/race/sconce_light_response}
mkdir -p "$out"
echo "{\"lights\": [{\"type\": \"point\", \"position\": [$lamp], \"intensity\": [40, 36, 30]}]}" > "$out/lamp.json"
[[ -f $out/hall.sconce ]] || {
    "$sconce" place hall --count "${COUNT:-32}" -o "$out/hall.json" --quiet > /dev/null
    "$sconce" bake hall --lights "$out/lamp.json" --probes "$out/hall.json" --resolution "${RESOLUTION:-192}" --live-links "${LINKS:-16}" -o "$out/hall.sconce" --quiet > /dev/null
}
"$response" "$out/hall.sconce" --frames "$frames" > "$out/curve.txt"
python3 bench/pages/bench_rows.py response "$out/curve.txt"
