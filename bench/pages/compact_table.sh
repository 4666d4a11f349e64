#!/usr/bin/env bash
# Maps in blocks (bake --compact) beside the same maps in texels: bytes, right rays, the time that lists of rays take, and the error of reflections, all of them traced.
# Writes bench/results/compact.json.
# compact_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, ACCURACY=the programs, built when not given, RAYS=n
# [100000], SIZE=WxH [320x180], SPP=paths a pixel of the reference [128], RESOLUTION=texels [512], OUT=folder, whose fields and references are kept
# [out/compact].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/compact} size=${SIZE:-320x180}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command sconce_ray_accuracy >&2
sconce=${SCONCE:-build/release/tools/sconce} accuracy=${ACCURACY:-build/release/bench/race/sconce_ray_accuracy}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54)
mkdir -p "$out"
tables=()
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    [[ -f $at.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.json" -q > /dev/null
    [[ -f $at.ref.exr ]] || "$sconce" reference "$scene" --roughness 0.2 --bounces 4 --size "$size" --spp "${SPP:-128}" --pixel-centre -o "$at.ref.exr" -q > /dev/null
    for form in texels blocks; do
        [[ -f $at.$form.sconce ]] || "$sconce" bake "$scene" --probes "$at.json" -o "$at.$form.sconce" --resolution "${RESOLUTION:-512}" --bounces 4 $([[ $form == blocks ]] && echo --compact) --json -q > "$at.$form.bake.json"
        "$sconce" info "$at.$form.sconce" --json > "$at.$form.info.json"
        "$sconce" render "$scene" --field "$at.$form.sconce" --roughness 0.2 --rays-below 2 --samples 4 --size "$size" -o "$at.$form.exr" -q > /dev/null
        "$sconce" compare "$at.$form.exr" "$at.ref.exr" --layer glossy_indirect --same-surface --metric relmse,flip,mean --json > "$at.$form.compare.json"
    done
    for turn in 1 2 3 4 5; do # one form after the other, again and again: a machine isn't as fast all the time
        for form in texels blocks; do
            "$sconce" render "$scene" --field "$at.$form.sconce" --roughness 0.2 --rays-below 2 --samples 4 --size "$size" --frames 5 --aov glossy_indirect -o "$at.timed.exr" --json -q > "$at.$form.$turn.render.json"
        done
    done
    "$accuracy" "$scene" --field "ours=$at.texels.sconce" --field "ours=$at.blocks.sconce" --rays "${RAYS:-100000}" --json > "$at.race.json"
    tables+=("$name=$at")
done
python3 bench/pages/bench_rows.py compact "${tables[@]}"
