#!/usr/bin/env bash
# What moves and is in no light field: eight poses each of a walking figure and of a door, drawn with and without telling the light of them, and with rays
# that meet what the picture shows of them, against the path tracer, by masks: the light of surfaces that stayed where it changed by over a tenth (diffuse: shadows; glossy: reflections), and the shapes
# themselves. Writes bench/results/moving_shapes.json. Environment: SCONCE=the command, built when not given, SIZE=WxH [320x180], SPP=paths a pixel
# [256], POSES=n of each [8], OUT=folder, whose fields and references are kept [out/moving].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/moving} size=${SIZE:-320x180} spp=${SPP:-256} poses=${POSES:-8}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
# Scene, probes, view, then the path of the figure from a to b and the door's hinge.
run() {
    local scene=$1 count=$2 eye=$3 target=$4 from=$5 to=$6 hinge=$7
    local name at camera
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    camera=("--eye=$eye" "--target=$target" --fov 65 --size "$size")
    [[ -f $at.sconce ]] || {
        "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution 416 --bounces 8 --effects all -o "$at.sconce" --quiet > /dev/null
    }
    [[ -f $at.ref.exr ]] || "$sconce" reference "$scene" "${camera[@]}" --spp "$spp" --bounces 8 --pixel-centre -o "$at.ref.exr" --quiet > /dev/null
    for kind in figure door; do
        for ((i = 0; i < poses; ++i)); do
            local pose=$at.$kind.$i
            if [[ $kind == figure ]]; then
                local place
                place=$(python3 -c 'import sys
a, b, s = *([float(x) for x in v.split(",")] for v in sys.argv[1:3]), float(sys.argv[3])
print(",".join(f"{p + s * (q - p):.4g}" for p, q in zip(a, b)))' "$from" "$to" "$(python3 -c "print($i / max($poses - 1, 1))")")
                python3 bench/pages/moving_shapes.py figure "$place" 35 "$(python3 -c "print(0.13 * $i)")" > "$pose.json"
            else
                python3 bench/pages/moving_shapes.py door "$hinge" 0 "$(python3 -c "print($i / max($poses - 1, 1))")" > "$pose.json"
            fi
            [[ -f $pose.ref.exr ]] || "$sconce" reference "$scene" "${camera[@]}" --shapes "$pose.json" --spp "$spp" --bounces 8 --pixel-centre --parts -o "$pose.ref.exr" --quiet > /dev/null
            "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --shapes "$pose.json" --frames 3 -o "$pose.told.exr" --png "$pose.png" --json --quiet > "$pose.told.json"
            "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --shapes "$pose.json" --drawn-only --frames 3 -o "$pose.untold.exr" --json --quiet > "$pose.untold.json"
            "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --shapes "$pose.json" --drawn-only --screen-trace --frames 5 -o "$pose.seen.exr" --json --quiet > "$pose.seen.json"
            "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --shapes "$pose.json" --screen-trace --frames 5 -o "$pose.both.exr" --json --quiet > "$pose.both.json"
            for picture in told untold seen both; do
                for mask in "diffuse_indirect" "glossy_indirect" "beauty --new-surface"; do
                    "$sconce" compare "$pose.$picture.exr" "$pose.ref.exr" --changed-from "$at.ref.exr" --layer ${mask} --metric mse,relmse,mean --json > "$pose.$picture.${mask%% *}.error.json" 2> /dev/null || echo '{}' > "$pose.$picture.${mask%% *}.error.json" # nothing has changed there
                done
            done
        done
    done
    python3 bench/pages/bench_rows.py moving "$at" "$name, $count" "$poses"
}
{
    run hall 24 1.6,1.7,7.9 8,1,5.1 4,0,7.2 6.5,0,5.6 5,0,5.8
    run sponza/Sponza.gltf 54 -4,6.2,0.2 4,4.6,-0.6 -0.5,3.98,-1.5 1.5,3.98,1.5 1,3.98,-0.6
} | tee "$out/rows.txt"
python3 bench/pages/bench_rows.py movings "$out/rows.txt"
