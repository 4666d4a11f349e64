#!/usr/bin/env bash
# Each effect alone: its error against the path tracer, its passes' time, and a row of a sheet: the layer that is judged, ours, reference, error in
# false colours.
# Prints the rows of bench/results/each_effect.json, which it writes, and OUT/effects.png, which docs has.
# Environment: SCONCE=the command, built when not given, SIZE=WxH [160x90], SPP=paths a pixel [256], SCONCE_SCENES [../shared/scenes],
# OUT=folder [out/sheet].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/sheet} size=${SIZE:-160x90} spp=${SPP:-256} scenes=${SCONCE_SCENES:-../shared/scenes}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
bench/pages/emitter_room.py 16 > "$out/room16.gltf"
bench/pages/emitter_room.py 16 --point > "$out/point.gltf"
bench/pages/emitter_room.py 16 > "$out/host.gltf" # the room without its guest: the field of the row `moving object`
bench/pages/emitter_room.py 16 --guest > "$out/guest.gltf"
pictures=()
rm -f "$out/rows.txt"
# effect, scene, number of probes, layer that is judged, passes that are the effect's, options of render, options of reference, and what the
# field was baked from where it isn't the scene
while IFS='|' read -r effect scene count layer passes options truth baked; do
    name=$(basename "${scene%.gl*}") at=$out/${effect// /-}
    baked=${baked:-$scene}
    field=$out/$(basename "${baked%.gl*}").sconce reference=$out/$name${truth// /_}
    if [[ ! -f $field ]]; then
        "$sconce" place "$baked" --count "$count" -o "$field.probes.json" --quiet > /dev/null
        "$sconce" bake "$baked" --probes "$field.probes.json" --resolution 416 --bounces 4 --effects all -o "$field" --quiet > /dev/null
    fi
    # shellcheck disable=SC2086 # options are several words
    [[ -f $reference.exr ]] || "$sconce" reference "$scene" --size "$size" --spp "$spp" --bounces 4 $truth -o "$reference.exr" --quiet > /dev/null
    # shellcheck disable=SC2086
    "$sconce" render "$scene" --field "$field" --size "$size" --frames 5 $options -o "$at.exr" --json --quiet > "$at.json" 2> "$at.log"
    "$sconce" compare "$at.exr" "$reference.exr" --layer "$layer" --metric relmse,flip --side-by-side "$at.png" --json > "$at.error.json"
    pictures+=("$at.png")
    python3 - "$at" "$effect" "$name" "$layer" "$passes" << 'P' | tee -a "$out/rows.txt"
import json, re, sys
at, effect, name, layer, passes = sys.argv[1:]
ms, error = json.load(open(at + ".json"))["passes_ms"], json.load(open(at + ".error.json"))
row = {"label": effect, "scene": name, "of": layer, "passes": ", ".join(f"{p} {ms[p]:.1f}" for p in passes.split(",") if p in ms),
       "relmse": f"{error['relmse']:.4f}", "flip": f"{error['flip']:.3f}"}
print(f'  "{re.sub("[^a-z0-9]+", "_", effect)}": {json.dumps(row)},')
P
done <<LIST
diffuse|cornell|8|diffuse_indirect|surface light,lamp light|--effects diffuse|
diffuse by irradiance|cornell|8|diffuse_indirect|gather light,area light,diffuse denoise|--effects diffuse --diffuse irradiance|
traced diffuse|cornell|8|diffuse_indirect|diffuse trace,diffuse denoise|--effects diffuse --diffuse traced|
rough|cornell|8|glossy_indirect|gather light|--effects rough|
glossy|cornell-glossy|8|glossy_indirect|glossy trace,glossy denoise|--effects glossy,denoise|
glossy unfiltered|cornell-glossy|8|glossy_indirect|glossy trace|--effects glossy|
mirror|cornell|8|glossy_indirect|mirror trace|--roughness 0 --effects mirror|--roughness 0
emitters|$out/room16.gltf|12|diffuse_indirect|surface light,lamp light|--effects diffuse|
sun|temple|16|direct|direct light|--effects none|
punctual|$out/point.gltf|12|direct|direct light|--effects none|
sky|temple|16|diffuse_indirect|surface light|--effects diffuse|
curtains, leaves|$scenes/sponza/Sponza.gltf|54|diffuse_indirect|surface light|--effects diffuse|
moving object|$out/guest.gltf|12|beauty|surface light,lamp light,gather light,glossy trace,glossy denoise|--effects auto||$out/host.gltf
LIST
bench/pages/sheet.py "$out/effects.png" 1 "${pictures[@]}"
python3 bench/pages/bench_rows.py each_effect "$out/rows.txt"
