#!/usr/bin/env bash
# What probes and texels buy a ray: placed probes of Sponza, more of them and finer ones, all traced in one run. Writes bench/results/probes_and_resolution.json.
# Ten minutes on 2 cores, which should have nothing else to do.
# Environment: SCONCE, ACCURACY=the programs, built when not given, SCONCE_SCENES [../shared/scenes], RAYS=n [100000], RUNS=timed runs [12],
# FIELDS=counts and texels, first the one that times are relative to, OUT=folder, whose fields are kept [out/resolution].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scene=${SCONCE_SCENES:-../shared/scenes}/sponza/Sponza.gltf out=${OUT:-out/resolution}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command sconce_ray_accuracy >&2
sconce=${SCONCE:-build/release/tools/sconce} accuracy=${ACCURACY:-build/release/bench/race/sconce_ray_accuracy}
mkdir -p "$out"
fields=()
for entry in ${FIELDS:-54_256 16_256 256_256 1024_256 54_128 54_512 54_1024}; do
    count=${entry%_*} at=$out/$entry.sconce
    [[ -f $out/$count.json ]] || "$sconce" place "$scene" --count "$count" -o "$out/$count.json" -q > /dev/null
    [[ -f $at ]] || "$sconce" bake "$scene" --probes "$out/$count.json" -o "$at" --resolution "${entry#*_}" --bounces 0 --surface-texels 0 -q > /dev/null
    fields+=(--field "$at")
done
"$accuracy" "$scene" "${fields[@]}" --rays "${RAYS:-100000}" --runs "${RUNS:-12}" --memory 4096 --json > "$out/race.json"
python3 bench/pages/bench_rows.py resolution "$out/race.json"
