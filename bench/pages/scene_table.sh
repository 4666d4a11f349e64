#!/usr/bin/env bash
# Takes every real scene through check, place, bake and render and prints a table of times and peak memory.
# Environment: SCONCE=the command, built when not given, SCONCE_SCENES [../shared/scenes], COUNT=probes [32], RESOLUTION=texels [256], SIZE=WxH [480x270], OUT=folder [out/scenes].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/scenes} count=${COUNT:-32} resolution=${RESOLUTION:-256} size=${SIZE:-480x270}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"

value() { python3 -c 'import functools, json, sys; v = functools.reduce(lambda d, k: d.get(k, {}), sys.argv[2].split("."), json.load(open(sys.argv[1]))); print(round(v, 4) if isinstance(v, float) else v)' "$1" "$2"; }
failed=0
echo "| scene | triangles | check s | place s | MB | covered % | bake s | MB | render s | MB | frame ms |"
echo "|---|---|---|---|---|---|---|---|---|---|---|"
while read -r file; do
    name=$(basename "${file%.*}")
    [[ $name == scene ]] && name=$(basename "$(dirname "$file")")
    at=$out/$name
    run() { # run STEP ARGUMENTS...
        local step=$1 began=$EPOCHREALTIME
        shift
        if ! "$sconce" "$step" "$@" --json --quiet > "$at.$step.json" 2> "$at.$step.log"; then
            echo "| $name | $step failed: $(tail -n 1 "$at.$step.log") |"
            failed=1
            return 1
        fi
        seconds=$(python3 -c "print(f'{$EPOCHREALTIME - $began:.1f}')")
    }
    run check "$file" || continue
    check=$seconds
    camera=()
    run place "$file" -o "$at.probes.json" --count "$count" || continue
    place=$seconds
    run bake "$file" --probes "$at.probes.json" -o "$at.sconce" --resolution "$resolution" || continue
    bake=$seconds
    # a scene without a camera is looked at from its first probe, towards its second
    if [[ $(python3 -c 'import json, sys; print(len(json.load(open(sys.argv[1]))["cameras"]))' "$at.check.json") == 0 ]]; then
        mapfile -t camera < <(python3 -c 'import json, sys
p = [",".join(map(str, q["position"])) for q in json.load(open(sys.argv[1]))["probes"]]
print("--eye", p[0], "--target", p[min(1, len(p) - 1)], sep="\n")' "$at.probes.json")
    fi
    run render "$file" --field "$at.sconce" "${camera[@]}" --size "$size" -o "$at.exr" --png "$at.png" || continue
    echo "| $name | $(value "$at.check.json" triangles) | $check | $place | $(value "$at.place.json" peak_rss_mb) | $(value "$at.place.json" coverage.rays) | $bake | $(value "$at.bake.json" peak_rss_mb) | $seconds | $(value "$at.render.json" peak_rss_mb) | $(value "$at.render.json" frame_ms) |"
done < <(find "$scenes" \( -name '*.gltf' -o -name '*.glb' \) -not -path '*/gltf_oddities/*' | sort)
exit "$failed"
