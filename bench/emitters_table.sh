#!/usr/bin/env bash
# Light of 1, 16 and 256 emitters: by shadowed samples, and by rays through the light field (--diffuse traced). Prints a Markdown table.
# Environment: SIZE=WxH [320x180], FRAMES=N timed, the median counts [5], SPP=N of the reference [256], OUT=folder [out/emitters].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
out=${OUT:-out/emitters} size=${SIZE:-320x180} frames=${FRAMES:-5} spp=${SPP:-256}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
echo "| emitters | diffuse | light, ms | relMSE | FLIP | 16 frames over time: relMSE | FLIP |"
echo "|---|---|---|---|---|---|---|"
for count in 1 16 256; do
    at=$out/room$count
    bench/emitter_room.py "$count" > "$at.gltf"
    "$sconce" place "$at.gltf" --count 12 -o "$at.probes.json" --quiet > /dev/null
    "$sconce" bake "$at.gltf" --probes "$at.probes.json" --resolution 256 --effects all -o "$at.sconce" --quiet > /dev/null
    "$sconce" reference "$at.gltf" --size "$size" --spp "$spp" -o "$at.ref.exr" --quiet > /dev/null
    for diffuse in irradiance traced; do
        "$sconce" render "$at.gltf" --field "$at.sconce" --size "$size" --diffuse $diffuse --frames "$frames" -o "$at.$diffuse.exr" --json --quiet > "$at.json"
        "$sconce" render "$at.gltf" --field "$at.sconce" --size "$size" --diffuse $diffuse --temporal --frames 16 -o "$at.$diffuse.time.exr" --json --quiet > "$at.time.json"
        for kind in "" .time; do
            "$sconce" compare "$at.$diffuse$kind.exr" "$at.ref.exr" --layer diffuse_indirect --metric relmse,flip --json > "$at.error$kind.json"
        done
        python3 - "$at" "$count" $diffuse <<'P'
import json, sys
at, count, diffuse = sys.argv[1:]
load = lambda end: json.load(open(f"{at}.{end}"))
passes, one, many = load("json")["passes_ms"], load("error.json"), load("error.time.json")
light = sum(ms for name, ms in passes.items() if name in ("gather light", "diffuse trace", "area light", "diffuse denoise"))
print(f"| {count} | {diffuse} | {light:.0f} | {one['relmse']:.4f} | {one['flip']:.3f} | {many['relmse']:.4f} | {many['flip']:.3f} |")
P
    done
done
