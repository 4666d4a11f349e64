#!/usr/bin/env bash
# Light of 1, 16 and 256 emitters: by samples with shadow maps, by samples with shadow rays through the light field (--area-shadows field), and
# by rays alone (--diffuse traced). Prints a Markdown table.
# Environment: SIZE=WxH [320x180], FRAMES=N timed, the median counts [5], SPP=N of the reference [256], OUT=folder [out/emitters].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
out=${OUT:-out/emitters} size=${SIZE:-320x180} frames=${FRAMES:-5} spp=${SPP:-256}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
echo "| emitters | shadows | light, ms | relMSE | FLIP | 16 frames over time: relMSE | FLIP |"
echo "|---|---|---|---|---|---|---|"
for count in 1 16 256; do
    at=$out/room$count
    bench/pages/emitter_room.py "$count" > "$at.gltf"
    "$sconce" place "$at.gltf" --count 12 -o "$at.probes.json" --quiet > /dev/null
    "$sconce" bake "$at.gltf" --probes "$at.probes.json" --resolution 256 --effects all -o "$at.sconce" --quiet > /dev/null
    "$sconce" reference "$at.gltf" --size "$size" --spp "$spp" -o "$at.ref.exr" --quiet > /dev/null
    for way in maps field traced; do
        if [[ $way == traced ]]; then how=(--diffuse traced); else how=(--area-shadows "$way"); fi
        "$sconce" render "$at.gltf" --field "$at.sconce" --size "$size" "${how[@]}" --frames "$frames" -o "$at.$way.exr" --json --quiet > "$at.json"
        "$sconce" render "$at.gltf" --field "$at.sconce" --size "$size" "${how[@]}" --temporal --frames 16 -o "$at.$way.time.exr" --json --quiet > "$at.time.json"
        for kind in "" .time; do
            "$sconce" compare "$at.$way$kind.exr" "$at.ref.exr" --layer diffuse_indirect --metric relmse,flip --json > "$at.error$kind.json"
        done
        python3 - "$at" "$count" $way <<'P'
import json, sys
at, count, way = sys.argv[1:]
load = lambda end: json.load(open(f"{at}.{end}"))
passes, one, many = load("json")["passes_ms"], load("error.json"), load("error.time.json")
light = sum(ms for name, ms in passes.items() if name in ("gather light", "diffuse trace", "area light", "diffuse denoise"))
print(f"| {count} | {way} | {light:.0f} | {one['relmse']:.4f} | {one['flip']:.3f} | {many['relmse']:.4f} | {many['flip']:.3f} |")
P
    done
done
