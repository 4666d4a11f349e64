#!/usr/bin/env bash
# Paths through a light field (sconce_field_paths) of 1, 2 and 4 rays on a field of direct light alone, against the path tracer at equal bounces,
# and of one ray on a field of all bounces, beside the frame that reads light at surfaces. Prints the rows of bench/results/field_paths.json, and
# writes it where no scene is given.
# paths_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, PATHS=the command and sconce_field_paths, built when not
# given, SIZE=WxH [160x90], SPP=paths a pixel of the references [1024], OURS=paths a pixel [64], RESOLUTION=texels [256], OUT=folder [out/paths].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/paths} size=${SIZE:-160x90} spp=${SPP:-1024} ours=${OURS:-64} resolution=${RESOLUTION:-256}
[[ -n ${SCONCE:-} && -n ${PATHS:-} ]] || tools/build.sh release sconce_command sconce_field_paths >&2
sconce=${SCONCE:-build/release/tools/sconce} paths=${PATHS:-build/release/bench/race/sconce_field_paths}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    bake() { "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --lamp-texels 0 --effects all --quiet "$@" > /dev/null; }
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    bake --bounces 0 --live-links 8 -o "$at.direct.sconce"
    bake --bounces 16 -o "$at.all.sconce"
    for bounces in 0 1 3 16; do
        view=$at.$bounces field=direct rays=$((bounces + 1))
        [[ $bounces != 16 ]] || field=all rays=1
        [[ -f $view.ref.exr ]] || "$sconce" reference "$scene" --camera 0 --size "$size" --spp "$spp" --bounces "$bounces" --pixel-centre --parts -o "$view.ref.exr" --quiet > /dev/null
        "$paths" "$scene" --field "$at.$field.sconce" --reference "$view.ref.exr" --rays "$rays" --paths "$ours" -o "$view.exr" > "$view.json"
    done
    "$sconce" render "$scene" --camera 0 --field "$at.all.sconce" --size "$size" -o "$at.frame.exr" --json --quiet > "$at.frame.json"
    for layer in diffuse glossy; do
        "$sconce" compare "$at.frame.exr" "$at.16.ref.exr" --layer ${layer}_indirect --same-surface --metric relmse,flip,mean --json > "$at.frame.$layer.json"
    done
    python3 - "$at" "$name" "$count" << 'P'
import json, sys
at, name, count = sys.argv[1:]
load = lambda end: json.load(open(f"{at}.{end}.json"))
row = {"label": f"{name}, {count}"}
for bounces, called in ((0, "1"), (1, "2"), (3, "4"), (16, "all")):
    of = load(str(bounces))
    ours, theirs = of["ours"], of.get("path_tracer")
    for layer in ("diffuse", "glossy"):
        found = ours[f"{layer}_indirect"]
        row |= {f"{layer}_mean_{called}": f"{found['mean']:.3f}", f"{layer}_relmse_{called}": f"{found['relmse']:.4f}", f"{layer}_endless_{called}": f"{found['relmse_of_endless']:.4f}"}
        if bounces < 16: # as many bounces as the paths of triangles have
            row[f"theirs_{layer}_relmse_{called}"] = f"{theirs[f'{layer}_indirect']['relmse']:.4f}"
    row |= {f"right_{called}": f"{100 * of['rays'][-1]['right_1']:.1f}", f"trace_s_{called}": f"{ours['trace_seconds']:.2f}", f"s_{called}": f"{ours['seconds']:.2f}"}
    if bounces < 16:
        row |= {f"theirs_s_{called}": f"{theirs['seconds']:.2f}", f"traces_of_theirs_{called}": f"{ours['trace_seconds'] / theirs['seconds']:.1f}"}
for layer in ("diffuse", "glossy"):
    frame = load(f"frame.{layer}")
    row |= {f"frame_{layer}_mean": f"{frame['mean']:.3f}", f"frame_{layer}_relmse": f"{frame['relmse']:.4f}"}
print(f'  "{name.lower().replace("-", "_")}": {json.dumps(row)},', flush=True)
P
    rm "$at.direct.sconce" "$at.all.sconce"
done | tee "$out/rows.txt"
[[ $# -gt 0 ]] || python3 bench/pages/bench_rows.py field_paths "$out/rows.txt"
