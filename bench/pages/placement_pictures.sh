#!/usr/bin/env bash
# Do better placed probes make better pictures? At equal count, a fitted uniform grid against ours: reflections of every surface at roughness 0.15, 64
# rays a pixel and no filter, so that what differs is the rays, against paths without bounces; from every camera of three scenes.
# Writes bench/results/placement_pictures.json and docs/placement_pictures.png; pictures stay in OUT, NAME.CAMERA.{grid,sdf,truth}.exr and
# NAME.CAMERA.{grid,sdf}.png with the truth and the error. Half an hour on 2 cores.
# Environment: SCONCE=the command, built when not given, OUT=folder [out/placement].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/placement}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"

one() # NAME FILE COUNT CAMERA...
{
    local name=$1 file=$2 count=$3 camera method
    shift 3
    for method in grid sdf; do
        [[ -f $out/$name.$method.sconce ]] && continue
        local fit=()
        [[ $method != grid ]] || fit=(--fit-grid)
        "$sconce" place "$file" --method $method "${fit[@]}" --count "$count" -o "$out/$name.$method.json" --quiet >&2
        "$sconce" bake "$file" --probes "$out/$name.$method.json" --resolution 256 --bounces 0 -o "$out/$name.$method.sconce" --quiet >&2
    done
    for camera in "$@"; do
        local view=$out/$name.$camera look=(--camera "$camera" --size 240x135 --roughness 0.15)
        [[ -f $view.truth.exr ]] ||
            "$sconce" reference "$file" "${look[@]}" --spp 256 --bounces 0 --aov glossy_indirect -o "$view.truth.exr" --quiet >&2
        for method in grid sdf; do
            "$sconce" render "$file" --field "$out/$name.$method.sconce" "${look[@]}" --rays-below 2 --samples 64 --no-denoise \
                --aov glossy_indirect -o "$view.$method.exr" --quiet >&2
            "$sconce" compare "$view.$method.exr" "$view.truth.exr" --layer glossy_indirect --metric mse,relmse,flip --side-by-side "$view.$method.png" --json > "$view.$method.error.json"
        done
        python3 - "$view" "$name, $count" "$camera" << 'P' | tee -a "$out/rows.txt"
import json, re, sys
view, label, camera = sys.argv[1:]
row = {"label": label, "camera": camera}
for key, method in (("grid", "grid"), ("ours", "sdf")):
    error = json.load(open(f"{view}.{method}.error.json"))
    row |= {f"{key}_mse": f"{error['mse']:.3g}", f"{key}_relmse": f"{error['relmse']:.4f}", f"{key}_flip": f"{error['flip']:.3f}"}
name = label.split(",")[0] + " " + camera
print(f'  "{re.sub("[^a-z0-9]+", "_", name.lower())}": {json.dumps(row)},')
P
    done
}

rm -f "$out/rows.txt"
one temple temple 16 main colonnade cella door
while read -r name file rest; do
    # shellcheck disable=SC2086 — the count and the cameras are words
    if [[ -f $scenes/$file ]]; then one "$name" "$scenes/$file" $rest < /dev/null; else echo "$name: skipped, $scenes/$file is not there" >&2; fi
done << 'SCENES'
modern_hall modern_hall/modern_hall.glb 50 camera
sponza sponza/Sponza.gltf 54 CameraMain CameraAlternate CameraBalcony CameraAlcove
SCENES
shown=()
for view in temple.colonnade temple.cella temple.door modern_hall.camera sponza.CameraMain; do
    [[ ! -f $out/$view.sdf.png ]] || shown+=("$out/$view.grid.png" "$out/$view.sdf.png")
done
bench/pages/sheet.py docs/placement_pictures.png 2 "${shown[@]}"
python3 bench/pages/bench_rows.py reflections "$out/rows.txt"
