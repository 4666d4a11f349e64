#!/usr/bin/env bash
# Glossy rays of Sconce and of its opponents on Sponza with 54 probes against Embree, at equal memory. Writes bench/results/sponza_rays.json and
# tracer_targets.json. Environment: SCONCE, ACCURACY=the programs, built when not given, SCONCE_SCENES=folder [../shared/scenes], RAYS=n [200000], RUNS=timed runs of a race [12], OUT=folder, whose fields are
# kept [out/rays]. Grids stand in the better of two poses, by rays.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scene=${SCONCE_SCENES:-../shared/scenes}/sponza/Sponza.gltf out=${OUT:-out/rays} count=54
[[ -n ${SCONCE:-} && -n ${ACCURACY:-} ]] || tools/build.sh release sconce_command sconce_ray_accuracy >&2
sconce=${SCONCE:-build/release/tools/sconce} race=${ACCURACY:-build/release/bench/race/sconce_ray_accuracy}
mkdir -p "$out"
at=$out/Sponza

# FILE PROBES RESOLUTION CHART: geometry alone.
bake() { [[ -f $1 ]] || "$sconce" bake "$scene" --probes "$2" -o "$1" --resolution "$3" --chart "$4" --bounces 0 --surface-texels 0 -q > /dev/null; }

"$sconce" place "$scene" --count "$count" -o "$at.json" -q > /dev/null
bake "$at.ours.sconce" "$at.json" 416 cube
bake "$at.oct.sconce" "$at.json" 512 octahedral
bake "$at.wang.sconce" "$at.json" 1024 cube
fields=("ours=$at.ours.sconce" "b0plus-octree=$at.oct.sconce" "wang=$at.wang.sconce")
for pose in fit plain; do
    [[ $pose == fit ]] && fit=(--fit-grid) || fit=()
    "$sconce" place "$scene" --method grid --count "$count" "${fit[@]}" -o "$at.$pose.json" -q > /dev/null
    bake "$at.$pose.sconce" "$at.$pose.json" 512 octahedral
    fields+=("b0plus=$at.$pose.sconce")
done
for knob in opinion:0 farBounds:1 ranked:2 ranked:1; do fields+=("ours/$knob=$at.ours.sconce"); done
arguments=()
for field in "${fields[@]}"; do arguments+=(--field "$field"); done
"$race" "$scene" "${arguments[@]}" --rays "${RAYS:-200000}" --runs "${RUNS:-12}" --json > "$at.race.json"
python3 bench/pages/bench_rows.py rays "$at.race.json"
