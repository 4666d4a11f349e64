#!/usr/bin/env bash
# Diffuse light read at surfaces against what it replaced, the probes' irradiance with shadowed samples and a filter: errors, mean and time of a
# frame, bake time and bytes; pixels in which both see the same surface. Prints the rows of bench/results/surface_light.json.
# surface_table.sh [SCENE[=COUNT]...] as bench/pages/effects_table.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures
# [320x180], TIMED=WxH [960x540], FRAMES=N timed, the median counts [5], RESOLUTION=texels [256], SPP=paths a pixel [512; Sponza, four times as many], OUT=folder, whose references are kept [out/surfaces].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/surfaces} size=${SIZE:-320x180} frames=${FRAMES:-5} resolution=${RESOLUTION:-256} spp=${SPP:-512} timed=${TIMED:-960x540}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 veach_ajar/veach_ajar.glb=24 san_miguel/san_miguel.glb=128 map_zdm2/zdm2.glb=96 town=64)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=} camera=()
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    case $name in # of the scenes' suggested views
        modern_hall) camera=(--eye 5.59993,1.5,3.76821 --target 4.69671,1.50938,3.34018 --fov 75) ;;
        zdm2) camera=(--eye=-31.6977,11.2,3.78408 --target=-30.7396,11.2344,4.04664 --fov 75) ;;
        san_miguel) camera=(--eye=-13.714,1.57212,-9.35007 --target=-13.3374,1.58774,-8.42514 --fov 75) ;; # its court
    esac
    at=$out/$name paths=$spp
    [[ $name == Sponza ]] && paths=$((4 * spp)) # dark and lit by little of the sky: noisy
    "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    [[ -f $at.ref.exr ]] || "$sconce" reference "$scene" "${camera[@]}" --size "$size" --spp "$paths" --bounces 8 --pixel-centre -o "$at.ref.exr" --quiet > /dev/null
    for texels in 0 52; do
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --bounces 8 --surface-texels $texels --effects all -o "$at.sconce" --json --quiet > "$at.$texels.bake.json"
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$size" -o "$at.$texels.exr" --quiet > /dev/null
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$timed" --frames "$frames" -o "$at.timed.exr" --json --quiet > "$at.$texels.json"
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$timed" --frames "$frames" --effects diffuse -o "$at.timed.exr" --json --quiet > "$at.$texels.alone.json"
        "$sconce" compare "$at.$texels.exr" "$at.ref.exr" --layer diffuse_indirect --same-surface --metric relmse,flip,mean --json --side-by-side "$at.$texels.png" > "$at.$texels.diffuse.json"
        "$sconce" compare "$at.$texels.exr" "$at.ref.exr" --layer glossy_indirect --same-surface --metric flip,mean --json > "$at.$texels.glossy.json"
    done
    python3 - "$at" "$name" "$count" <<'P'
import json, sys
at, name, count = sys.argv[1:]
load = lambda end: json.load(open(f"{at}.{end}.json"))
row = {"label": f"{name}, {count}"}
for texels, way in (("0", "irradiance"), ("52", "surface")):
    error, glossy, bake = load(f"{texels}.diffuse"), load(f"{texels}.glossy"), load(f"{texels}.bake")
    ms, alone = (sum(load(end)["passes_ms"].get(p, 0.0) for p in ("gather light", "surface light", "area light", "diffuse denoise", "lamp light"))
                 for end in (texels, f"{texels}.alone"))
    row |= {f"{way}_relmse": f"{error['relmse']:.4f}", f"{way}_flip": f"{error['flip']:.3f}", f"{way}_mean": f"{error['mean']:.2f}",
            f"{way}_glossy_flip": f"{glossy['flip']:.3f}", f"{way}_glossy_mean": f"{glossy['mean']:.2f}", f"{way}_ms": f"{ms:.0f}", f"{way}_alone_ms": f"{alone:.1f}",
            f"{way}_bake_s": f"{bake['seconds']:.0f}", f"{way}_kib": f"{bake['bytes']['total'] / bake['probes'] / 1024:.0f}"}
row["flip_ratio"] = f"{float(row['surface_flip']) / float(row['irradiance_flip']):.2f}"
row["time_ratio"] = f"{float(row['surface_ms']) / float(row['irradiance_ms']):.2f}"
row["alone_ratio"] = f"{float(row['surface_alone_ms']) / float(row['irradiance_alone_ms']):.2f}"
print(f'  "{name.lower().replace("-", "_")}": {json.dumps(row)},')
P
done
