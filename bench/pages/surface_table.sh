#!/usr/bin/env bash
# Diffuse light read at surfaces against what it replaced, the probes' irradiance with shadowed samples and a filter: errors and mean over a
# scene's two or three views, time of a frame of the first, bake time and bytes; pixels in which both see the same surface. Prints the rows of
# bench/results/surface_light.json. Errors are without the noise of the reference, which keeps its paths in parts.
# surface_table.sh [SCENE[=COUNT]...] as bench/pages/effects_table.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures
# [320x180], TIMED=WxH [960x540], FRAMES=N timed, the median counts [5], RESOLUTION=texels [256], TIMES=no leaves what is timed, and rows, to a later run, which keeps this one's pictures, SPP=paths a pixel [512; Sponza, four times as many], OUT=folder, whose references are kept [out/surfaces].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/surfaces} size=${SIZE:-320x180} frames=${FRAMES:-5} resolution=${RESOLUTION:-256} spp=${SPP:-512} timed=${TIMED:-960x540}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 veach_ajar/veach_ajar.glb=24 san_miguel/san_miguel.glb=128 map_zdm2/zdm2.glb=96 town=64)
mkdir -p "$out"

# A scene's views, a line each: arguments of the command.
views_of() {
    case $1 in # of the scenes' suggested views (VIEWS.txt); others by their cameras
        modern_hall) echo "--eye=5.59993,1.5,3.76821 --target=4.69671,1.50938,3.34018 --fov=75
--eye=-5.01302,1.5,-1.9475 --target=-4.05493,1.53437,-1.68494 --fov=75" ;;
        zdm2) echo "--eye=-31.6977,11.2,3.78408 --target=-30.7396,11.2344,4.04664 --fov=75
--eye=-25.8236,6.66473,7.10483 --target=-24.8655,6.69911,7.36739 --fov=75
--eye=15.9793,19.2,-30.391 --target=15.0936,19.2281,-29.9365 --fov=75" ;;
        san_miguel) echo "--eye=-13.714,1.57212,-9.35007 --target=-13.3374,1.58774,-8.42514 --fov=75
--eye=2.98777,1.65016,-3.56943 --target=3.94333,1.65329,-3.86406 --fov=75
--eye=-14.0275,1.28214,-25.5574 --target=-13.0694,1.31652,-25.2948 --fov=75" ;; # first its court
        Sponza) echo "--camera=0
--eye=-4.65801,5.5814,-3.21241 --target=-3.69992,5.61578,-2.94986 --fov=75
--eye=-8.68819,22.7979,3.48218 --target=-7.73264,22.801,3.18755 --fov=75" ;; # not "indoor": a sealed passage, black
        veach_ajar) echo "--camera=0
--eye=-1.46223,1.5,-5.52499 --target=-0.648084,1.48438,-4.94668 --fov=75" ;;
        town) printf -- '--camera=%s\n' main square kitchen ;;
        *) printf -- '--camera=%s\n' 0 1 2 ;;
    esac
}

# What it is lit by, where that isn't in its file.
light_of() { [[ $1 != zdm2 ]] || echo --sun=0.4,-1,0.3 --sky=0.6,0.8,1.0; }
# Where a view stands that no room of the others leads to.
inside_of() { [[ $1 != san_miguel ]] || echo --inside=-14.0275,1.28214,-25.5574; }

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
