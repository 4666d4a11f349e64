#!/usr/bin/env bash
# Pictures without geometry: rays from the eye through baked fields, ours and B0+ on the same probes and on a grid of as many, in ten views a scene,
# against Embree; and pictures of three of them, nearest to a probe, in the middle and farthest, beside the drawn frame's, against the path tracer.
# Writes bench/results/primary_rays.json. primary_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE, RACE=the command and
# sconce_primary_rays, built when not given, VIEWS=n [10], SIZE=WxH of the pictures [480x270], SPP=paths a pixel [256], OUT=folder, whose fields and references are kept [out/primary].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/primary} size=${SIZE:-480x270} spp=${SPP:-256} views=${VIEWS:-10}
[[ -n ${SCONCE:-} && -n ${RACE:-} ]] || tools/build.sh release sconce_command sconce_primary_rays >&2
sconce=${SCONCE:-build/release/tools/sconce} race=${RACE:-build/release/bench/race/sconce_primary_rays}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50 town=64)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    [[ -f $at.probes.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
    [[ -f $at.grid.json ]] || "$sconce" place "$scene" --method grid --count "$count" --fit-grid -o "$at.grid.json" --quiet > /dev/null
    [[ -f $at.sconce ]] || "$sconce" bake "$scene" --probes "$at.probes.json" --effects all --resolution 416 -o "$at.sconce" --quiet > /dev/null
    for other in "oct $at.probes.json" "grid $at.grid.json"; do
        read -r kind probes <<< "$other"
        [[ -f $at.$kind.sconce ]] || "$sconce" bake "$scene" --probes "$probes" --chart octahedral --resolution 512 --bounces 0 --surface-texels 0 -o "$at.$kind.sconce" --quiet > /dev/null
    done
    "$race" "$scene" --views "$views" --width "${size%x*}" --height "${size#*x}" --field "ours=$at.sconce" --field "b0plus-octree=$at.oct.sconce" --field "b0plus=$at.grid.sconce" > "$at.race.json"
    for i in 0 $((views / 2)) $((views - 1)); do
        read -r eye target < <(python3 -c 'import json, sys
view = json.load(open(sys.argv[1]))["views"][int(sys.argv[2])]
print(*(",".join(f"{x:.6g}" for x in view[key]) for key in ("eye", "target")))' "$at.race.json" "$i")
        camera=("--eye=$eye" "--target=$target" --fov 60 --size "$size")
        [[ -f $at.$i.ref.exr ]] || "$sconce" reference "$scene" "${camera[@]}" --spp "$spp" --bounces 8 -o "$at.$i.ref.exr" --quiet > /dev/null
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --frames 3 -o "$at.$i.drawn.exr" --json --quiet > "$at.$i.drawn.json"
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --frames 3 --from-field -o "$at.$i.seen.exr" --json --quiet > "$at.$i.seen.json"
        for picture in drawn seen; do
            "$sconce" compare "$at.$i.$picture.exr" "$at.$i.ref.exr" --metric psnr,flip,mean --json --side-by-side "$at.$i.$picture.png" > "$at.$i.$picture.error.json"
        done
    done
    python3 bench/pages/bench_rows.py primary "$at" "$name, $count" "0,$((views / 2)),$((views - 1))"
done | tee "$out/rows.txt"
python3 bench/pages/bench_rows.py primaries "$out/rows.txt"
