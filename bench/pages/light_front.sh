#!/usr/bin/env bash
# What two choices of a frame give for their time: below which roughness reflections are traced, and whether diffuse light is
# read from irradiance, from patches, or traced.
# Prints two Markdown tables. light_front.sh [SCENE[=COUNT]...] as bench/pages/effects_table.sh, whose list is the default's.
# Environment: SCONCE=the command, built when not given, SIZE=WxH [320x180], FRAMES=N timed, the median counts [3], TURNS=N over all choices in
# turn, the least time of each pass counts [3], RESOLUTION=texels [256], SPP=paths a pixel [256], OUT=folder [out/front].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/front} size=${SIZE:-320x180} frames=${FRAMES:-3} turns=${TURNS:-3} resolution=${RESOLUTION:-256} spp=${SPP:-256}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell-glossy=8 temple=16 hall=24 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50)
below=(0.2 0.3 0.4 0.6 0.8 2) diffuse=(irradiance patches traced)
mkdir -p "$out"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=} camera=()
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    [[ $name == modern_hall ]] && camera=(--eye 5.59993,1.5,3.76821 --target 4.69671,1.50938,3.34018 --fov 75) # the first of its suggested views
    at=$out/$name
    [[ -f $at.sconce ]] || {
        "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --bounces 4 --effects all -o "$at.sconce" --quiet > /dev/null
    }
    [[ -f $at.ref.exr ]] || "$sconce" reference "$scene" "${camera[@]}" --size "$size" --spp "$spp" --bounces 4 -o "$at.ref.exr" --quiet > /dev/null
    draw() { # name of the result, then options
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$size" "${@:2}" -o "$at.$1.exr" --json --quiet > "$at.$1.$turn.json"
    }
    for ((turn = 0; turn < turns; ++turn)); do
        for value in "${below[@]}"; do draw "below-$value" --rays-below "$value" --frames "$frames"; done
        for value in "${diffuse[@]}"; do draw "$value" --diffuse "$value" --frames "$frames"; done
    done
    turn=0
    for value in "${diffuse[@]}"; do draw "$value.time" --diffuse "$value" --temporal --frames 16; done
    for value in "${below[@]/#/below-}"; do
        for layer in glossy_indirect beauty; do
            "$sconce" compare "$at.$value.exr" "$at.ref.exr" --layer $layer --metric relmse,flip --json > "$at.$value.$layer.json"
        done
    done
    for value in "${diffuse[@]}" "${diffuse[@]/%/.time}"; do
        "$sconce" compare "$at.$value.exr" "$at.ref.exr" --layer diffuse_indirect --metric relmse,flip --json > "$at.$value.diffuse.json"
    done
done
python3 - "$out" "$turns" "${#below[@]}" "${below[@]}" "${list[@]}" <<'P'
import json, os, sys
out, turns, count = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
below, scenes = sys.argv[4 : 4 + count], [os.path.basename(s.split("=")[0]).split(".gl")[0] for s in sys.argv[4 + count :]]
load = lambda path: json.load(open(f"{out}/{path}.json"))


def least(at, passes):
    runs = [load(f"{at}.{turn}")["passes_ms"] for turn in range(turns)]
    return sum(min(run.get(p, 0.0) for run in runs) for p in passes)


error = lambda at: "{relmse:.4f} / {flip:.3f}".format(**load(at))
every = ("classify tiles", "gather light", "diffuse trace", "glossy trace", "mirror trace", "glossy denoise", "area light", "diffuse denoise")
print("| scene | traced below | traced pixels | reflections: relMSE / FLIP | picture: relMSE / FLIP | trace and filter, ms | indirect light, ms |\n" + 7 * "|---" + "|")
for scene in scenes:
    for value in below:
        at = f"{scene}.below-{value}"
        print(f"| {scene} | {value} | {100 * load(at + '.0').get('traced_pixels', 0):.0f} % | {error(at + '.glossy_indirect')} | {error(at + '.beauty')} | "
              f"{least(at, ('glossy trace', 'glossy denoise')):.0f} | {least(at, every):.0f} |")
ways = ("irradiance", "patches", "traced")
print("\n| scene | one frame: irradiance | patches | traced | 16 frames over time: irradiance | patches | traced | ms, one frame: irradiance | patches | traced |\n" + 10 * "|---" + "|")
for scene in scenes:
    cells = [error(f"{scene}.{kind}{time}.diffuse") for time in ("", ".time") for kind in ways]
    times = [f"{least(f'{scene}.{kind}', ('gather light', 'area light', 'diffuse trace', 'diffuse denoise')):.0f}" for kind in ways]
    print(f"| {scene} | " + " | ".join(cells + times) + " |")
P
