#!/usr/bin/env bash
# What each effect costs, and what a scene without it saves: `--effects auto` (what the scene calls for, on its tiles) against `--effects all`
# (everything, over the whole picture), for the same pixels. Prints a Markdown table, and the passes of each scene.
# effects_table.sh [SCENE[=COUNT]...], each a built-in name, a file under SCONCE_SCENES, or `small-glossy` (bench/pages/emitter_room.py: one glossy object,
# small on screen), with its number of probes.
# Environment: SCONCE=the command, built when not given, SIZE=WxH [960x540], FRAMES=N timed, the median counts [5], TURNS=N of both in
# turn, the least time of each pass counts, which is what a machine with other work leaves of it [3], RESOLUTION=texels [416], OUT=folder [out/effects].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/effects} size=${SIZE:-960x540} frames=${FRAMES:-5} turns=${TURNS:-3} resolution=${RESOLUTION:-416}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -eq 0 ]] && list=(cornell=8 small-glossy=12 cornell-glossy=8 temple=16 hall=24 town=54 sponza/Sponza.gltf=54 modern_hall/modern_hall.glb=50)
mkdir -p "$out"
notes=()
echo "| scene | calls for | traced pixels | indirect light, ms: auto | all | ratio | images, MB: auto | all | file, MB: auto | all | same pixels |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    [[ $count == "$entry" ]] && count=32
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name camera=()
    if [[ $scene == small-glossy ]]; then
        scene=$at.gltf
        bench/pages/emitter_room.py 4 --glossy > "$scene"
    elif [[ $name == modern_hall ]]; then # has no camera: the first of its suggested views
        camera=(--eye 5.59993,1.5,3.76821 --target 4.69671,1.50938,3.34018 --fov 75)
    fi
    echo "--- $name" >&2
    [[ -f $at.sconce ]] || {
        "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" -o "$at.sconce" --quiet > /dev/null
        "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --effects all -o "$at.all.sconce" --quiet > /dev/null
    }
    for ((turn = 0; turn < turns; ++turn)); do
        "$sconce" render "$scene" "${camera[@]}" --field "$at.sconce" --size "$size" --frames "$frames" -o "$at.auto.exr" --png "$at.png" --json --quiet > "$at.auto.$turn.json"
        "$sconce" render "$scene" "${camera[@]}" --field "$at.all.sconce" --size "$size" --frames "$frames" --effects all -o "$at.all.exr" --json --quiet > "$at.all.$turn.json"
    done
    "$sconce" compare "$at.auto.exr" "$at.all.exr" --metric mse --json > "$at.same.json"
    python3 - "$at" "$name" "$turns" <<'P'
import json, os, sys
at, name, turns = sys.argv[1:]
load = lambda end: json.load(open(f"{at}.{end}.json"))


def least(kind):
    runs = [load(f"{kind}.{turn}") for turn in range(int(turns))]
    passes = {p: min(run["passes_ms"][p] for run in runs) for p in runs[0]["passes_ms"]}
    return runs[0] | {"passes_ms": passes}


auto, whole, same = least("auto"), least("all"), load("same")
host = ("G-buffer", "direct light", "compose")  # what a renderer has anyway
light = lambda j: sum(ms for p, ms in j["passes_ms"].items() if p not in host)
effects = [n for n in ("diffuse", "rough", "glossy", "mirror", "emitters", "sky") if auto["effects"][n]]
mb = lambda path: os.path.getsize(path) / 1e6
passes = lambda j: ", ".join(f"{p} {ms:.0f}" for p, ms in j["passes_ms"].items())
print(f"| {name} | {' '.join(effects)} | {100 * auto.get('traced_pixels', 0):.1f} % | {light(auto):.0f} | {light(whole):.0f} | {light(whole) / light(auto):.2f}x | {auto['device_bytes'] / 1e6:.1f} | "
      f"{whole['device_bytes'] / 1e6:.1f} | {mb(at + '.sconce'):.1f} | {mb(at + '.all.sconce'):.1f} | {'yes' if same['mse'] == 0 else 'NO'} |")
print(f"{name}, ms a pass: auto: {passes(auto)}; all: {passes(whole)}", file=open(at + ".passes.txt", "w"))
P
    notes+=("$(cat "$at.passes.txt")")
done
echo
printf -- '- %s\n' "${notes[@]}"
