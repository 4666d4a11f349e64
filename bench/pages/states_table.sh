#!/usr/bin/env bash
# Light that has changed against a fresh bake in that light, picture by picture of the same views: a field of no light of its own, relit by twelve suns (or,
# where no sun comes in, by a point light at twelve places), and a field of light groups, whose lamps, sun and sky are switched and dimmed to sixteen
# states. Prints a row a scene.
# states_table.sh [SCENE[=COUNT]...] as bench/pages/surface_table.sh. Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures
# [160x90], RESOLUTION=texels [128], RAYS=that gather light for a texel, and links of live light [64]: of few a fresh bake draws other
# lights by lot, OUT=folder [out/states].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
source bench/pages/views.sh
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/states} size=${SIZE:-160x90} resolution=${RESOLUTION:-128} rays=${RAYS:-64}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
list=("$@")
[[ ${#list[@]} -gt 0 ]] || list=(hall=8 sponza/Sponza.gltf=8 modern_hall/modern_hall.glb=8 town=16)
mkdir -p "$out"
quietly() { "$sconce" "$@" --quiet > /dev/null; }

# A state's pictures by a field that was changed and by a fresh one: drawn "$changed" and "$fresh" with what the state asks for.
pictures() { # name of the state, options of both...
    local state=$1 i
    shift
    for i in "${!views[@]}"; do
        read -ra camera <<< "${views[i]}"
        quietly render "$scene" "${camera[@]}" --field "$at.changed.sconce" "$@" --size "$size" -o "$at.changed.exr"
        quietly render "$scene" "${camera[@]}" --field "$at.fresh.sconce" "$@" --size "$size" -o "$at.fresh.exr"
        "$sconce" compare "$at.changed.exr" "$at.fresh.exr" --metric mse,relmse,mean --json > "$at.$state.$i.json"
    done
}

for entry in "${list[@]}"; do
    scene=${entry%%=*} count=${entry#*=}
    name=$(basename "${scene%.gl*}")
    [[ -f $scenes/$scene ]] && scene=$scenes/$scene
    at=$out/$name
    mapfile -t views < <(views_of "$name" | head -n 2)
    [[ -f $at.probes.json ]] || quietly place "$scene" --count "$count" -o "$at.probes.json"
    baked=(--probes "$at.probes.json" --resolution "$resolution" --surface-rays "$rays")
    rm -f "$at".light-*.json "$at".groups-*.json
    case $name in
        hall | modern_hall) suns=no groups=(warm cool amber) ;; # the second has one kind of emitter, and no groups
        *) suns=yes groups=(sun sky emitters) ;;
    esac

    quietly capture "$scene" "${baked[@]}" --live-links "$rays" -o "$at.capture.sconce"
    for i in {0..11}; do
        lit=$(python3 - "$at.probes.json" "$i" "$suns" "$at.lights.json" << 'P'
import json, math, sys
probes, i, suns, file = sys.argv[1], int(sys.argv[2]), sys.argv[3], sys.argv[4]
if suns == "yes":
    turn, height = math.radians(30 * i), math.radians(15 + 5 * (5 * i % 12))
    print(f"--sun={math.cos(turn) * math.cos(height):.4f},{-math.sin(height):.4f},{math.sin(turn) * math.cos(height):.4f},10,9,8")
else:
    all_probes = json.load(open(probes))["probes"]
    x, y, z = all_probes[i % len(all_probes)]["position"]
    off = 0.15 if i < len(all_probes) else -0.15
    json.dump({"lights": [{"type": "point", "position": [x + off, y + off, z + 0.1], "intensity": [20, 18, 15]}]}, open(file, "w"))
    print(f"--lights={file}")
P
)
        quietly relight "$at.capture.sconce" "$lit" -o "$at.changed.sconce"
        quietly bake "$scene" "${baked[@]}" --live-links "$rays" "$lit" -o "$at.fresh.sconce"
        pictures "light-$i" "$lit"
    done

    case $name in
        hall) members=("warm=warm panel" "cool=cool lamp" "amber=amber lamp") ;;
        modern_hall) members=() ;;
        *) members=(sun sky emitters) ;;
    esac
    made=()
    for member in "${members[@]}"; do made+=(--group "$member"); done
    [[ ${#made[@]} -eq 0 ]] || quietly bake "$scene" "${baked[@]}" "${made[@]}" -o "$at.groups.sconce"
    for i in {0..15}; do
        [[ ${#made[@]} -gt 0 ]] || break
        # Each group off, dimmed or on; the last as the number's rest.
        dims=(--dim "${groups[0]}=$((i % 2))" --dim "${groups[1]}=$(python3 -c "print((0, 0.25, 1, 1.5)[$i // 2 % 4])")" --dim "${groups[2]}=$((i / 8))")
        [[ $i -gt 0 ]] || dims=(--dim "${groups[0]}=1,0.5,0.25") # all on, one coloured; all off is dark
        quietly relight "$at.groups.sconce" "${dims[@]}" -o "$at.changed.sconce"
        quietly bake "$scene" "${baked[@]}" "${made[@]}" "${dims[@]}" -o "$at.fresh.sconce"
        pictures "groups-$i" "${made[@]}" "${dims[@]}"
    done
    python3 - "$at" "$name" "$count" "$suns" << 'P'
import glob, json, sys
at, name, count, suns = sys.argv[1:]
row = {"label": f"{name}, {count}", "by": "sun" if suns == "yes" else "point light"}
for kind in ("light", "groups"):
    found = [json.load(open(file)) for file in glob.glob(f"{at}.{kind}-*.json")]
    if not found: continue
    ratios = [of["mean"] for of in found if of.get("mean")]
    row |= {f"{kind}_pictures": str(len(found)), f"{kind}_equal": str(sum(of["mse"] == 0 for of in found)),
            f"{kind}_worst_relmse": f"{max(of['relmse'] for of in found):.2g}",
            f"{kind}_means": f"{min(ratios):.4f} to {max(ratios):.4f}"}
print(f'  "{name.lower()}": {json.dumps(row)},', flush=True)
P
    rm -f "$at".*.sconce "$at".changed.exr "$at".fresh.exr
done
