#!/usr/bin/env bash
# Takes every real scene through check, place, bake and render; prints times and peak memory, and writes bench/results/scene_pipeline.json of them.
# A quarter of an hour on 2 cores.
# Environment: SCONCE=the command, built when not given, SCONCE_SCENES [../shared/scenes], COUNT=probes [32], RESOLUTION=texels [256], SIZE=WxH [480x270], OUT=folder [out/scenes].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes}
out=${OUT:-out/scenes} count=${COUNT:-32} resolution=${RESOLUTION:-256} size=${SIZE:-480x270}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"

failed=0
rm -f "$out/rows.txt"
while read -r file; do
    name=$(basename "${file%.*}")
    [[ $name == scene ]] && name=$(basename "$(dirname "$file")")
    at=$out/$name
    run() { # run STEP ARGUMENTS...
        local step=$1 began=$EPOCHREALTIME
        shift
        if ! "$sconce" "$step" "$@" --json --quiet > "$at.$step.json" 2> "$at.$step.log"; then
            echo "$name: $step failed: $(tail -n 1 "$at.$step.log")" >&2
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
    python3 - "$at" "$name" "$check" "$place" "$bake" "$seconds" << 'P' | tee -a "$out/rows.txt"
import json, re, sys
at, name, check_s, place_s, bake_s, render_s = sys.argv[1:]
check, place, bake, render = (json.load(open(f"{at}.{step}.json")) for step in ("check", "place", "bake", "render"))
mb = lambda step: f"{step['peak_rss_mb']:.0f}"
row = {"label": name, "triangles": str(check["triangles"]), "check_s": check_s, "place_s": place_s, "place_mb": mb(place), "covered": f"{100 * place['coverage']['rays']:.2f} %",
       "bake_s": bake_s, "bake_mb": mb(bake), "render_s": render_s, "render_mb": mb(render), "frame_ms": f"{render['frame_ms']:.0f}"}
print(f'  "{re.sub("[^a-z0-9]+", "_", name.lower())}": {json.dumps(row)},')
P
done < <(find "$scenes" \( -name '*.gltf' -o -name '*.glb' \) -not -path '*/gltf_oddities/*' | sort)
[[ $failed -ne 0 ]] || python3 bench/pages/bench_rows.py pipeline "$out/rows.txt"
exit "$failed"
