#!/usr/bin/env bash
# Diffuse light read at surfaces against what it replaced, the probes' irradiance with shadowed samples and a filter: errors and mean over a
# scene's two or three views, time of a frame of the first, bake time and bytes; pixels in which both see the same surface. Prints the rows of
# bench/results/surface_light.json. Errors are without the noise of the reference, which keeps its paths in parts.
# surface_table.sh [SCENE[=COUNT]...] as bench/pages/effects_table.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures
# [320x180], TIMED=WxH [960x540], FRAMES=N timed, the median counts [5], RESOLUTION=texels [256], TIMES=no leaves what is timed, and rows, to a later run, which keeps this one's pictures, SPP=paths a pixel [512; Sponza, four times as many], OUT=folder, whose references are kept [out/surfaces].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source bench/pages/views.sh
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/surfaces} size=${SIZE:-320x180} frames=${FRAMES:-5} resolution=${RESOLUTION:-256} spp=${SPP:-512} timed=${TIMED:-960x540}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 veach_ajar/veach_ajar.glb=24 san_miguel/san_miguel.glb=128 map_zdm2/zdm2.glb=96 town=64)
mkdir -p "$out"

for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name paths=$spp
    [[ $name == Sponza ]] && paths=$((4 * spp)) # dark and lit by little of the sky: noisy
    mapfile -t views < <(views_of "$name")
    read -ra light <<< "$(light_of "$name")"
    read -ra inside <<< "$(inside_of "$name")"
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" "${inside[@]}" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    for texels in 0 52; do
        "$sconce" bake "$scene" "${light[@]}" --probes "$at.probes.json" --resolution "$resolution" --bounces 8 --surface-texels $texels --effects all -o "$at.$texels.sconce" --json --quiet > "$at.$texels.bake.json"
        for i in "${!views[@]}"; do
            read -ra camera <<< "${views[i]}"
            view=$at.$i
            [[ -f $view.ref.exr ]] || "$sconce" reference "$scene" "${light[@]}" "${camera[@]}" --size "$size" --spp "$paths" --bounces 8 --pixel-centre --parts -o "$view.ref.exr" --quiet > /dev/null
            [[ -f $view.$texels.exr ]] || "$sconce" render "$scene" "${light[@]}" "${camera[@]}" --field "$at.$texels.sconce" --size "$size" -o "$view.$texels.exr" --quiet > /dev/null
            "$sconce" compare "$view.$texels.exr" "$view.ref.exr" --layer diffuse_indirect --same-surface --metric relmse,flip,mean --json --side-by-side "$view.$texels.png" > "$view.$texels.diffuse.json"
            "$sconce" compare "$view.$texels.exr" "$view.ref.exr" --layer glossy_indirect --same-surface --metric flip,mean --json > "$view.$texels.glossy.json"
            [[ $i == 0 && ${TIMES:-yes} != no ]] || continue
            "$sconce" render "$scene" "${light[@]}" "${camera[@]}" --field "$at.$texels.sconce" --size "$timed" --frames "$frames" -o "$at.timed.exr" --json --quiet > "$at.$texels.json"
            "$sconce" render "$scene" "${light[@]}" "${camera[@]}" --field "$at.$texels.sconce" --size "$timed" --frames "$frames" --effects diffuse -o "$at.timed.exr" --json --quiet > "$at.$texels.alone.json"
        done
        rm "$at.$texels.sconce"
    done
    [[ ${TIMES:-yes} != no ]] || continue
    python3 - "$at" "$name" "$count" "${#views[@]}" << 'P'
import json, sys
at, name, count, views = sys.argv[1], sys.argv[2], sys.argv[3], int(sys.argv[4])
load = lambda end: json.load(open(f"{at}.{end}.json"))
row = {"label": f"{name}, {count}", "views": views}
for texels, way in (("0", "irradiance"), ("52", "surface")):
    diffuse, glossy = ([load(f"{i}.{texels}.{layer}") for i in range(views)] for layer in ("diffuse", "glossy"))
    mean = lambda of, key: sum(view[key] for view in of) / views
    each = lambda of, key, digits=3: " ".join(f"{view[key]:.{digits}f}" for view in of)
    bake = load(f"{texels}.bake")
    ms, alone = (sum(load(end)["passes_ms"].get(p, 0.0) for p in ("gather light", "surface light", "area light", "diffuse denoise", "lamp light"))
                 for end in (texels, f"{texels}.alone"))
    row |= {f"{way}_relmse": f"{mean(diffuse, 'relmse'):.5f}", f"{way}_unsure": f"{max(view['relmse_unsure'] for view in diffuse):.5f}",
            f"{way}_relmses": each(diffuse, "relmse", 5), f"{way}_flip": f"{mean(diffuse, 'flip'):.3f}", f"{way}_mean": f"{mean(diffuse, 'mean'):.2f}",
            f"{way}_flips": each(diffuse, "flip"), f"{way}_means": each(diffuse, "mean"),
            f"{way}_glossy_means": each(glossy, "mean"), f"{way}_glossy_flip": f"{mean(glossy, 'flip'):.3f}", f"{way}_glossy_mean": f"{mean(glossy, 'mean'):.2f}", f"{way}_ms": f"{ms:.0f}", f"{way}_alone_ms": f"{alone:.1f}", f"{way}_device_mib": f"{load(texels)['device_bytes'] / 2**20:.0f}",
            f"{way}_bake_s": f"{bake['seconds']:.0f}", f"{way}_kib": f"{bake['bytes']['total'] / bake['probes'] / 1024:.0f}"}
row["relmse_ratio"] = f"{float(row['surface_relmse']) / float(row['irradiance_relmse']):.2f}"
row["flip_ratio"] = f"{float(row['surface_flip']) / float(row['irradiance_flip']):.2f}"
row["time_ratio"] = f"{float(row['surface_ms']) / float(row['irradiance_ms']):.2f}"
row["alone_ratio"] = f"{float(row['surface_alone_ms']) / float(row['irradiance_alone_ms']):.2f}"
print(f'  "{name.lower().replace("-", "_")}": {json.dumps(row)},')
P
done
